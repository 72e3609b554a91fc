"""What accuracy costs in time, from measured runs only.

- ``cost_of_accuracy``: bound U, Pareto front, T*(tau), crossover, price of a digit, degrees of accuracy
- ``timing``: samples, median and quartiles, null spread, ratio of two versions
"""

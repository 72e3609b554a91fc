"""What accuracy costs in time, from measured runs only.

- ``cost_of_accuracy``: bound U, Pareto front, T*(tau), crossover, price of a digit, degrees of accuracy
- ``work_precision``, ``settings``: error against seconds on scenes of the library, and the settings that are timed
- ``overview``: the same of many cases side by side
- ``scaling``: how the time grows with the size of the problem
"""

"""How a number behaves as the discretisation is refined; sequences run from the finest grid to the coarsest.

- ``observed_order``: order of three grids with any two refinement ratios, and the band in which it is accepted
- ``extrapolation``: value at vanishing length and grid convergence index (GCI)
- ``least_squares``: four grids and more (Eca and Hoekstra 2014)
- ``behaviour``: monotone, oscillatory, divergent, floor, too few
- ``asymptotic``: whether the grids lie in the asymptotic range, by tests that can fail
- ``known_errors``: order, asymptotic range, or digits gained, where the errors themselves are known
- ``study``: all of it for one sequence
"""

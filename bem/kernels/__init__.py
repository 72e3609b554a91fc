"""Surface compliance of a layer in Fourier space, Eqs. (27)-(31).

Enters: support, Poisson's ratio and wavenumbers times thickness. Leaves: chi, 1 - chi and the mean mode, to a few
roundings. Read `layer` first.
"""

"""Surface compliance of layers in Fourier space, Eqs. (27)-(31), and of stacks of layers.

Enters: a layer, and wavenumbers times the thickness of what touches the indenter. Leaves: chi, 1 - chi and the mean
mode, to a few roundings. Read `protocol` first, then `layer`, `stack` and `of_layer`.
"""

"""Surface compliance of layers, stacks and graded layers in Fourier space, Eqs. (27)-(31).

Input: a layer, and wavenumbers times the thickness of the surface material. Output: chi and 1 - chi, accurate to
rounding. Read `stack` first, then `graded` and `of_layer`.
"""

"""Histories and impacts on relaxing layers by finite elements.

Enters: a scene in time. Leaves: depth, force and radius at instants, restitution and energies, with stated errors.
Read `motions` first, then `top`, `setup`, `history` and `impact`.
"""

"""Histories and impacts on relaxing layers by finite elements.

Enters: a scene in time. Leaves: depth, force and radius at instants, restitution and energies, with stated errors.
Read `solver` first, then `setup`, `impact` and `top`; `errors` compares the three simulations.
"""

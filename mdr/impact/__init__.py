"""Impacts on elastic and relaxing layers, Eqs. (47)-(54).

Enters: springs of a scene, mass, velocity, relaxation law. Leaves: the motion until release, restitution, peaks and
energies, with stated errors. Read `motion` first (the equations), then `rules`, `track`, `course`, `results`, `solver`.
"""

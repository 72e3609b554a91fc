"""Impacts on elastic and relaxing layers, Eqs. (47)-(54).

Enters: springs of a scene, mass, velocity, relaxation law. Leaves: the motion until release, restitution, peaks and
an energy audit, with stated errors. Read `solver` first, then `equations`, `motion` and
`collocation`.
"""

"""Elastic frictionless contact by finite elements.

Enters: a scene and settings. Leaves: contact radius, depth, force, stiffness and surface fields. Read `path` first,
then `prescribed_radius` and `equilibria`; `at_load` finds the contact of a prescribed depth or force.
"""

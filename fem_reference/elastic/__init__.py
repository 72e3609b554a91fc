"""Elastic frictionless contact by finite elements, with error estimates.

Enters: a scene and a discrete layer. Leaves: contact radius, depth, force, stiffness and surface fields, with stated
errors. Read `path` first.
"""

"""Elastic frictionless contact by finite elements, with error estimates.

Enters: a scene and a discrete layer. Leaves: contact radius, depth, force, stiffness and surface fields, with stated
errors. Read `path` first, then `prescribed_radius` and `error_estimate`; `contact_search` and `at_load` find the
contact of a prescribed depth or force.
"""

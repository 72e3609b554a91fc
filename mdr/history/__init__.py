"""Prescribed depth or force in time on relaxing layers.

Enters: springs of a scene and a relaxation law. Leaves: depth, force and radius at the asked instants, with stated
errors. Read `solver` first, then `springs_in_time` and `contact_edge`.
"""

"""The flat punch on a layer by one integral equation, THEORY section 2.

Enters: a kernel and a range of a/h. Leaves: stiffness, spring stiffness and pressure of flat punches of all radii,
with stated errors. Read `flat_punch_source` first.
"""

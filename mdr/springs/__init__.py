"""The springs of a scene: stiffness c_N(x), profile g(x;h), and what follows from them, Eqs. (4)-(12).

Enters: a scene and flat-punch data. Leaves: force, depth, stiffness, pressure and displacement at any contact radius,
with stated errors. Read `equivalent_system` first, then `assembly` and `reach`.
"""

"""Adhesive equilibria and detachment by finite elements.

Enters: a scene with `Adhesion`. Leaves: contact or detachment paths with stated errors. Read `equilibria` first.
"""

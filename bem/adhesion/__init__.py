"""Adhesive contact by boundary elements: equilibrium of the contact edge, branch and withdrawal.

Enters: a scene with `Adhesion`. Leaves: contact or detachment paths with stated errors. Read `solver` first.
"""

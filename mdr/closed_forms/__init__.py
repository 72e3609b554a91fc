"""Closed forms of the paper: limits of thin layers, the restitution of a flat punch.

Enters: parameters of a scene. Leaves: numbers from a formula, with its equation. Read `asymptotic` first.
"""

"""Closed forms of the paper: limits of thin and thick layers, power laws, impact numbers.

Enters: parameters of a scene. Leaves: numbers from a formula, with its equation. Read `asymptotic` first.
"""

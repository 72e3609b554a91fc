"""Formulas in circulation for contacts on layers, as plain functions, and how right they are.

Each multiplies the force on the half-space at the same depth.  Read `paraboloid` first, then `audit`.
"""

"""Piecewise polynomials: Gauss and Chebyshev panels, equal, graded, mapped and adaptive.

Enters: functions or samples on an interval. Leaves: values, integrals and derivatives to rounding, with the size of
what was left out. Read `gauss_panels` first.
"""

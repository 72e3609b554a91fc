"""Where a contact ends, from the pressures on a grid that does not resolve its edge.

Two measures. The *area* of the cells under pressure is that of a circle with radius a + 0.11 s (s the cell size): the
complementarity problem keeps a cell while its centre lies within about 0.11 s outside the true edge, which varies by
some 0.03 s with the position of the edge between the cells. The *zero of p^2* is sharper: at the edge of a smooth
contact p^2 is an analytic function of r^2 with a simple zero at a^2, whatever profile and layer, and a polynomial
through the cells 4 to 20 cells inside the edge, where the discretisation is regular again, finds it within 0.001 s
after a shift of 0.0085 s. Both shifts belong to the square cells and their midpoints; they were measured on Hertz's
contact, where a is known, and are the same for all smooth contacts because the edge field is.
"""

from __future__ import annotations

from math import pi, sqrt
from typing import Final, NamedTuple

import numpy as np

from contact.validation import FloatArray

AREA_SHIFT: Final = 0.11  # cells
AREA_SCATTER: Final = 0.05  # cells, largest seen from 128 to 1024 cells
THIN_SCATTER: Final = 0.2  # cells, where the pressure vanishes like that of a thin layer and not like a root
ZERO_SHIFT: Final = 0.0085  # cells
ZERO_SCATTER: Final = 0.002  # cells
INNER, OUTER, DEGREE = 20.0, 4.0, 4  # cells inside the edge that the fit uses, and its degree in r^2
LEAST_RINGS: Final = 8.0  # cells between its ends


def area_radius(pressure: FloatArray, cell_size: float) -> float:
    """a [m] from the area of the quadrant's cells under pressure; right within `AREA_SCATTER` cells."""
    return cell_size * (2.0 * sqrt(np.count_nonzero(pressure > 0.0) / pi) - AREA_SHIFT)


class ContactRadius(NamedTuple):
    """A measured contact radius a [m] and how far it may be off [m]."""

    value: float
    scatter: float


def contact_radius(
    pressure: FloatArray, radius: FloatArray, cell_size: float, *, smooth_beyond: float, thickness: float
) -> ContactRadius:
    """a as the zero of p^2, or by the area where p^2 is not resolved.

    The scatter grows with what one degree less of the polynomial makes of the zero: a kink of the profile, or an edge
    layer of a thin layer, is seen there.

    Args:
        pressure: p [Pa] on the quadrant.
        radius: r of its cells [m].
        cell_size: s [m].
        smooth_beyond: Radius [m] outside of which the profile is smooth (its last kink inside the contact).
        thickness: h [m]; where the cells of the fit span more than that, the area is taken.

    Returns:
        The radius and its scatter.
    """
    guess = area_radius(pressure, cell_size)
    outer = guess - OUTER * cell_size
    inner = max(guess - INNER * cell_size, smooth_beyond + cell_size, 0.3 * guess)
    unresolved = min(1.0, INNER * cell_size / thickness)  # part of the edge layer of a thin layer that cells span
    by_area = ContactRadius(guess, cell_size * (AREA_SCATTER + THIN_SCATTER * unresolved + cell_size / guess))
    if outer - inner < LEAST_RINGS * cell_size or unresolved == 1.0:
        return by_area
    rings = (radius > inner) & (radius < outer)
    x = (radius[rings] / guess) ** 2
    higher, lower = (
        sqrt(max(_root_near_one(np.polynomial.Polynomial.fit(x, pressure[rings] ** 2, degree)), 0.0))
        for degree in (DEGREE, DEGREE - 1)
    )
    scatter = ZERO_SCATTER * cell_size + guess * abs(higher - lower)
    by_zero = ContactRadius(guess * higher - ZERO_SHIFT * cell_size, scatter)
    return by_zero if abs(by_zero.value - guess) < 2.0 * by_area.scatter and scatter < by_area.scatter else by_area


def _root_near_one(polynomial: np.polynomial.Polynomial) -> float:
    """Newton's method from 1: the edge is within a cell of the start."""
    slope, x = polynomial.deriv(), 1.0
    for _ in range(8):
        x -= float(polynomial(x) / slope(x))
    return x

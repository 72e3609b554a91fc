"""The closed forms that every formula multiplies: force [N] at depth [m] on the half-space, E* = E/(1 - nu^2)."""

import numpy as np
from numpy.typing import ArrayLike

from contact.records.validation import FloatArray


def hertz_force(depth: ArrayLike, radius_of_curvature: float, contact_modulus: float) -> FloatArray:
    """F = 4/3 E* sqrt(R) delta^(3/2): a paraboloid.

    Args:
        depth: delta [m].
        radius_of_curvature: R [m].
        contact_modulus: E* [Pa].
    """
    return np.asarray(4 / 3 * contact_modulus * np.sqrt(radius_of_curvature) * np.asarray(depth) ** 1.5)


def sneddon_force(depth: ArrayLike, slope: float, contact_modulus: float) -> FloatArray:
    """F = 2/pi E* delta^2 / tan(theta): a cone of slope tan(theta) against the surface.

    Args:
        depth: delta [m].
        slope: tan(theta); the half angle alpha of the cone has tan(alpha) = 1/slope.
        contact_modulus: E* [Pa].
    """
    return np.asarray(2 / np.pi * contact_modulus / slope * np.asarray(depth) ** 2)


def punch_force(depth: ArrayLike, radius: float, contact_modulus: float) -> FloatArray:
    """F = 2 E* a delta: a flat punch.

    Args:
        depth: delta [m].
        radius: a [m].
        contact_modulus: E* [Pa].
    """
    return np.asarray(2 * contact_modulus * radius * np.asarray(depth))

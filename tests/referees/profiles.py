"""Slope of the equivalent plane profile g(x) = x int_0^x f'(r) / sqrt(x^2 - r^2) dr of every indenter, in closed form.

Popov, Hess and Willert, Handbook of Contact Mechanics (2019), chapter 2, gives these forms; a tabulated profile is a
cubic between its radii, for which the integral is elementary as well. They are written here a second time on purpose.
"""

import math
from functools import singledispatch
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from contact import (
    Cone,
    InvalidInput,
    Paraboloid,
    PowerLaw,
    Profile,
    Sphere,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
)
from contact.records.validation import FloatArray


@singledispatch
def equivalent_slope(indenter: Profile, excess: FloatArray, room: FloatArray) -> FloatArray:
    """g'(x) at x = b + excess, `room` [m] before the end of the profile.

    Raises:
        InvalidInput: For a profile of which no closed form is known here.
    """
    raise InvalidInput(f"{type(indenter).__name__}: no closed form of its half-space profile stands here; add it")


@equivalent_slope.register
def _(indenter: Paraboloid, excess: FloatArray, room: FloatArray) -> FloatArray:
    return 2 * excess / indenter.radius_of_curvature


@equivalent_slope.register
def _(indenter: Sphere, excess: FloatArray, room: FloatArray) -> FloatArray:
    R = indenter.radius
    return 0.5 * np.log1p(2 * excess / room) + 0.5 * (R / room - R / (R + excess))


@equivalent_slope.register
def _(indenter: Cone, excess: FloatArray, room: FloatArray) -> FloatArray:
    return np.full_like(excess, 0.5 * math.pi * indenter.slope)


@equivalent_slope.register
def _(indenter: PowerLaw, excess: FloatArray, room: FloatArray) -> FloatArray:
    n, R = indenter.exponent, indenter.reference_radius
    kappa = math.sqrt(math.pi) * math.exp(math.lgamma(n / 2 + 1) - math.lgamma((n + 1) / 2))
    return kappa * n * indenter.reference_height / R * (excess / R) ** (n - 1)


@equivalent_slope.register
def _(indenter: TruncatedCone, excess: FloatArray, room: FloatArray) -> FloatArray:
    root = np.sqrt(excess * (excess + 2 * indenter.flat_radius))
    return indenter.slope * (np.arctan(root / indenter.flat_radius) + indenter.flat_radius / root)


@equivalent_slope.register
def _(indenter: TruncatedParaboloid, excess: FloatArray, room: FloatArray) -> FloatArray:
    root = np.sqrt(excess * (excess + 2 * indenter.flat_radius))
    return np.asarray((root + (indenter.flat_radius + excess) ** 2 / root) / indenter.radius_of_curvature)


@equivalent_slope.register
def _(indenter: Tabulated, excess: FloatArray, room: FloatArray) -> FloatArray:
    """g' = int (f' + r f'')/sqrt(x^2 - r^2) dr, in which f' + r f'' is a quadratic on each piece, as f' is."""
    curve = PchipInterpolator(indenter.radii, indenter.heights)
    extended = np.asarray(excess, dtype=np.longdouble)
    slope = np.zeros_like(extended)
    for (start, end), (c0, c1, c2, _) in zip(pairwise(indenter.radii.astype(np.longdouble)), curve.c.T, strict=True):
        slope += _piece(extended, start, end, np.array([3 * c0, 2 * c1 + 3 * c0 * start, c2 + 2 * c1 * start, 0]))
    return np.asarray(slope, dtype=np.float64)


def _piece(
    x: NDArray[np.longdouble], start: np.longdouble, end: np.longdouble, cubic: FloatArray
) -> NDArray[np.longdouble]:
    """int f'(r)/sqrt(x^2 - r^2) dr over [start, end] below x, f = c0 s^3 + c1 s^2 + c2 s + c3 with s = r - start."""
    first, last = np.minimum(start, x), np.minimum(end, x)
    roots = _leg(x, first), _leg(x, last)
    angle = np.arctan2(last, roots[1]) - np.arctan2(first, roots[0])  # int 1/sqrt
    linear = roots[0] - roots[1]  # int r/sqrt
    square = 0.5 * (x**2 * angle - last * roots[1] + first * roots[0])  # int r^2/sqrt
    c0, c1, c2, _ = cubic
    integral: NDArray[np.longdouble] = (
        3 * c0 * (square - 2 * start * linear + start**2 * angle) + 2 * c1 * (linear - start * angle) + c2 * angle
    )
    return integral


def _leg(x: Any, b: Any) -> Any:
    """sqrt(x^2 - b^2), zero for x < b, with all its digits near b."""
    return np.sqrt(np.maximum((x - b) * (x + b), 0.0))

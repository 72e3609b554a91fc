"""Coulomb wave functions, the Fourier transforms of the half-space's adhered densities.

``a_n(eps, z) = exp(pi eps/2) F_n(eps, z)/z`` with the regular Coulomb wave function F_n of charge eps. At eps = 0 they
are spherical Bessel functions j_n. Miller's algorithm runs the recurrence downwards, where the wanted solution grows
fastest, and a generating sum fixes the scale.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from contact.records.errors import NotConvergedError
from contact.records.validation import FloatArray

# Downward recurrences begin this many orders, and six cube roots of z, beyond the larger of order and argument: the
# unwanted solution has then decayed by more than 16 digits (2e-12 over z against mpmath at z = 2000).
_ORDERS_BEFORE = 40
_WIDTH_OF_TURNING_POINT = 6.0
# Values are rescaled when they pass this, far from the largest double.
_LARGE = 1e200
# The scale factor is real; its imaginary part, relative, tells rounding and nothing else.
_LARGEST_IMAGINARY_PART = 1e-9


@dataclass(frozen=True)
class CoulombFunctions:
    """a_n of one charge.

    Attributes:
        charge: eps, of either sign.
        values: a_n(eps, z) for n = 0 .. count - 1, shape (count, points).
    """

    charge: float
    values: FloatArray


def phases(charge: float, count: int) -> FloatArray:
    """th_n = sum_{j=1}^n atan(eps/j) for n = 0 .. count - 1."""
    return np.concatenate([[0.0], np.cumsum(np.arctan(charge / np.arange(1, count)))])


def coulomb_functions(charge: float, z: FloatArray, count: int) -> CoulombFunctions:
    """a_0 .. a_(count-1) at z > 0, shape (points,).

    Raises:
        NotConvergedError: If the generating sum does not give a real scale.
    """
    if not z.size:
        return CoulombFunctions(charge, np.zeros((count, 0)))
    first = (np.maximum(count, z) + _ORDERS_BEFORE + _WIDTH_OF_TURNING_POINT * np.cbrt(z)).astype(int)
    top = int(first.max())
    turns = (-1j) ** (np.arange(top + 1) % 4) * np.exp(-1j * phases(charge, top + 1)) * (2 * np.arange(top + 1) + 1)
    values = np.zeros((count, z.size))
    above, here, total = np.zeros(z.size), np.zeros(z.size), np.zeros(z.size, dtype=complex)
    for n in range(top, -1, -1):
        here = np.where(first == n, 1e-250, here)
        total += turns[n] * here
        if n < count:
            values[n] = here
        large = np.abs(here) > _LARGE
        if large.any():
            for array in (here, above, total):
                array[large] /= _LARGE
            values[:, large] /= _LARGE
        if n:
            up, down = charge / (n + 1), charge / n
            below = ((2 * n + 1) / z + down + up) * here - math.hypot(1.0, up) * above
            above, here = here, below / math.hypot(1.0, down)
    factor = math.sqrt(gamma_squared(charge)) * np.exp(-1j * z) / total
    if not np.all(np.abs(factor.imag) <= _LARGEST_IMAGINARY_PART * np.abs(factor)):
        raise NotConvergedError(f"Coulomb wave functions of charge {charge:g} found no real scale up to {z.max():g}")
    return CoulombFunctions(charge, values * factor.real)


def gamma_squared(charge: float) -> float:
    """|Gamma(1 + i eps)|^2 = pi eps / sinh(pi eps), 1 at eps = 0."""
    return math.pi * charge / math.sinh(math.pi * charge) if charge else 1.0

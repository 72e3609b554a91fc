"""Functions known at Chebyshev points of a panel: coefficients, integrals, conversion to powers of z in [-1, 1]."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from contact.validation import FloatArray

_SAMPLES, _NEWTON_STEPS = 33, 4
_REACH = 2.0 / (_SAMPLES - 1)  # no maximum is farther from the best sample


@cache
def nodes(count: int) -> FloatArray:
    """Chebyshev points of the first kind in (-1, 1), increasing; no panel end is among them."""
    return -np.cos(np.pi * (np.arange(count) + 0.5) / count)


@cache
def analysis(count: int) -> FloatArray:
    """Matrix from values at `nodes(count)` to Chebyshev coefficients, shape (count, count)."""
    order = np.arange(count)[:, None]
    matrix = 2.0 / count * np.cos(order * np.arccos(nodes(count)))
    matrix[0] *= 0.5
    return np.asarray(matrix)


@cache
def integration(count: int) -> FloatArray:
    """Matrix from `count` Chebyshev coefficients to those of the integral from z = -1, shape (count + 1, count)."""
    return np.stack([chebyshev.chebint(unit, lbnd=-1.0) for unit in _units(count)], axis=1)


@cache
def differentiation(count: int) -> FloatArray:
    """Matrix from `count` Chebyshev coefficients to those of the derivative, padded to shape (count, count)."""
    return np.stack([_padded(chebyshev.chebder(unit), count) for unit in _units(count)], axis=1)


@cache
def to_powers(count: int) -> FloatArray:
    """Matrix from Chebyshev coefficients to powers of z.

    Powers cost half of Clenshaw's recurrence, and lose no digits while the coefficients decay faster than 2.4^-n.
    """
    return np.stack([_padded(chebyshev.cheb2poly(unit), count) for unit in _units(count)], axis=1)


def horner(coefficients: FloatArray, z: FloatArray) -> FloatArray:
    """Sum of coefficients[k] z^k over the first axis; z broadcasts against the others."""
    value: FloatArray = coefficients[-1] * z + coefficients[-2]
    for coefficient in coefficients[-3::-1]:
        value *= z
        value += coefficient
    return value


def powers(z: FloatArray, count: int) -> FloatArray:
    """1, z, z^2, ..., shape (count, *z.shape)."""
    ladder = np.empty((count, *z.shape))
    ladder[0], ladder[1:] = 1.0, z
    return np.multiply.accumulate(ladder, axis=0, out=ladder)


def largest(coefficients: FloatArray, present: NDArray[np.bool_]) -> FloatArray:
    """Largest value in z in [-1, 1] of many polynomials per lane.

    The best sample of each is polished by Newton's method on its slope.

    Args:
        coefficients: Powers of z, shape (m, polynomials, lanes).
        present: Which of them exist, shape (polynomials, lanes).

    Returns:
        Shape (lanes,).
    """
    samples = np.linspace(-1.0, 1.0, _SAMPLES)
    values = np.tensordot(powers(samples, coefficients.shape[0]).T, coefficients, 1)
    first = coefficients[1:] * np.arange(1.0, coefficients.shape[0])[:, None, None]
    second = first[1:] * np.arange(1.0, first.shape[0])[:, None, None]
    z = samples[values.argmax(axis=0)]
    for _ in range(_NEWTON_STEPS):
        slope, curvature = horner(first, z), horner(second, z)
        concave = -curvature * _REACH > np.abs(slope)  # otherwise the maximum is an end, or already found
        z = np.clip(z - np.where(concave, slope / np.where(concave, curvature, 1.0), 0.0), -1.0, 1.0)
    found = np.maximum(values.max(axis=0), horner(coefficients, z))
    return np.asarray(np.where(present, found, -np.inf).max(axis=0))


def _units(count: int) -> FloatArray:
    return np.eye(count)


def _padded(coefficients: FloatArray, count: int) -> FloatArray:
    return np.pad(coefficients, (0, count - coefficients.size))

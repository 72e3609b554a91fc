"""Chebyshev sums, and functions known at Chebyshev points of a panel: coefficients, integrals, powers of z."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from contact.records.validation import FloatArray

# Up to so many points cosines are summed in one step, beyond them by Clenshaw's recurrence (`chebyshev_sum`).
FEW_POINTS = 400
# Up to so many points powers are made in one call. It strides over columns: for 2560 points it took 36 times as long as
# a call for each power, for 100 as long (17 powers, 2026-11-22).
FEW_POWERS = 128
# Points at which polynomials are sampled to find their largest values; no maximum is farther from the best of them than
# the distance of two neighbours.
_SAMPLE_POINTS = np.linspace(-1.0, 1.0, 33)
_SPACING = 2.0 / 32


def chebyshev_sum(coefficients: FloatArray, s: FloatArray) -> FloatArray:
    """Chebyshev sums: coefficients (*shape, m) at s in [-1, 1] of that shape.

    A few points are summed as cosines in one step; for many, Clenshaw's recurrence needs less memory and time.
    """
    if s.size <= FEW_POINTS:
        angles = np.arccos(np.minimum(np.maximum(s, -1.0), 1.0))
        cosines = np.cos(np.multiply.outer(angles, np.arange(coefficients.shape[-1])))
        few: FloatArray = np.sum(coefficients * cosines, axis=-1)
        return few
    older, newer = np.zeros_like(s), np.zeros_like(s)
    for k in range(coefficients.shape[-1] - 1, 0, -1):
        older, newer = newer, 2 * s * newer - older + coefficients[..., k]
    return s * newer - older + coefficients[..., 0]


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


def powers(z: FloatArray, count: int) -> FloatArray:
    """1, z, z^2, ..., shape (count, *z.shape)."""
    ladder = np.empty((count, *z.shape))
    if z.size <= FEW_POWERS:
        ladder[0], ladder[1:] = 1.0, z
        return np.multiply.accumulate(ladder, axis=0, out=ladder)
    ladder[0], ladder[1] = 1.0, z
    for k in range(2, count):
        np.multiply(ladder[k - 1], z, out=ladder[k])
    return ladder


def largest(coefficients: FloatArray, present: NDArray[np.bool_]) -> FloatArray:
    """Largest value in z in [-1, 1] of several polynomials, for many scenes at once.

    The best sample of each is improved by four steps of Newton's method on its slope.

    Args:
        coefficients: Powers of z, shape (m, polynomials, scenes).
        present: Which of them exist, shape (polynomials, scenes).

    Returns:
        Shape (scenes,).
    """
    count = coefficients.shape[0]
    # A matrix product would round many scenes in another order than a few.
    values = np.einsum("nk,kpl->npl", _sample_powers(count), coefficients)
    z = _SAMPLE_POINTS[values.argmax(axis=0)]
    first = _derivative(coefficients)
    all_three = np.stack([coefficients, first, _derivative(first)])
    for _ in range(4):
        _, slope, curvature = np.einsum("dkpl,kpl->dpl", all_three, powers(z, count))
        # Where this does not hold the maximum is at an end, or already found.
        concave = -curvature * _SPACING > np.abs(slope)
        z = np.clip(z - np.where(concave, slope / np.where(concave, curvature, 1.0), 0.0), -1.0, 1.0)
    found = np.maximum(values.max(axis=0), np.einsum("kpl,kpl->pl", coefficients, powers(z, count)))
    return np.asarray(np.where(present, found, -np.inf).max(axis=0))


def _derivative(coefficients: FloatArray) -> FloatArray:
    """Of polynomials in powers of z, padded to as many powers."""
    slopes = np.zeros_like(coefficients)
    slopes[:-1] = coefficients[1:] * np.arange(1.0, coefficients.shape[0])[:, None, None]
    return slopes


@cache
def _sample_powers(count: int) -> FloatArray:
    """Powers of z at the samples, shape (33, count)."""
    return powers(_SAMPLE_POINTS, count).T


def _units(count: int) -> FloatArray:
    return np.eye(count)


def _padded(coefficients: FloatArray, count: int) -> FloatArray:
    return np.pad(coefficients, (0, count - coefficients.size))

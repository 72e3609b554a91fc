"""First guesses of a fit: modulus and baseline by linear least squares at trial contact points."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from contact.records.validation import FloatArray

# Trial contact points: a fiftieth of the curve apart, which is close enough for Newton's method to go on.
TRIALS = 50
# Trial contact points reach from the first depth on so far into the curve.
_FURTHEST = 0.9


class CurveShape(Protocol):
    """A force curve of a given shape: what a fit of Young's modulus needs."""

    def per_modulus(self, depth: ArrayLike) -> FloatArray:
        """phi = F/E [m^2] at depths [m], zero where nothing touches."""

    def per_modulus_slope(self, depth: ArrayLike) -> FloatArray:
        """d(phi)/d(depth) [m]."""


def trial_points(depth: FloatArray) -> FloatArray:
    """Contact points [m] to be tried for curves of shape (..., n): shape (..., TRIALS)."""
    low = depth.min(axis=-1, keepdims=True)
    return np.asarray(low + _FURTHEST * np.ptp(depth, axis=-1, keepdims=True) * np.arange(TRIALS) / TRIALS)


def linear_start(
    shape: CurveShape,
    depth: FloatArray,
    force: FloatArray,
    *,
    contact_point: bool,
    baseline: bool,
    at: float = 0.0,
    misfit: bool = False,
) -> tuple[float, float, float]:
    """Contact point [m] (or the misfit there [N^2]), modulus [Pa] and baseline [N] of one curve.

    Args:
        shape: Force over modulus.
        depth: [m], shape (n,).
        force: [N], shape (n,).
        contact_point: Whether the best of the trial points is taken; else the one given.
        baseline: Whether a constant force is fitted too.
        at: The contact point [m] if it is given.
        misfit: Whether the sum of squares is returned in place of the contact point.
    """
    points = trial_points(depth) if contact_point else np.array([at])
    phi = shape.per_modulus(np.maximum(depth - points[:, None], 0.0))
    modulus, constant, squares = linear_fit(phi, force[None, :], baseline=baseline)
    best = int(np.argmin(np.where(modulus > 0.0, squares, np.inf)))
    first = squares[best] if misfit else points[best]
    return float(first), float(modulus[best]), float(constant[best])


def linear_fit(phi: FloatArray, force: FloatArray, *, baseline: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Modulus, constant and sum of squares of F = E phi + f0 along the last axis."""
    mean_phi = phi.mean(axis=-1, keepdims=True) if baseline else 0.0
    mean_force = force.mean(axis=-1, keepdims=True) if baseline else 0.0
    x, y = phi - mean_phi, force - mean_force
    square = np.sum(x * x, axis=-1)
    modulus = np.divide(np.sum(x * y, axis=-1), square, out=np.zeros_like(square), where=square > 0.0)
    squares = np.sum((y - modulus[..., None] * x) ** 2, axis=-1)
    constant = (mean_force - modulus[..., None] * mean_phi)[..., 0] if baseline else np.zeros_like(modulus)
    return modulus, np.broadcast_to(constant, modulus.shape), squares

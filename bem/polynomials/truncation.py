"""What polynomials through Gauss nodes leave out: how large, and where between the nodes."""

from __future__ import annotations

import numpy as np

from contact.records.validation import FloatArray

# Bounds of the factor by which coefficients are taken to fall from order to order. A function analytic on a panel's
# neighbourhood that is resolved at all falls faster than by 0.8; what has reached rounding shows no rate below 0.05.
SLOWEST, FASTEST = 0.8, 0.05
_TINY = float(np.finfo(float).tiny)


def orders_beyond(coefficients: FloatArray, rate: float | None = None) -> FloatArray:
    """Sum of the absolute Chebyshev coefficients of order m and higher, as their geometric decay below m tells.

    Each of the last four is continued at the rate of decay, and the largest counts: coefficients of analytic functions
    oscillate, and one of them may vanish by chance.

    Args:
        coefficients: Of the orders 0 .. m - 1 in the last axis, shape (..., m), m >= 4.
        rate: By which they fall from order to order, if analyticity tells it; otherwise that of the given ones.

    Returns:
        Shape (...).
    """
    size = np.abs(coefficients)
    count = size.shape[-1]
    first = np.maximum(size[..., 1:].max(axis=-1), _TINY)
    last = np.maximum(size[..., -2:].max(axis=-1), _TINY)
    seen = np.clip((last / first) ** (1.0 / (count - 2.5)), FASTEST, SLOWEST)
    fall = seen if rate is None else np.full_like(seen, rate)
    ahead = np.arange(min(4, count), 0.0, -1.0)
    next_one = np.max(size[..., -ahead.size :] * fall[..., None] ** ahead, axis=-1)
    beyond: FloatArray = next_one / (1.0 - fall)
    return beyond


def rate_of_decay(distance: float) -> float:
    """1/rho of Chebyshev coefficients on [-1, 1] of a function analytic up to a distance beside the interval's ends.

    rho = d + sqrt(d^2 + 1) is the sum of the half-axes of the ellipse with the half-axis d across the interval.
    """
    return float(1.0 / (distance + np.sqrt(distance**2 + 1.0)))


def between_nodes(count: int, s: FloatArray) -> FloatArray:
    """Interpolation error at s in [-1, 1] by `count` Gauss nodes, relative to the first Chebyshev coefficient left out.

    The error is a_m P_m(s) with the Legendre coefficient a_m = sqrt(pi m)/2 c_m; by Bernstein's inequality |P_m| is
    at most sqrt(2/(pi m)) (1 - s^2)^(-1/4), and at most 1.
    """
    inner = np.maximum((1.0 - s) * (1.0 + s), _TINY) ** -0.25 / np.sqrt(2.0)
    envelope: FloatArray = np.minimum(inner, at_end(count))
    return envelope


def at_end(count: int) -> float:
    """The same at the ends of a panel, where it is largest."""
    return float(np.sqrt(np.pi * count) / 2.0)


def integrated(count: int) -> float:
    """Integral of that error from one end to any s, the panel's length being 1: int P_m = (P_m+1 - P_m-1)/(2m + 1)."""
    return float(np.sqrt(2.0 / (np.pi * count)) / (2 * count + 1) * at_end(count))


def integrated_share(count: int, s: FloatArray) -> FloatArray:
    """What of that is left at s in [0, 1] close to the end: int_0^s |P_m| is at most s."""
    return np.asarray(np.minimum(1.0, s * at_end(count) / integrated(count)))

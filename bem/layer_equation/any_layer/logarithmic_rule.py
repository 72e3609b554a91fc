"""Integrals of polynomials on panels times ln|x - t|, exactly, by Legendre functions of the second kind.

With ``I_n(z) = int_-1^1 P_n(u) ln|z - u| du``: I_0 in closed form, and ``I_n = 2 (Q_(n+1) - Q_(n-1))/(2n + 1)``.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from bem.polynomials.gauss_panels import gauss_nodes
from contact.records.validation import FloatArray

# Up to this |z| the recurrence upwards loses two digits at most; beyond it the one downwards is started so many orders
# above that what it starts with has fallen below a rounding.
UPWARDS_TO: Final = 1.02
ORDERS_ABOVE: Final = 110


def logarithmic_weights(ends: FloatArray, count: int, targets: FloatArray) -> FloatArray:
    """Weights of values at all panels' Gauss nodes in int u(t) ln|x - t| dt, shape (targets, panels count).

    Args:
        ends: Of the panels, shape (P + 1,).
        count: Nodes on each panel.
        targets: x, outside the panels too, shape (n,).
    """
    half, middle = np.diff(ends) / 2, (ends[1:] + ends[:-1]) / 2
    tau, omega = gauss_nodes(count)
    integrals = _integrals((targets[:, None] - middle) / half, count)
    integrals[..., 0] += 2 * np.log(half)
    legendre = np.polynomial.legendre.legvander(2 * tau - 1, count - 1)
    to_nodes = 2 * omega[:, None] * legendre * (np.arange(count) + 0.5)
    weights = half[:, None] * (integrals @ to_nodes.T)
    return np.asarray(weights.reshape(len(targets), -1))


def _integrals(z: FloatArray, count: int) -> FloatArray:
    """I_n for n below `count`, shape (*z.shape, count)."""
    # On a panel's end the factors of the infinite logarithms vanish.
    z = np.where(np.abs(np.abs(z) - 1) < 1e-15, z * (1 - 1e-15), z)
    Q = np.where((np.abs(z) <= UPWARDS_TO)[..., None], _upwards(z, count + 1), _downwards(z, count + 1))
    order = np.arange(1, count)
    first = (1 + z) * np.log(np.abs(1 + z)) + (1 - z) * np.log(np.abs(1 - z)) - 2
    return np.concatenate(
        [first[..., None], 2 * (Q[..., 2:] - Q[..., :-2])[..., : count - 1] / (2 * order + 1)], axis=-1
    )


def _upwards(z: FloatArray, count: int) -> FloatArray:
    """Q_n for n below `count` where |z| is not much above one."""
    near = np.clip(z, -UPWARDS_TO, UPWARDS_TO)
    Q = np.empty((*z.shape, count))
    Q[..., 0] = np.log(np.abs((1 + near) / (1 - near))) / 2
    Q[..., 1] = near * Q[..., 0] - 1
    for n in range(1, count - 1):
        Q[..., n + 1] = ((2 * n + 1) * near * Q[..., n] - n * Q[..., n - 1]) / (n + 1)
    return Q


def _downwards(z: FloatArray, count: int) -> FloatArray:
    """Q_n for n below `count` where |z| > 1, by ratios of neighbours from above."""
    far = np.where(np.abs(z) > UPWARDS_TO, z, 2.0)
    ratio = np.zeros_like(far)
    ratios = np.empty((*z.shape, count))
    for n in range(count + ORDERS_ABOVE, 0, -1):
        # Q_n/Q_(n-1) = n/((2n + 1) z - (n + 1) Q_(n+1)/Q_n).
        ratio = n / ((2 * n + 1) * far - (n + 1) * ratio)
        if n < count:
            ratios[..., n] = ratio
    ratios[..., 0] = np.arctanh(1 / far)
    return np.asarray(np.cumprod(ratios, axis=-1))

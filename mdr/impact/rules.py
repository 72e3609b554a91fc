"""Polynomials in time: Gauss nodes of one phase, integrals up to them, and integrals with a fading memory.

A phase lasts a time T. Its functions are polynomials of s on [0, 1], given by their values at n Gauss nodes, and

    t/T = s^p              from the start of a growth, where the contact radius is a power of the time,
    t/T = 1 - (1 - s)^p    towards the end of a shrinkage.

A branch with relaxation rate r integrates f with the memory int_0^t exp(-r (t - t')) f(t') dt'. Product integration
makes it exact for polynomials f and any r T: between neighbouring nodes panels shrink towards the later one, and what
they miss of int exp(-r (t - t')) dt' is assigned to it.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from bem.numerics import barycentric, gauss
from contact.records.validation import FloatArray

# Panels between neighbouring nodes, and Gauss nodes on each: exact for r T up to 1e5. With half as many panels
# r T = 1e3 errs by 1e-8, with half the nodes all of them do.
_PANELS, _PANEL_NODES = 13, 8


class Rule(NamedTuple):
    """Nodes of a phase, n of them; the row n belongs to the end of the phase.

    Attributes:
        nodes: s, shape (n,).
        power: p.
        is_ending: Whether s crowds at the end.
        share: t/T at nodes and end, shape (n + 1,).
        lags: (t_m - t_k)/T of nodes and end, infinite for t_k > t_m, shape (n + 1, n + 1).
        gaps: (t_m - t)/T at the q nodes t of the panels before t_m, shape (n + 1, q).
        weights: Weights of these q nodes, shape (n + 1, q).
        rows: Values of the n basis polynomials there, shape (n + 1, q, n).
        integrals: Integrals of the basis polynomials up to t_m, over T, shape (n + 1, n).
        derivative: Matrix of d/ds at the nodes, shape (n, n).
        at_end: Values of the basis polynomials at the end, shape (n,).
    """

    nodes: FloatArray
    power: float
    is_ending: bool
    share: FloatArray
    lags: FloatArray
    gaps: FloatArray
    weights: FloatArray
    rows: FloatArray
    integrals: FloatArray
    derivative: FloatArray
    at_end: FloatArray

    def memory(self, rates: FloatArray) -> FloatArray:
        """Integrals with memory of the basis polynomials, over T.

        Args:
            rates: r T, shape (lanes, branches); that of the first branch is zero.

        Returns:
            Matrices from values at the nodes to nodes and end, shape (lanes, branches, n + 1, n).
        """
        n, fading = self.nodes.size, rates[:, 1:]
        z = fading[..., None, None]
        weights = np.exp(-z * self.gaps) * self.weights
        local = (weights[..., None, :] @ self.rows)[..., 0, :]
        step = np.diff(self.share, prepend=0.0)
        missed = -np.expm1(-fading[..., None] * step) / fading[..., None] - weights.sum(axis=-1)
        local[..., np.arange(n), np.arange(n)] += missed[..., :n]
        local[..., n, :] += missed[..., n:] * self.at_end
        lasting = np.broadcast_to(self.integrals, (len(rates), 1, n + 1, n))
        return np.concatenate([lasting, np.exp(-z * self.lags) @ local], axis=1)

    def place(self, share: FloatArray) -> FloatArray:
        """s at shares of the duration."""
        return 1 - (1 - share) ** (1 / self.power) if self.is_ending else share ** (1 / self.power)


@lru_cache(maxsize=64)
def rule(count: int, power: float, *, is_ending: bool) -> Rule:
    """The rule with `count` nodes."""
    nodes, w = gauss(count)
    analysis = (legendre.legvander(2 * nodes - 1, count - 1) * w[:, None] * (2 * np.arange(count) + 1)).T
    ends = np.append(nodes, 1.0)
    y, v = gauss(_PANEL_NODES)
    far = 0.5 ** np.arange(_PANELS)
    width = far - np.append(far[1:], 0.0)
    step = np.diff(ends, prepend=0.0)[:, None]
    s = np.maximum(ends[:, None] - step * ((far - width)[:, None] + width[:, None] * y).ravel(), 0.0)
    if is_ending:
        share, place, speed = 1 - (1 - ends) ** power, 1 - (1 - s) ** power, power * (1 - s) ** (power - 1)
    else:
        share, place, speed = ends**power, s**power, power * s ** (power - 1)
    weights = step * (width[:, None] * v).ravel() * speed
    rows = legendre.legvander(2 * s - 1, count - 1) @ analysis
    integrals = np.cumsum((weights[:, None, :] @ rows)[:, 0], axis=0)
    derivative = np.asarray(legendre.legval(2 * nodes - 1, 2 * legendre.legder(analysis)).T, dtype=np.float64)
    lags = np.where(np.tri(count + 1, dtype=bool), share[:, None] - share, np.inf)
    gaps = share[:, None] - place
    return Rule(nodes, power, is_ending, share, lags, gaps, weights, rows, integrals, derivative, analysis.sum(axis=0))


@lru_cache(maxsize=64)
def _points(count: int, *, with_ends: bool) -> tuple[FloatArray, FloatArray]:
    """Gauss nodes, maybe with both ends of [0, 1], and their barycentric weights."""
    points = np.concatenate([[0.0], gauss(count - 2)[0], [1.0]]) if with_ends else gauss(count)[0]
    return points, barycentric(points)


def interpolated(values: FloatArray, s: FloatArray, *, with_ends: bool = False) -> FloatArray:
    """Polynomials through values at Gauss nodes.

    Args:
        values: Values at the nodes, or at s = 0, the nodes and s = 1, shape (lanes, rows, n).
        s: Places, shape (lanes, k) or (1, k).
        with_ends: Whether the values include those at both ends.

    Returns:
        Values at the places, shape (lanes, rows, k).
    """
    points, weights = _points(values.shape[-1], with_ends=with_ends)
    gap = np.subtract(
        s[..., None], points, order="C"
    )  # the order of products, and so their rounding, is that of one lane
    share = weights / np.where(gap == 0, 1e-200, gap)
    return np.asarray((values @ np.swapaxes(share, 1, 2)) / share.sum(axis=-1)[:, None])


def times(matrix: FloatArray, vector: FloatArray) -> FloatArray:
    """Products of matrices and vectors, each by itself, so that they do not depend on the number of them."""
    return np.asarray((matrix @ vector[..., None])[..., 0])

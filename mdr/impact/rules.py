"""Polynomials in time: Gauss nodes of one phase, integrals up to them, and integrals with a fading memory.

A phase lasts a time T. Its functions are polynomials of s on [0, 1], given by their values at n Gauss nodes, and

    t/T = s^p              from the start of a growth, where the contact radius is a power of the time,
    t/T = 1 - (1 - s)^p    towards the end of a shrinkage.

A branch with relaxation rate r integrates f with the memory int_0^t exp(-r (t - t')) f(t') dt'. Product integration
makes it exact for polynomials f and any r T: between neighbouring nodes panels shrink towards the later one, and what
they miss of int exp(-r (t - t')) dt' is assigned to it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre

from bem.numerics import barycentric, gauss
from contact.records.validation import FloatArray

# Panels between neighbouring nodes, and Gauss nodes on each: exact for r T up to 1e5. With half as many panels
# r T = 1e3 errs by 1e-8, with half the nodes all of them do.
_PANELS, _NODES = 13, 8


@dataclass(frozen=True, eq=False)
class Rule:
    """Nodes of a phase, n of them; a row m = n belongs to the end of the phase.

    Attributes:
        nodes: s, shape (n,).
        power: p.
        ending: Whether s crowds at the end.
        share: t/T at the nodes and the end, shape (n + 1,).
        lags: (t_m - t_k)/T of nodes and end, infinite before, shape (n + 1, n + 1).
        gaps: (t_m - t)/T at the nodes t of the panels before t_m, shape (n + 1, q).
        weights: Of these nodes, shape (n + 1, q).
        rows: Values of the n basis polynomials there, shape (n + 1, q, n).
        integrals: Of the basis polynomials up to t_m, over T, shape (n + 1, n).
        analysis: Legendre coefficients of the basis polynomials, shape (n, n).
        at_end: Values of the basis polynomials at the end, shape (n,).
    """

    nodes: FloatArray
    power: float
    ending: bool
    share: FloatArray
    lags: FloatArray
    gaps: FloatArray
    weights: FloatArray
    rows: FloatArray
    integrals: FloatArray
    analysis: FloatArray
    at_end: FloatArray

    def memory(self, rates: FloatArray) -> FloatArray:
        """Integrals with memory of the basis polynomials over T at rates r T > 0, shape (..): shape (.., n + 1, n)."""
        z = rates[..., None, None]
        weights = np.exp(-z * self.gaps) * self.weights
        local = (weights[..., None, :] @ self.rows)[..., 0, :]
        step = np.diff(self.share, prepend=0.0)
        missed = -np.expm1(-rates[..., None] * step) / rates[..., None] - weights.sum(axis=-1)
        n = self.nodes.size
        local[..., np.arange(n), np.arange(n)] += missed[..., :n]
        local[..., n, :] += missed[..., n:] * self.at_end
        return np.asarray(np.exp(-z * self.lags) @ local)

    def at(self, values: FloatArray, s: FloatArray) -> FloatArray:
        """Polynomials through values at the nodes, shape (lanes, n), at s, shape (lanes, k)."""
        basis = vander(s, self.nodes.size) @ self.analysis
        return np.asarray((basis @ values[..., None])[..., 0])

    def place(self, share: FloatArray) -> FloatArray:
        """s at shares of the duration."""
        return 1 - (1 - share) ** (1 / self.power) if self.ending else share ** (1 / self.power)


def vander(s: FloatArray, count: int) -> FloatArray:
    """P_0(2 s - 1), .. at s, the last axis the degree; contiguous, since others round with the number of lanes."""
    return np.ascontiguousarray(legendre.legvander(2 * s - 1, count - 1))


@lru_cache(maxsize=64)
def rule(count: int, power: float, *, ending: bool) -> Rule:
    """The rule with so many nodes."""
    nodes, w = gauss(count)
    k = np.arange(count)
    analysis = (vander(nodes, count) * w[:, None] * (2 * k + 1)).T
    ends = np.append(nodes, 1.0)
    y, v = gauss(_NODES)
    far = 0.5 ** np.arange(_PANELS)
    near = np.append(far[1:], 0.0)
    x = (near[:, None] + (far - near)[:, None] * y).ravel()
    weight = ((far - near)[:, None] * v).ravel()
    step = np.diff(ends, prepend=0.0)[:, None]
    s = np.maximum(ends[:, None] - step * x, 0.0)
    if ending:
        share, place, speed = 1 - (1 - ends) ** power, 1 - (1 - s) ** power, power * (1 - s) ** (power - 1)
    else:
        share, place, speed = ends**power, s**power, power * s ** (power - 1)
    weights = step * weight * speed
    rows = vander(s, count) @ analysis
    integrals = np.cumsum((weights[:, None, :] @ rows)[:, 0], axis=0)
    at_end = analysis.sum(axis=0)
    lags = np.where(np.tri(count + 1, dtype=bool), share[:, None] - share, np.inf)
    return Rule(nodes, power, ending, share, lags, share[:, None] - place, weights, rows, integrals, analysis, at_end)


@lru_cache(maxsize=64)
def resampling(count: int, other: int) -> FloatArray:
    """Matrix from values at so many Gauss nodes to those of another number, shape (other, count)."""
    return np.asarray(vander(gauss(other)[0], count) @ rule(count, 1, ending=False).analysis)


@lru_cache(maxsize=64)
def slopes(count: int) -> FloatArray:
    """Legendre coefficients of the first and second derivatives by s of P_0(2 s - 1), .., shape (2, count, count)."""
    unit, found = np.eye(count), np.zeros((2, count, count))
    for order, rows in enumerate(found, 1):
        rows[: max(count - order, 0)] = legendre.legder(unit, order)[: max(count - order, 0)] * 2.0**order
    return found


@lru_cache(maxsize=64)
def _lookup(count: int) -> tuple[FloatArray, FloatArray]:
    """Nodes of a growth and its end, and their barycentric weights."""
    nodes = np.append(gauss(count)[0], 1.0)
    return nodes, barycentric(nodes)


def interpolated(values: FloatArray, s: FloatArray) -> FloatArray:
    """Rows of values at nodes and end, shape (lanes, rows, n + 1), at s, shape (lanes, k); shape (lanes, rows, k)."""
    nodes, weights = _lookup(values.shape[-1] - 1)
    gap = s[..., None] - nodes
    share = weights / np.where(gap == 0, 1e-200, gap)
    return np.asarray((values @ np.swapaxes(share, 1, 2)) / share.sum(axis=-1)[:, None])

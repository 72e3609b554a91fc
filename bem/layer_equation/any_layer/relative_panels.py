"""Panels on [0, 1], graded to both ends, with rules for integrals of polynomials times a logarithmic kernel.

The same panels serve contacts of all radii x, because the rules ask for the kernel at x times given distances only.
A target is a node, or the edge 1, which is the last target.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Final

import numpy as np

from bem.polynomials.gauss_panels import gauss_nodes, lagrange_matrix
from contact.records.validation import FloatArray

# Panels shrink by this ratio towards both ends, so many times: the last is 8e-6 of the whole.
RATIO: Final = 0.25
LEVELS: Final = 8
# How many times under loads with rims and bends: towards the axis, where sums x + t are small, both sides of rims and
# bends, and the edge. psi times its width is below 1e-13 on the last.
AXIS_LEVELS: Final = 6
BEND_LEVELS: Final = 11
EDGE_LEVELS: Final = 9
# Nodes and power of the rule s = v^power from a logarithm's singularity, and from a panel's end close to one. There
# polynomials are of six times their degree in v: 20 nodes left 1e-11 of an edge value at a/h = 4, 28 leave 2e-13 (power
# law with the exponent 1 and an incompressible layer, against 48 nodes, 2026-11-23).
SINGULAR_NODES: Final = 28
SINGULAR_POWER: Final = 6
CLOSE_NODES: Final = 28
CLOSE_POWER: Final = 4


@dataclass(frozen=True, eq=False)
class RelativePanels:
    """Panels on [0, 1].

    Attributes:
        ends: Shape (P + 1,).
        count: Nodes of each panel, m.
        first_bend: Where the load first has a rim or bend, one without.
    """

    ends: FloatArray
    count: int
    first_bend: float = 1.0

    @cached_property
    def widths(self) -> FloatArray:
        """Shape (P,)."""
        return np.diff(self.ends)

    @cached_property
    def nodes(self) -> FloatArray:
        """Shape (n,)."""
        return (self.ends[:-1, None] + self.widths[:, None] * gauss_nodes(self.count)[0]).ravel()

    @cached_property
    def weights(self) -> FloatArray:
        """Shape (n,)."""
        return (self.widths[:, None] * gauss_nodes(self.count)[1]).ravel()

    @cached_property
    def targets(self) -> FloatArray:
        """Nodes and the edge, shape (n + 1,)."""
        return np.append(self.nodes, 1.0)

    @cached_property
    def far_weights(self) -> FloatArray:
        """Weights of the nodes for every target, zero on the target's own panel and those beside it."""
        panels = len(self.widths)
        own = np.append(np.repeat(np.arange(panels), self.count), panels - 1)
        apart = np.abs(own[:, None] - np.repeat(np.arange(panels), self.count)) > 1
        return np.asarray(np.where(apart, self.weights, 0.0))

    @cached_property
    def near(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Rules on the target's own panel and those beside it.

        Returns:
            Distances from the target, shape (n + 1, q); weights times Lagrange polynomials, shape (n + 1, q, 3 m); and
            the first node of the three panels in a row padded by one panel at both ends, shape (n + 1,).
        """
        rules = [self._rule(target) for target in range(len(self.targets))]
        distance, weights, first = (np.array(part) for part in zip(*rules, strict=True))
        return distance, weights, first

    def matrix(self, difference: FloatArray, near: FloatArray) -> FloatArray:
        """Integrals of a kernel times the Lagrange polynomials, shape (n + 1, n).

        Args:
            difference: The kernel between targets and nodes, shape (n + 1, n); what is near is not used.
            near: The kernel at the distances of `near`, shape (n + 1, q).
        """
        n, m = len(self.nodes), self.count
        padded = np.zeros((n + 1, n + 2 * m))
        padded[:, m:-m] = difference * self.far_weights
        _, weights, first = self.near
        local = np.einsum("iq,iqk->ik", near, weights)
        rows = np.arange(n + 1)[:, None]
        padded[rows, first[:, None] + np.arange(3 * m)] += local
        return padded[:, m:-m]

    def _rule(self, target: int) -> tuple[FloatArray, FloatArray, int]:
        m, panels = self.count, len(self.widths)
        own = min(target // m, panels - 1)
        position = gauss_nodes(m)[0][target % m] if target < len(self.nodes) else 1.0
        v, omega = gauss_nodes(SINGULAR_NODES)
        s, ds = v**SINGULAR_POWER, SINGULAR_POWER * v ** (SINGULAR_POWER - 1) * omega
        w = self.widths[own]
        left, right = position, 1 - position
        parts = [
            (w * left * s, w * left * ds, 1, position - left * s),
            (w * right * s, w * right * ds, 1, position + right * s),
        ]
        v, omega = gauss_nodes(CLOSE_NODES)
        u, du = v**CLOSE_POWER, CLOSE_POWER * v ** (CLOSE_POWER - 1) * omega
        for place, gap, inside in ((0, left * w, 1 - u), (2, right * w, u)):
            beside = own + place - 1
            width = self.widths[beside] if 0 <= beside < panels else 0.0
            parts.append((gap + width * u, width * du, place, inside))
        distance = np.concatenate([part[0] for part in parts])
        weights = np.zeros((distance.size, 3, m))
        start = 0
        for _, weight, place, inside in parts:
            stop = start + weight.size
            weights[start:stop, place] = weight[:, None] * lagrange_matrix(m, np.clip(inside, 0.0, 1.0))
            start = stop
        return distance, weights.reshape(distance.size, 3 * m), own * m


@lru_cache(maxsize=32)
def relative_panels(count: int, splits: int) -> RelativePanels:
    """The panels with `count` nodes each, the wide ones in the middle cut into `splits` parts."""
    half = 0.5 * RATIO ** np.arange(LEVELS, -1, -1.0)
    left = np.append(0.0, half)
    cut = np.concatenate(
        [np.linspace(a, b, splits + 1)[:-1] if b - a > 0.1 else [a] for a, b in zip(left, half, strict=False)]
    )
    return RelativePanels(np.concatenate([cut, [0.5], 1 - cut[::-1]]), count)


@lru_cache(maxsize=8)
def panels_with_bends(marks: tuple[float, ...], widest: float, count: int) -> RelativePanels:
    """Panels that shrink towards axis, rims, bends and edge as well; marks are where rims and bends are on [0, 1]."""
    points = [0.0, *sorted({mark for mark in marks if 0 < mark < 1}), 1.0]
    parts: list[FloatArray] = []
    for start, stop in pairwise(points):
        half = (stop - start) / 2
        before = AXIS_LEVELS if start == 0 else BEND_LEVELS
        after = EDGE_LEVELS if stop == 1 else BEND_LEVELS
        parts += [np.array([start]), start + half * RATIO ** np.arange(before, -1, -1.0)]
        parts += [stop - half * RATIO ** np.arange(1.0, after + 1)]
    coarse = np.append(np.concatenate(parts), 1.0)
    cuts = np.maximum(np.ceil(np.diff(coarse) / widest), 1).astype(int)
    fine = [np.linspace(a, b, n + 1)[1:] for a, b, n in zip(coarse[:-1], coarse[1:], cuts, strict=True)]
    return RelativePanels(np.concatenate([coarse[:1], *fine]), count, points[1])

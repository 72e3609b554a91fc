"""Panels for a function that is smooth but for some points: graded geometrically towards each of them from above."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from bem.polynomials.equal_panels import chebyshev_sum
from bem.polynomials.gauss_panels import chebyshev_from_nodes, gauss_nodes
from contact.records.validation import FloatArray

# Ratio of neighbouring panels that approach a singular point.
RATIO = 0.25
# Panels towards a root: the last is 1e-12 of the first, and what its nodes miss of the root's integral is 1e-18.
LEVELS = 20
# Panels towards a power 3/2: the last is 2e-5 of the first, and its nodes miss 1e-12 of the first panel's 1e-6.
SMOOTHER_LEVELS = 8
# Panels towards the tip, where a profile may rise like any power of r above one.
TIP_LEVELS = 6


@dataclass(frozen=True)
class GradedPanels:
    """Gauss panels on [0, a]; positions are offsets from the rim b of the flat end, near which they keep their digits.

    Attributes:
        origin: b.
        ends: Panel ends, from -b to a - b, shape (q + 1,).
        count: Nodes of each panel, m.
    """

    origin: float
    ends: FloatArray
    count: int

    @classmethod
    def between(
        cls, origin: float, smoother: FloatArray, end: tuple[float, float], widest: float, count: int
    ) -> GradedPanels:
        """Panels up to the offset `end`, none wider than `widest`, graded above the tip, the origin and `smoother`.

        Args:
            origin: b, beyond which the function begins like a root, or zero for a tip.
            smoother: Offsets where it begins like the power 3/2.
            end: Where the panels end, and the distance from there to a pole towards which they shrink.
            widest: Largest panel.
            count: Nodes of each panel.
        """
        points = np.unique(np.concatenate([[-origin, 0.0], smoother[smoother < end[0]], end[:1]]))
        ends = [points[:1], _towards_pole(*end)]
        for start, stop in pairwise(points):
            levels = TIP_LEVELS if start == -origin else LEVELS if start == 0 else SMOOTHER_LEVELS
            ends.append(start + (stop - start) * RATIO ** np.arange(levels, -1, -1.0))
        # Beside a distant point the smallest panels round to nothing.
        coarse = np.unique(np.concatenate(ends))
        pieces = np.maximum(np.ceil(np.diff(coarse) / widest), 1).astype(int)
        fine = [np.linspace(a, b, n + 1)[1:] for a, b, n in zip(coarse[:-1], coarse[1:], pieces, strict=True)]
        return cls(origin, np.concatenate([coarse[:1], *fine]), count)

    @property
    def offsets(self) -> FloatArray:
        """Offsets of the nodes, shape (q m,)."""
        return (self.ends[:-1, None] + np.diff(self.ends)[:, None] * gauss_nodes(self.count)[0]).ravel()

    @property
    def nodes(self) -> FloatArray:
        """Positions t of the nodes, shape (q m,)."""
        return self.origin + self.offsets

    @property
    def weights(self) -> FloatArray:
        """Shape (q m,)."""
        return (np.diff(self.ends)[:, None] * gauss_nodes(self.count)[1]).ravel()

    def interpolant(self, values: FloatArray, t: FloatArray) -> FloatArray:
        """The panels' polynomials through values at the nodes, shape (q m,), at positions t."""
        coefficients = values.reshape(-1, self.count) @ chebyshev_from_nodes(self.count).T
        offset = t - self.origin
        panel = np.clip(np.searchsorted(self.ends, offset, side="left") - 1, 0, len(self.ends) - 2)
        s = (offset - self.ends[panel]) / (self.ends[panel + 1] - self.ends[panel])
        return chebyshev_sum(coefficients[panel], 2 * s - 1)


def _towards_pole(end: float, room: float) -> FloatArray:
    """Ends of panels that double with their distance from a pole at end + room, down to the middle of [0, end]."""
    doublings = max(np.ceil(np.log2((end + room) / (2 * room))), 0.0) if 0 < room < end else 0.0
    return np.asarray(end - room * (2.0 ** np.arange(1.0, doublings) - 1))

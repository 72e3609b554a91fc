"""Panels for a function that is smooth but for some points: graded geometrically towards each of them from above."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from bem.polynomials.equal_panels import chebyshev_sum
from bem.polynomials.gauss_panels import chebyshev_from_nodes, gauss_nodes
from contact.records.validation import FloatArray

RATIO = 0.25  # of neighbouring panels that approach a singular point
LEVELS = 20  # the last panel is 1e-12 of the first: a square root's slope leaves 1e-6 of itself there
SMOOTHER_LEVELS = 8  # 2e-5: what Gauss nodes miss of the power 3/2 there is 1e-12 of the first panel's 1e-6
NARROWEST = 1e-13  # of the distance from the centre
TIP_LEVELS = 6  # towards r = 0, where smaller panels would lift rounding errors of phi'/t into the pressure


@dataclass(frozen=True)
class GradedPanels:
    """Gauss panels on [0, a].

    Attributes:
        ends: Panel ends, shape (q + 1,).
        count: Nodes of each panel, m.
    """

    ends: FloatArray
    count: int

    @classmethod
    def between(cls, singular: FloatArray, smoother: FloatArray, end: float, widest: float, count: int) -> GradedPanels:
        """Panels on [0, end], none wider than `widest`, graded above each singular point of [0, end).

        Args:
            singular: Where the function begins like a root.
            smoother: Where it begins like the power 3/2; those that are `singular` as well do not count.
            end: Where the panels end.
            widest: Largest panel.
            count: Nodes of each panel.
        """
        points = np.unique(np.concatenate([singular, smoother, [0.0, end]]))
        points = points[(points >= 0) & (points <= end)]
        ends = [points[:1]]
        for start, stop in pairwise(points):
            levels = TIP_LEVELS if start == 0 else LEVELS if start in singular else SMOOTHER_LEVELS
            steps = start + (stop - start) * RATIO ** np.arange(levels, -1, -1.0)
            ends.append(steps)
        coarse = np.unique(np.concatenate(ends))  # beside a distant point the smallest panels round to nothing
        coarse = coarse[np.append(np.diff(coarse) > NARROWEST * coarse[1:], True)]
        pieces = np.maximum(np.ceil(np.diff(coarse) / widest), 1).astype(int)
        fine = [np.linspace(a, b, n + 1)[1:] for a, b, n in zip(coarse[:-1], coarse[1:], pieces, strict=True)]
        return cls(np.concatenate([[0.0], *fine]), count)

    @property
    def nodes(self) -> FloatArray:
        """Shape (q m,)."""
        return (self.ends[:-1, None] + np.diff(self.ends)[:, None] * gauss_nodes(self.count)[0]).ravel()

    @property
    def weights(self) -> FloatArray:
        """Shape (q m,)."""
        return (np.diff(self.ends)[:, None] * gauss_nodes(self.count)[1]).ravel()

    def interpolant(self, values: FloatArray, t: FloatArray) -> FloatArray:
        """The panels' polynomials through values at the nodes, shape (q m,), at points t."""
        return self._sum(values.reshape(-1, self.count) @ chebyshev_from_nodes(self.count).T, t)

    def derivative(self, values: FloatArray, t: FloatArray) -> FloatArray:
        """Derivative of these polynomials at points t."""
        coefficients = values.reshape(-1, self.count) @ chebyshev_from_nodes(self.count).T
        slopes = np.zeros_like(coefficients)
        slopes[:, :-1] = 2 * np.polynomial.chebyshev.chebder(coefficients, axis=1) / np.diff(self.ends)[:, None]
        return self._sum(slopes, t)

    def _sum(self, coefficients: FloatArray, t: FloatArray) -> FloatArray:
        panel = np.clip(np.searchsorted(self.ends, t, side="left") - 1, 0, len(self.ends) - 2)
        s = (t - self.ends[panel]) / (self.ends[panel + 1] - self.ends[panel])
        return chebyshev_sum(coefficients[panel], 2 * s - 1)

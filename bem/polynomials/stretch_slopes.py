"""Slope g_hs' of a profile without a closed form, from values of g_hs between its breakpoints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bem.polynomials.equal_panels import piecewise_sum
from bem.polynomials.gauss_panels import chebyshev_from_nodes, gauss_nodes
from contact.records.validation import FloatArray


@dataclass(frozen=True)
class StretchSlopes:
    """Derivative of t h(t), where h begins like a root, or the power 3/2, at each breakpoint beyond the tip.

    On a stretch of length L h is a polynomial in v, t = start + L v^2, in which such a beginning is analytic; on that
    of a tip in v = t/L. Positions are offsets from an origin.

    Attributes:
        origin: Radius that offsets count from.
        ends: Offsets of the ends of the stretches, increasing from zero, shape (q + 1,).
        values: Chebyshev coefficients of h, shape (q, m).
        slopes: Those of dh/dv.
    """

    origin: float
    ends: FloatArray
    values: FloatArray
    slopes: FloatArray

    @classmethod
    def of(
        cls, function: Callable[[FloatArray], FloatArray], origin: float, ends: FloatArray, count: int
    ) -> StretchSlopes:
        """Sample the function t h(t) of the offset at `count` nodes of each stretch."""
        power = np.where(origin + ends[:-1] > 0, 2, 1)[:, None]
        offset = (ends[:-1, None] + np.diff(ends)[:, None] * gauss_nodes(count)[0] ** power).ravel()
        h = function(offset) / (origin + offset)
        values = h.reshape(-1, count) @ chebyshev_from_nodes(count).T
        slopes = np.zeros_like(values)
        slopes[:, :-1] = 2 * np.polynomial.chebyshev.chebder(values, axis=1)
        return cls(origin, ends, values, slopes)

    def __call__(self, offset: FloatArray) -> FloatArray:
        """(t h)' at points inside the stretches, any shape."""
        stretch = np.clip(np.searchsorted(self.ends, offset, side="left") - 1, 0, len(self.ends) - 2)
        length, rooted = np.diff(self.ends)[stretch], self.origin + self.ends[stretch] > 0
        share = np.clip((offset - self.ends[stretch]) / length, np.finfo(float).tiny, 1.0)
        v = np.where(rooted, np.sqrt(share), share)
        slope = piecewise_sum(self.slopes, stretch, 2 * v - 1) / (length * np.where(rooted, 2 * v, 1.0))
        return np.asarray(piecewise_sum(self.values, stretch, 2 * v - 1) + (self.origin + offset) * slope)

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
    """Derivative of t h(t), where h begins like the power 3/2 at each breakpoint beyond the tip.

    On a stretch of length L h is a polynomial in v, t = start + L v^2, in which such a beginning is analytic; on the
    first, that of the tip, in v = t/L.

    Attributes:
        ends: Ends of the stretches, increasing from zero, shape (q + 1,).
        values: Chebyshev coefficients of h, shape (q, m).
        slopes: Those of dh/dv.
    """

    ends: FloatArray
    values: FloatArray
    slopes: FloatArray

    @classmethod
    def of(cls, function: Callable[[FloatArray], FloatArray], ends: FloatArray, count: int) -> StretchSlopes:
        """Sample the function t h(t) at `count` nodes of each stretch."""
        power = np.where(ends[:-1] > 0, 2, 1)[:, None]
        t = (ends[:-1, None] + np.diff(ends)[:, None] * gauss_nodes(count)[0] ** power).ravel()
        values = (function(t) / t).reshape(-1, count) @ chebyshev_from_nodes(count).T
        slopes = np.zeros_like(values)
        slopes[:, :-1] = 2 * np.polynomial.chebyshev.chebder(values, axis=1)
        return cls(ends, values, slopes)

    def __call__(self, t: FloatArray) -> FloatArray:
        """(t h)' at points t inside the stretches, any shape."""
        stretch = np.clip(np.searchsorted(self.ends, t, side="left") - 1, 0, len(self.ends) - 2)
        share = np.clip((t - self.ends[stretch]) / np.diff(self.ends)[stretch], np.finfo(float).tiny, 1.0)
        v = np.where(stretch > 0, np.sqrt(share), share)
        stretched = np.diff(self.ends)[stretch] * np.where(stretch > 0, 2 * v, 1.0)
        slope = piecewise_sum(self.slopes, stretch, 2 * v - 1) / stretched
        return np.asarray(piecewise_sum(self.values, stretch, 2 * v - 1) + t * slope)

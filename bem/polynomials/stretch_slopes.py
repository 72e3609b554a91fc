"""Slope g_hs' of a profile without a closed form, from values of g_hs between its breakpoints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bem.polynomials.mapped import MappedFunction, MappedGrid
from contact.records.validation import FloatArray


@dataclass(frozen=True)
class StretchSlopes:
    """Derivative of t h(t), where h begins like a root, or the power 3/2, at each breakpoint beyond the tip.

    On a stretch of length L h is a polynomial in v, t = start + L v^2, in which such a beginning is analytic; on that
    of a tip in v = t/L.

    Attributes:
        origin: Radius that offsets count from.
        quotient: h over the offsets.
    """

    origin: float
    quotient: MappedFunction

    @classmethod
    def of(
        cls, function: Callable[[FloatArray], FloatArray], origin: float, ends: FloatArray, count: int
    ) -> StretchSlopes:
        """Sample the function t h(t) of the offset at `count` nodes of each stretch.

        Args:
            function: Of offsets from the origin.
            origin: Radius that offsets count from.
            ends: Offsets of the ends of the stretches, increasing from zero, shape (q + 1,).
            count: Samples of a stretch.
        """
        power = np.where(origin + ends[:-1] > 0, 2.0, 1.0)
        grid = MappedGrid(ends[:-1], np.diff(ends), power, count)
        return cls(origin, MappedFunction(grid, function(grid.nodes) / (origin + grid.nodes), 0.0))

    def __call__(self, offset: FloatArray) -> FloatArray:
        """(t h)' at points inside the stretches, any shape."""
        piece, v = self.quotient.grid.locate(offset)
        v = np.maximum(v, np.sqrt(np.finfo(float).tiny))
        slope = self.quotient.derivative_at(piece, v)
        return np.asarray(self.quotient.at(piece, v) + (self.origin + offset) * slope)

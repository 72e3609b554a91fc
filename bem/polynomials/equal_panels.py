"""A smooth function on equal panels by Chebyshev polynomials."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.polynomials.gauss_panels import chebyshev_from_nodes
from bem.polynomials.truncation import between_nodes, orders_beyond
from contact.records.validation import FloatArray

# Up to so many points cosines are summed in one step, beyond them by Clenshaw's recurrence (`chebyshev_sum`).
FEW_POINTS = 400
# Points of a block: with 24 coefficients each they fill 1.6 MB.
BLOCK = 8192


@dataclass(frozen=True)
class EqualPanels:
    """Piecewise polynomial on [0, P H].

    Attributes:
        panel_width: H.
        coefficients: Chebyshev coefficients of each panel, shape (P, m).
    """

    panel_width: float
    coefficients: FloatArray

    @classmethod
    def from_nodes(cls, panel_width: float, values: FloatArray) -> EqualPanels:
        """The interpolant of values at the panels' Gauss nodes, shape (P, m)."""
        return cls(panel_width, values @ chebyshev_from_nodes(values.shape[1]).T)

    def __call__(self, x: ArrayLike) -> FloatArray:
        """Values at points of [0, P H], any shape."""
        panels, s = self.locate(np.asarray(x, dtype=float))
        return piecewise_sum(self.coefficients, panels, 2 * s - 1)

    def locate(self, x: FloatArray) -> tuple[np.ndarray[tuple[int, ...], np.dtype[np.intp]], FloatArray]:
        """Number of the panel and relative position in it; a point between two panels belongs to the left one."""
        panels = np.ceil(x / self.panel_width).astype(np.intp) - 1
        panels = np.minimum(np.maximum(panels, 0), len(self.coefficients) - 1)
        return panels, x / self.panel_width - panels

    def truncation(self, x: FloatArray) -> FloatArray:
        """Size of what the polynomials leave out at points x, as the decay of their coefficients tells."""
        panels, s = self.locate(x)
        beyond: FloatArray = self._beyond[panels] * between_nodes(self.coefficients.shape[1], 2 * s - 1)
        return beyond

    @cached_property
    def _beyond(self) -> FloatArray:
        return orders_beyond(self.coefficients)


def chebyshev_sum(coefficients: FloatArray, s: FloatArray) -> FloatArray:
    """Chebyshev sums: coefficients (*shape, m) at s in [-1, 1] of that shape.

    A few points are summed as cosines in one step; for many, Clenshaw's recurrence needs less memory and time.
    """
    if s.size <= FEW_POINTS:
        angles = np.arccos(np.minimum(np.maximum(s, -1.0), 1.0))
        cosines = np.cos(np.multiply.outer(angles, np.arange(coefficients.shape[-1])))
        few: FloatArray = np.sum(coefficients * cosines, axis=-1)
        return few
    older, newer = np.zeros_like(s), np.zeros_like(s)
    for k in range(coefficients.shape[-1] - 1, 0, -1):
        older, newer = newer, 2 * s * newer - older + coefficients[..., k]
    return s * newer - older + coefficients[..., 0]


def piecewise_sum(coefficients: FloatArray, piece: NDArray[np.intp], s: FloatArray) -> FloatArray:
    """Chebyshev sums of the pieces, coefficients (q, m), at s in [-1, 1]; `piece` is of the shape of s.

    Many points are summed in blocks whose coefficients stay in the cache: a million points take a third of the time.
    """
    if s.size <= BLOCK:
        return chebyshev_sum(coefficients[piece], s)
    starts, numbers, flat = range(0, s.size, BLOCK), piece.ravel(), s.ravel()
    blocks = [chebyshev_sum(coefficients[numbers[i : i + BLOCK]], flat[i : i + BLOCK]) for i in starts]
    return np.concatenate(blocks).reshape(s.shape)

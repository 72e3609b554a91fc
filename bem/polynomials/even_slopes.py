"""Slope of a smooth even function on [0, a] that is known on panels, without the roundings of the panels' ends.

Differentiation magnifies roundings of n orders up to n^2 times at the ends of a panel, and n times in its middle. So a
second row of panels, each from the middle of one to the middle of the next, answers where the first row ends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.polynomials.chebyshev import differentiation, piecewise_sum
from bem.polynomials.gauss_panels import chebyshev_from_nodes, gauss_nodes
from bem.polynomials.mapped import MappedFunction
from bem.polynomials.truncation import rate_of_decay
from contact.records.validation import FloatArray

EPS = float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class EvenSlopes:
    """psi'(t)/t by polynomials: on the first panel in t^2, on the others of psi' in t.

    Attributes:
        left: Where the overlapping panels begin, shape (q,).
        width: Their widths, shape (q,).
        ends: Up to where each but the last is asked, shape (q - 1,).
        coefficients: Chebyshev coefficients of psi'/t on the first, of psi' on the others, shape (q, m).
    """

    left: FloatArray
    width: FloatArray
    ends: FloatArray
    coefficients: FloatArray

    @classmethod
    def of(cls, psi: MappedFunction, strip: float) -> EvenSlopes:
        """Of a function on panels from zero on, of which the last may be shorter than the others.

        The last reaches back to the width of the one before. Orders that analyticity leaves below a rounding are
        rounding errors, and are left out; in t^2 they fall twice as fast.

        Args:
            psi: The function.
            strip: Half the width of the strip around the real axis where it is analytic.
        """
        left, right = _overlapping(psi.grid.left, psi.grid.ends[1:])
        width, (nodes, _) = right - left, gauss_nodes(psi.grid.count)
        points = left[:, None] + width[:, None] * nodes
        points[0] = width[0] * np.sqrt(nodes)
        coefficients = psi(points) @ chebyshev_from_nodes(nodes.size).T
        rates = np.append(rate_of_decay(strip / width[0]) ** 2, [rate_of_decay(2 * strip / w) for w in width[1:]])
        coefficients[np.arange(nodes.size) >= np.ceil(np.log(EPS) / np.log(rates))[:, None]] = 0.0
        coefficients[0] *= 2 / width[0]
        slopes = 2 * coefficients @ differentiation(nodes.size).T / width[:, None]
        return cls(left, width, (left[1:] + right[:-1]) / 2, slopes)

    def __call__(self, t: FloatArray) -> FloatArray:
        """psi'(t)/t at points of (0, a], of any shape."""
        panel = self.ends.searchsorted(t)
        share = (t - self.left[panel]) / self.width[panel]
        innermost = panel == 0
        values = piecewise_sum(self.coefficients, panel, 2 * np.where(innermost, share**2, share) - 1)
        return values / np.where(innermost, 1.0, t)


def _overlapping(left: FloatArray, right: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Ends of the panels, and between each two of them one that begins and ends half way from one to the next."""
    left = left.copy()
    if left.size > 1:
        left[-1] = right[-1] - max(right[-1] - left[-1], right[-2] - left[-2])
    both = np.stack([left, right])
    rows = np.empty((2, 2 * left.size - 1))
    rows[:, ::2], rows[:, 1::2] = both, (both[:, 1:] + both[:, :-1]) / 2
    return rows[0], rows[1]

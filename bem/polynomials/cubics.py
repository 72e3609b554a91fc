"""Piecewise cubics through points: with two continuous derivatives, or monotone; SciPy's are slow to import (0.3 s)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from contact.answer.compiled_files import lapack
from contact.records.validation import FloatArray


@dataclass(frozen=True, eq=False)
class PiecewiseCubic:
    """Cubics between knots; beyond them the outermost go on.

    Attributes:
        x: Knots, increasing, shape (n,).
        powers: Coefficients of 1, t, t^2, t^3 with t the distance from the knot on the left, shape (4, n - 1).
    """

    x: FloatArray
    powers: FloatArray

    @classmethod
    def hermite(cls, x: FloatArray, y: FloatArray, slopes: FloatArray) -> Self:
        """From values and slopes at the knots."""
        width = np.diff(x)
        secant = np.diff(y) / width
        bend = (slopes[:-1] + slopes[1:] - 2 * secant) / width
        return cls(x, np.stack([y[:-1], slopes[:-1], (secant - slopes[:-1]) / width - bend, bend / width]))

    @classmethod
    def spline(cls, x: FloatArray, y: FloatArray) -> Self:
        """Two continuous derivatives, and a third one at the second and the last but one knot; at least four knots."""
        width = np.diff(x)
        secant = np.diff(y) / width
        first, last = x[2] - x[0], x[-1] - x[-3]
        middle = np.concatenate([[width[1]], 2 * (width[:-1] + width[1:]), [width[-2]]])
        right = 3 * (width[1:] * secant[:-1] + width[:-1] * secant[1:])
        start = ((width[0] + 2 * first) * width[1] * secant[0] + width[0] ** 2 * secant[1]) / first
        end = (width[-1] ** 2 * secant[-2] + (2 * last + width[-1]) * width[-2] * secant[-1]) / last
        below, above = np.append(width[1:], last), np.append(first, width[:-1])
        *_, slopes, _ = lapack().dgtsv(below, middle, above, np.concatenate([[start], right, [end]]))
        return cls.hermite(x, y, slopes)

    @classmethod
    def monotone(cls, x: FloatArray, y: FloatArray) -> Self:
        """It rises and falls only where the points do (Fritsch and Butland 1984, SIAM J. Sci. Stat. Comput. 5, 300)."""
        width = np.diff(x)
        secant = np.diff(y) / width
        if len(secant) == 1:
            return cls.hermite(x, y, np.repeat(secant, 2))
        turns = secant[:-1] * secant[1:] <= 0
        left, right = 2 * width[1:] + width[:-1], width[1:] + 2 * width[:-1]
        before, after = np.where(turns, 1.0, secant[:-1]), np.where(turns, 1.0, secant[1:])
        inner = np.where(turns, 0.0, (left + right) / (left / before + right / after))
        ends = [_end_slope(*width[:2], *secant[:2]), _end_slope(*width[:-3:-1], *secant[:-3:-1])]
        return cls.hermite(x, y, np.concatenate([ends[:1], inner, ends[1:]]))

    def __call__(self, points: ArrayLike) -> FloatArray:
        """Values at points of any shape."""
        at = np.asarray(points, dtype=np.float64)
        piece = self.x[1:-1].searchsorted(at, side="right")
        t = at - self.x.take(piece)
        value, slope, bend, third = (row.take(piece) for row in self.powers)
        return np.asarray(value + t * (slope + t * (bend + t * third)))


def _end_slope(width: float, next_width: float, secant: float, next_secant: float) -> float:
    """Of the parabola through three points, where that keeps the sense in which they rise, and no steeper than that."""
    slope = ((2 * width + next_width) * secant - width * next_secant) / (width + next_width)
    if slope * secant <= 0:
        return 0.0
    steep = secant * next_secant <= 0 and abs(slope) > 3 * abs(secant)
    return float(3 * secant if steep else slope)

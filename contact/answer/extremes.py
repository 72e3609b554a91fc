"""The largest value of a function on a rectangle: many points first, then ever closer looks at the best."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from contact.records.validation import FloatArray

# The best few of the first points are looked at more closely.
_STARTS = 3
# Places of a closer look along each side, over half its width. The largest lies within half of that of the best one,
# and the width is halved.
_CLOSER = np.linspace(-1.0, 1.0, 5)
# The last look is so wide, over the rectangle: beyond, values near a maximum are equal to a rounding.
_LAST = 1e-9


@dataclass(frozen=True)
class Extreme:
    """Where a field is largest.

    Attributes:
        radius: r [m].
        depth: z [m].
        value: [Pa].
    """

    radius: float
    depth: float
    value: float


class Box(NamedTuple):
    """A rectangle by two corners (r, z)."""

    low: tuple[float, float]
    high: tuple[float, float]


def largest_in(
    box: Box, points: Sequence[FloatArray], value: Callable[[FloatArray, FloatArray], FloatArray]
) -> Extreme:
    """Place and value of the largest value found.

    Args:
        box: Where it is sought.
        points: Radii and depths of the first look, of one shape.
        value: Of radii and depths, shape (n,).
    """
    r, z = (np.ravel(p) for p in points)
    values = value(r, z)
    width = np.subtract(box.high, box.low) / (np.sqrt(r.size) - 1.0)
    best = np.argsort(values)[::-1][:_STARTS]
    starts = [Extreme(float(r[i]), float(z[i]), float(values[i])) for i in best]
    return max((_closer(box, start, width, value) for start in starts), key=lambda one: one.value)


def _closer(
    box: Box, best: Extreme, width: FloatArray, value: Callable[[FloatArray, FloatArray], FloatArray]
) -> Extreme:
    span = np.subtract(box.high, box.low)
    while np.any(width > _LAST * span):
        sides = np.clip(
            np.array([[best.radius], [best.depth]]) + np.multiply.outer(width, _CLOSER),
            np.transpose([box.low]),
            np.transpose([box.high]),
        )
        r, z = (side.ravel() for side in np.meshgrid(*(np.unique(side) for side in sides)))
        values = value(r, z)
        i = int(np.argmax(values))
        if values[i] > best.value:
            best = Extreme(float(r[i]), float(z[i]), float(values[i]))
        width = width / 2.0
    return best

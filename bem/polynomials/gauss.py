"""Nodes and weights of Gauss-Legendre rules to the last digit."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from contact.records.validation import FloatArray

# Newton steps from nodes that are known to about 1e-15: the first leaves 1e-19, the second shows in no digit.
_STEPS = 2


@cache
def legendre_rule(count: int) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights of the Gauss-Legendre rule on [-1, 1], each of shape (count,), read-only.

    NumPy's weights are off by up to 7e-14 of themselves on 20 nodes and 7e-13 on 40, a thousand times rounding. Here
    the nodes are improved by Newton's method in extended precision, and the weights are 2/((1 - x^2) P'^2) there.
    Where a platform has no extended precision, they are as good as double precision makes them.
    """
    x = legendre.leggauss(count)[0].astype(np.longdouble)
    for _ in range(_STEPS):
        value, slope = _legendre_and_slope(count, x)
        x -= value / slope
    _, slope = _legendre_and_slope(count, x)
    return _frozen(x), _frozen(2 / ((1 - x) * (1 + x) * slope**2))


def halved_panels(panels: int, halvings: int) -> tuple[FloatArray, FloatArray]:
    """Starts and widths of panels of width one, the first of them halved towards zero so many times."""
    if not panels:
        return np.empty(0), np.empty(0)
    first = 2.0 ** -np.arange(halvings, -1.0, -1.0)
    ends = np.concatenate([[0.0], first, np.arange(2.0, panels + 1)])
    return ends[:-1], np.diff(ends)


def _legendre_and_slope(
    degree: int, x: NDArray[np.floating[Any]]
) -> tuple[NDArray[np.floating[Any]], NDArray[np.floating[Any]]]:
    """P_n(x) and P_n'(x) for |x| < 1 by the three-term recurrence."""
    before, value = np.ones_like(x), x.copy()
    for n in range(1, degree):
        before, value = value, ((2 * n + 1) * x * value - n * before) / (n + 1)
    return value, degree * (before - x * value) / ((1 - x) * (1 + x))


def _frozen(values: NDArray[np.floating[Any]]) -> FloatArray:
    rounded = values.astype(np.float64)
    rounded.setflags(write=False)
    return rounded

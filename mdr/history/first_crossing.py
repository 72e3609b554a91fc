"""The first instant at which functions of time fall below zero, each of many springs its own."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from bem.polynomials.root_steps import MOST_STEPS
from contact.records.validation import FloatArray


def first_below(
    function: Callable[[NDArray[np.intp], FloatArray], FloatArray], times: FloatArray, rounding: FloatArray
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Where functions first fall below zero by more than rounding.

    Args:
        function: Values of some springs, given by number, at times of shape (instants, 1 or springs).
        times: When all springs are looked at, increasing, shape (instants, 1 or n).
        rounding: How far below zero is no sign, shape (n,).

    Returns:
        The instant for each spring, shape (1, n), the last time for those that stay above zero, and which fall, (n,).
    """
    count = rounding.size
    at = np.broadcast_to(times[-1:], (1, count)).copy()
    below = function(np.arange(count), times) < -rounding
    falls = np.any(below, axis=0)
    some = np.flatnonzero(falls)
    if some.size:
        first = below[:, some].argmax(axis=0)
        own = np.broadcast_to(times, (times.shape[0], count))
        ends = own[np.maximum(first - 1, 0), some], own[first, some]
        at[0, some] = _fallen(lambda time: function(some, time[None])[0], *ends, 0.125 * rounding[some])
    return at, falls


def _fallen(
    function: Callable[[FloatArray], FloatArray], low: FloatArray, high: FloatArray, rounding: FloatArray
) -> FloatArray:
    """Where functions have just reached zero between times, by the Illinois rule; at once where they start there."""
    above, below, side = np.maximum(function(low), 0.0), function(high), np.zeros(low.size)
    for _ in range(MOST_STEPS):
        share = np.divide(above, above - below, out=np.zeros(low.size), where=above > 0.0)
        at = low + (high - low) * share
        value = function(at)
        stays = value > 0.0
        below = np.where(stays, np.where(side > 0.0, 0.5 * below, below), value)
        above = np.where(stays, value, np.where(side < 0.0, 0.5 * above, above))
        low, high, side = np.where(stays, at, low), np.where(stays, high, at), np.where(stays, 1.0, -1.0)
        if np.all((np.abs(value) <= rounding) | (above == 0.0)):
            break
    return np.asarray(np.where(value > rounding, high, at))

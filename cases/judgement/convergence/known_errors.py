"""Where the errors themselves are known, against a closed form or a far more exact answer: order, or digits gained."""

import math
from collections.abc import Sequence

import numpy as np

from cases.results.records.convergence import ConvergenceClass
from contact import InvalidInput


def behaviour_of_errors(errors: Sequence[float], *, floor: float) -> ConvergenceClass:
    """Return the class of absolute errors, finest first.

    Args:
        errors: of three grids or more; fewer have no class.
        floor: round-off floor, absolute; an error within ten times it says nothing about the order.
    """
    if len(errors) < 3:
        return ConvergenceClass.TOO_FEW
    if min(errors) <= 10 * floor:
        return ConvergenceClass.FLOOR
    return ConvergenceClass.DIVERGENT if errors[0] >= errors[-1] else ConvergenceClass.MONOTONE


def order_of_errors(errors: Sequence[float], lengths: Sequence[float]) -> float:
    """Return the slope of the least-squares line of log error over log length through all grids."""
    return float(np.polyfit(np.log(lengths), np.log(errors), 1)[0])


def errors_follow_order(errors: Sequence[float], lengths: Sequence[float], formal: float) -> bool:
    """Whether the finest three grids are asymptotic: their orders are stable, or the finest two show the formal one.

    Stable means |p(1,2) - p(2,3)| <= 0.1 p_f; the formal order is shown where Q = e2/(r^p_f e1) is within 0.15 of one.
    """
    finer, coarser = (float(np.log(errors[i + 1] / errors[i]) / np.log(lengths[i + 1] / lengths[i])) for i in (0, 1))
    quotient = errors[1] / errors[0] * (lengths[0] / lengths[1]) ** formal
    return abs(finer - coarser) <= 0.1 * formal or abs(quotient - 1) <= 0.15


def digits_per_refinement(errors: Sequence[float], *, floor: float) -> float:
    """Return the mean number of digits gained per refinement until the floor, where errors fall by a factor each time.

    Args:
        errors: relative errors against the reference, finest first.
        floor: below ten times this, round-off and the reference decide; finer grids say nothing more.

    Raises:
        InvalidInput: if an error is not finite or negative, or if fewer than two grids lie above the floor.
    """
    if not all(math.isfinite(error) and error >= 0 for error in errors):
        raise InvalidInput(f"errors must be finite and not negative, got {tuple(errors)}")
    above = [i for i, error in enumerate(errors) if error > 10 * floor]
    if not above or above[-1] != len(errors) - 1:
        raise InvalidInput(f"the coarsest error of {tuple(errors)} is at the floor {floor:.1e}; start coarser")
    # The first grid at the floor ends the sequence.
    first = max(above[0] - 1, 0)
    if first == len(errors) - 1:
        raise InvalidInput(f"only one error of {tuple(errors)} is above the floor {floor:.1e}; start coarser")
    gained = math.log10(errors[-1]) - math.log10(max(errors[first], floor))
    return gained / (len(errors) - 1 - first)

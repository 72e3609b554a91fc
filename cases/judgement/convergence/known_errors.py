"""Order of convergence where the errors themselves are known: against a closed form, or a far more exact answer."""

from collections.abc import Sequence

import numpy as np

from cases.results.records.convergence import ConvergenceClass


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

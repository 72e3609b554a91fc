"""Are the grids in the asymptotic range?

The textbook ratio GCI32 / (r^p GCI21), with p fitted on the same three grids, equals |f1/f2| by identity and can only
pass.  The two tests here use information the fit has not seen: a fourth grid, or the formal order.
"""

from collections.abc import Sequence

from cases.judgement.convergence.observed_order import observed_order


def orders_are_stable(values: Sequence[float], lengths: Sequence[float], formal: float) -> bool:
    """Whether |p(1,2,3) - p(2,3,4)| <= 0.1 p_f; four grids, finest first."""
    finer = observed_order(values[:3], lengths[:3])
    coarser = observed_order(values[1:4], lengths[1:4])
    return abs(finer - coarser) <= 0.1 * formal


def differences_follow_order(values: Sequence[float], refinement: float, formal: float) -> bool:
    """Whether Q = (f3 - f2) / (r^p_f (f2 - f1)) is within 0.15 of one; three grids of one refinement ratio."""
    quotient = float(values[2] - values[1]) / (refinement**formal * (values[1] - values[0]))
    return bool(abs(quotient - 1) <= 0.15)


def is_asymptotic(values: Sequence[float], lengths: Sequence[float], formal: float) -> bool:
    """Whether either test passes; the second needs a constant refinement ratio, the first a fourth grid."""
    r21, r32 = lengths[1] / lengths[0], lengths[2] / lengths[1]
    if abs(r32 / r21 - 1) < 1e-6 and differences_follow_order(values, r21, formal):
        return True
    return len(values) > 3 and orders_are_stable(values, lengths, formal)

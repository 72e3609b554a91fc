"""Observed order of convergence of three grids (Celik et al. 2008, J. Fluids Eng. 130, 078001)."""

import math
from collections.abc import Sequence

from scipy.optimize import brentq

from contact import InvalidInput


def observed_order(values: Sequence[float], lengths: Sequence[float]) -> float:
    """Return p of f = f_0 + C length^p from three grids, finest first, with any two refinement ratios.

    p solves p ln r21 = ln|eps32/eps21| + q(p), q(p) = ln[(r21^p - s)/(r32^p - s)], s = sign(eps32/eps21).  The source
    takes the modulus of the right-hand side; without it the solution is unique, found by bracketing for every pair of
    ratios, and negative when the differences grow under refinement: such a sequence is never given a positive order.

    Raises:
        InvalidInput: unless there are three finite values at increasing lengths with two non-zero differences.
    """
    r21, r32 = _log_ratios(lengths)
    ratio = _difference_ratio(values)
    size = math.log(abs(ratio))

    def excess(order: float) -> float:
        return order * r21 - size - _q(order, r21, r32, oscillatory=ratio < 0)

    bound = (abs(size) + abs(math.log(r32 / r21)) + 1.0) / min(r21, r32)
    return float(brentq(excess, -bound, bound, xtol=1e-14))


def order_is_accepted(observed: float | None, formal: float) -> bool:
    """Whether an observed order is finite and within [formal - 0.2, formal + 0.5]: NaN and 75.9 both fail."""
    return observed is not None and math.isfinite(observed) and formal - 0.2 <= observed <= formal + 0.5


def _q(order: float, r21: float, r32: float, *, oscillatory: bool) -> float:
    """q(p) with logarithms of the ratios, in a form that neither overflows nor cancels at p = 0."""
    if oscillatory:
        return _log_one_plus_exp(order * r21) - _log_one_plus_exp(order * r32)
    return _log_mean_exp(order * r21) - _log_mean_exp(order * r32) + math.log(r21 / r32)


def _log_one_plus_exp(x: float) -> float:
    """ln(1 + e^x)."""
    return max(x, 0.0) + math.log1p(math.exp(-abs(x)))


def _log_mean_exp(x: float) -> float:
    """ln[(e^x - 1)/x], zero at x = 0."""
    return max(x, 0.0) + math.log(-math.expm1(-abs(x)) / abs(x)) if x else 0.0


def _log_ratios(lengths: Sequence[float]) -> tuple[float, float]:
    if len(lengths) != 3 or not 0 < lengths[0] < lengths[1] < lengths[2] < math.inf:
        raise InvalidInput(f"lengths must be three positive numbers, finest first, got {tuple(lengths)}")
    return math.log(lengths[1] / lengths[0]), math.log(lengths[2] / lengths[1])


def _difference_ratio(values: Sequence[float]) -> float:
    if len(values) != 3 or not all(math.isfinite(value) for value in values):
        raise InvalidInput(f"values must be three finite numbers, finest first, got {tuple(values)}")
    eps21, eps32 = values[1] - values[0], values[2] - values[1]
    if eps21 == 0 or eps32 == 0:
        raise InvalidInput(f"two of the values {tuple(values)} are equal: the order is undefined; classify them first")
    return eps32 / eps21

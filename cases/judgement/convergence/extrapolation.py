"""Richardson extrapolation and the grid convergence index (GCI) with its safety factor."""

import math


def extrapolated(fine: float, coarse: float, refinement: float, order: float) -> float:
    """Return f_ext = (r^p f1 - f2)/(r^p - 1), written so that nearly equal values lose no digits."""
    return fine + (fine - coarse) / math.expm1(order * math.log(refinement))


def grid_convergence_index(
    fine: float, coarse: float, refinement: float, order: float, *, safety: float, scale: float
) -> float:
    """Return the relative GCI = Fs |f1 - f2| / (S (r^p - 1)).

    S = max(|f1|, scale): the declared scale of the quantity, so that a zero crossing (pull-off) does not blow up.
    """
    size = max(abs(fine), scale)
    return safety * abs(fine - coarse) / (size * math.expm1(order * math.log(refinement)))


def safety_factor(observed: float, formal: float) -> tuple[float, float]:
    """Return Fs and the order to use: (1.25, formal) when they agree within 10 %, else (3, a cautious order)."""
    if abs(observed - formal) <= 0.1 * formal:
        return 1.25, formal
    return 3.0, min(max(0.5, observed), formal)

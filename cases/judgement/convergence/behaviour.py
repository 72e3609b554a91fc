"""Which class of behaviour a sequence of refinements shows."""

import math
from collections.abc import Sequence

from cases.results.records.convergence import ConvergenceClass
from contact import InvalidInput


def behaviour(values: Sequence[float], *, floor: float) -> ConvergenceClass:
    """Return the class of three or more values, finest first, decided by the three finest.

    Args:
        values: finest first.
        floor: round-off floor of the values, absolute; differences within ten times it say nothing about the order.

    Raises:
        InvalidInput: if a value is not finite: such a sequence is INVALID, not divergent.
    """
    if not all(math.isfinite(value) for value in values):
        raise InvalidInput(f"a sequence of refinements must be finite, got {tuple(values)}")
    if len(values) < 3:
        return ConvergenceClass.TOO_FEW
    eps21, eps32 = values[1] - values[0], values[2] - values[1]
    if abs(eps21) <= 10 * floor:
        return ConvergenceClass.FLOOR
    if abs(eps21) >= abs(eps32):
        return ConvergenceClass.DIVERGENT
    return ConvergenceClass.MONOTONE if eps21 * eps32 > 0 else ConvergenceClass.OSCILLATORY

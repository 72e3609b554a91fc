"""Spectral convergence: the error falls by a factor at every refinement, so digits count, not orders."""

import math
from collections.abc import Sequence

from contact import InvalidInput


def digits_per_refinement(errors: Sequence[float], *, floor: float) -> float:
    """Return the mean number of digits gained per refinement until the floor is reached.

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

"""The rule by which a number is equal to an accepted one, and the spread that sets its width."""

import math
from collections.abc import Sequence

import numpy as np

from contact import InvalidInput

# No accepted number is held to less than this, relative: 4500 times the unit roundoff 2.2e-16,
# so that another order of a sum of some thousand terms does not count as a change.
SMALLEST_RELATIVE = 1e-12


def relative_tolerance(spread: float) -> float:
    """Return max(10 x measured relative spread, 1e-12).

    Raises:
        InvalidInput: if the spread is negative or not finite: a tolerance must not get the wrong sign.
    """
    if not (math.isfinite(spread) and spread >= 0):
        raise InvalidInput(f"a measured spread must be finite and not negative, got {spread}; measure it again")
    return max(10 * spread, SMALLEST_RELATIVE)


def permitted_difference(baseline: float, *, scale: float, rtol: float, atol: float = 0.0) -> float:
    """Return max(rtol max(|b|, scale), atol), the largest |x - b| that counts as equal."""
    return max(positive_tolerance(rtol) * max(abs(baseline), scale), atol)


def positive_tolerance(tolerance: float) -> float:
    """Return the tolerance itself.

    Raises:
        InvalidInput: unless it is positive and finite; a wrong sign or an infinite one would decide every check.
    """
    if not (math.isfinite(tolerance) and tolerance > 0):
        raise InvalidInput(f"a tolerance must be positive and finite, got {tolerance}")
    return tolerance


def relative_spread(samples: Sequence[float], scale: float) -> float:
    """Return half the range of repeated values over max(largest magnitude, scale)."""
    values = np.asarray(samples, dtype=np.float64)
    size = max(float(np.max(np.abs(values))), scale)
    return float(np.ptp(values)) / 2 / size if size > 0 else 0.0

"""Error against seconds: all ranking uses the bound U = e + u_ref, and nothing is interpolated."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from contact import InvalidInput

TOLERANCES = tuple(10.0**-k for k in range(1, 11))


@dataclass(frozen=True, kw_only=True)
class TimedRun:
    """A setting that gave an answer.

    Attributes:
        label: names method and setting.
        bound: U = e + u_ref, relative.
        seconds: median time.
    """

    label: str
    bound: float
    seconds: float


def error_bound(error: float, reference_uncertainty: float) -> float:
    """Return U = e + u_ref.

    Raises:
        InvalidInput: unless both are finite and not negative.
    """
    if not (math.isfinite(error) and math.isfinite(reference_uncertainty) and min(error, reference_uncertainty) >= 0):
        raise InvalidInput(f"error {error} and reference uncertainty {reference_uncertainty} must be finite, not < 0")
    return error + reference_uncertainty


def reference_is_fine_enough(reference_uncertainty: float, smallest_tolerance: float) -> bool:
    """Whether u_ref <= tau_min / 10: a reference only twice as fine turns order 2.00 into 2.32."""
    return reference_uncertainty <= smallest_tolerance / 10


def pareto_front(runs: Sequence[TimedRun], null_spread: float) -> tuple[bool, ...]:
    """Return for each run whether it is on the front.

    Run k is dropped iff some j has U_j <= U_k and T_j < T_k (1 - d), d the null spread of repeated times.
    """
    return tuple(
        not any(j.bound <= k.bound and j.seconds < k.seconds * (1 - null_spread) for j in runs if j is not k)
        for k in runs
    )


def cheapest(runs: Sequence[TimedRun], tolerance: float) -> TimedRun | None:
    """Return the run behind T*(tau), the smallest time with U <= tau; None when the tolerance was not reached."""
    return min((run for run in runs if run.bound <= tolerance), key=lambda run: run.seconds, default=None)


def crossover(fast: Sequence[TimedRun], other: Sequence[TimedRun], tolerances: Sequence[float]) -> float | None:
    """Return the smallest tolerance where the fast method still wins; None where it never does."""
    return min((tau for tau in tolerances if _wins(cheapest(fast, tau), cheapest(other, tau))), default=None)


def _wins(fast: TimedRun | None, other: TimedRun | None) -> bool:
    return fast is not None and (other is None or fast.seconds < other.seconds)


def price_of_a_digit(cheap: TimedRun, accurate: TimedRun) -> float:
    """Return d log10(T) / d DoA between neighbours on the front: decades of time per digit of accuracy.

    Raises:
        InvalidInput: unless the second run is the more accurate one.
    """
    gained = degree_of_accuracy(accurate.bound) - degree_of_accuracy(cheap.bound)
    if not gained > 0:
        raise InvalidInput(f"{accurate.label} is not more accurate than {cheap.label}")
    return (math.log10(accurate.seconds) - math.log10(cheap.seconds)) / gained


def degree_of_accuracy(error: float) -> float:
    """DoA = -log10 e."""
    return -math.log10(error)


def degree_of_size(unknowns: int) -> float:
    """DoS = log10 N."""
    return math.log10(unknowns)


def degree_of_efficacy(error: float, seconds: float) -> float:
    """DoE = -log10(e T)."""
    return -math.log10(error * seconds)


def true_static_scaling(unknowns: int, seconds: float, error: float) -> float:
    """(N/T)(DoA/DoS) [1/s]: shown, never gated."""
    return unknowns / seconds * degree_of_accuracy(error) / degree_of_size(unknowns)

"""Error against seconds: all ranking uses the bound U = e + u_ref, and nothing is interpolated."""

import math
from collections.abc import Iterable, Sequence
from typing import Protocol, TypeVar

from contact import InvalidInput

TOLERANCES = tuple(10.0**-k for k in range(1, 11))


class Ranked(Protocol):
    """What has a bound U of its relative error and a time: a measurement, or a setting with its median time."""

    @property
    def method(self) -> str:
        """Who answered."""

    @property
    def bound(self) -> float | None:
        """U, None where there is no answer."""

    @property
    def seconds(self) -> float:
        """Time [s]."""


R = TypeVar("R", bound=Ranked)


def error_bound(error: float, reference_uncertainty: float) -> float:
    """Return U = e + u_ref.

    Raises:
        InvalidInput: unless both are finite and not negative.
    """
    if not (math.isfinite(error) and math.isfinite(reference_uncertainty) and min(error, reference_uncertainty) >= 0):
        raise InvalidInput(f"error {error} and reference uncertainty {reference_uncertainty} must be finite, not < 0")
    return error + reference_uncertainty


def bound_of(run: Ranked) -> float:
    """The bound of a run, infinite without an answer."""
    return math.inf if run.bound is None else run.bound


def pareto_front(runs: Sequence[R], null_spread: float) -> list[R]:
    """Return the runs on the front, in their order.

    Run k is dropped iff some j has U_j <= U_k and T_j < T_k (1 - d), d the null spread of repeated times.
    """
    solved = [run for run in runs if run.bound is not None]
    return [
        k
        for k in solved
        if not any(bound_of(j) <= bound_of(k) and j.seconds < k.seconds * (1 - null_spread) for j in solved)
    ]


def cheapest(runs: Iterable[R], tolerance: float) -> R | None:
    """Return the run behind T*(tau), the smallest time with U <= tau; None when the tolerance was not reached."""
    return min((run for run in runs if bound_of(run) <= tolerance), key=lambda run: run.seconds, default=None)


def crossover(fast: Sequence[Ranked], other: Sequence[Ranked], tolerances: Sequence[float]) -> float | None:
    """Return the smallest tolerance where the fast method still wins; None where it never does."""
    return min((tau for tau in tolerances if _wins(cheapest(fast, tau), cheapest(other, tau))), default=None)


def _wins(fast: Ranked | None, other: Ranked | None) -> bool:
    return fast is not None and (other is None or fast.seconds < other.seconds)


def price_of_a_digit(cheap: Ranked, accurate: Ranked) -> float:
    """Return d log10(T) / d DoA between neighbours on the front: decades of time per digit of accuracy.

    Raises:
        InvalidInput: unless the second run is the more accurate one.
    """
    gained = degree_of_accuracy(bound_of(accurate)) - degree_of_accuracy(bound_of(cheap))
    if not gained > 0:
        raise InvalidInput(f"{accurate.method} is not more accurate than {cheap.method}")
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

"""A statement of the paper, the number that is computed to check it, and the condition for it to be correct."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

# Tolerances of "good approximation", and of "agrees almost exactly" and "the same".
GOOD = 0.05
SAME = 0.005


class StatementVerdict(StrEnum):
    """Verdict on a statement of the paper, as `docs/paper.md` prints it."""

    HOLDS = "correct"
    LOOSER = "outside the tolerance"
    SLIP = "misprint"


@dataclass(frozen=True)
class Statement:
    """A statement of the paper, a row of `docs/paper.md`, which has its place, its printed value and its quantity.

    Attributes:
        says: The statement in a few words, as in the row.
        measure: Function that computes the number of the row.
        holds: Whether the statement is true of the number.
        otherwise: The verdict where it is not.
    """

    says: str
    measure: Callable[[], float]
    holds: Callable[[float], bool]
    otherwise: StatementVerdict = StatementVerdict.LOOSER

    def judged(self) -> tuple[float, StatementVerdict]:
        """Return the computed number and the verdict on the statement."""
        value = self.measure()
        return value, StatementVerdict.HOLDS if self.holds(value) else self.otherwise


def deviation(value: float, reference: float) -> float:
    """Return how far a value is from a reference, relative to the reference."""
    return value / reference - 1


def within(share: float) -> Callable[[float], bool]:
    """Whether a deviation is at most a share."""
    return lambda value: abs(value) <= share


def reads(printed: float, half_unit: float) -> Callable[[float], bool]:
    """Whether a number rounds to the printed one."""
    return lambda value: abs(value - printed) <= half_unit


def above(other: Callable[[], float]) -> Callable[[float], bool]:
    """Whether a number is larger than another one that is computed."""
    return lambda value: value > other()


def below(other: Callable[[], float]) -> Callable[[float], bool]:
    """Whether a number is smaller than another one that is computed."""
    return lambda value: value < other()

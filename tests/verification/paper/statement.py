"""A statement of the paper, the number that is computed to check it, and the condition for it to be correct."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

# Tolerances of "good approximation", and of "agrees almost exactly" and "the same".
GOOD = 0.05
SAME = 0.005

MDR = "MDR, integral equation"
FORMULA = "written formula"


class StatementVerdict(StrEnum):
    """Verdict on a statement of the paper, as `docs/paper.md` prints it."""

    HOLDS = "correct"
    LOOSER = "outside the tolerance"
    SLIP = "misprint"


@dataclass(frozen=True)
class Measured:
    """A number with its error, absolute; ``in_percent`` shows it as a deviation."""

    value: float
    error: float = 0.0
    in_percent: bool = False


@dataclass(frozen=True)
class Statement:
    """A statement.

    Attributes:
        place: equation, section or figure.
        says: in a few words.
        printed: the value that the paper prints, or what it claims.
        what: the number that is computed.
        measure: computes it.
        holds: whether the statement is true of the number.
        method: what computes it.
        otherwise: the verdict where it is not.
    """

    place: str
    says: str
    printed: str
    what: str
    measure: Callable[[], Measured]
    holds: Callable[[float], bool]
    method: str = MDR
    otherwise: StatementVerdict = StatementVerdict.LOOSER

    def judged(self) -> tuple[Measured, StatementVerdict]:
        """Return the computed number and the verdict on the statement."""
        measured = self.measure()
        return measured, StatementVerdict.HOLDS if self.holds(measured.value) else self.otherwise


def deviation(value: float, reference: float, relative_error: float = 0.0) -> Measured:
    """How far a value is from a reference, in per cent."""
    return Measured(value / reference - 1, abs(value / reference) * relative_error, in_percent=True)


def within(share: float) -> Callable[[float], bool]:
    """Whether a deviation is at most a share."""
    return lambda value: abs(value) <= share


def reads(printed: float, half_unit: float) -> Callable[[float], bool]:
    """Whether a number rounds to the printed one."""
    return lambda value: abs(value - printed) <= half_unit


def above(other: Callable[[], Measured]) -> Callable[[float], bool]:
    """Whether a number is larger than another one that is computed."""
    return lambda value: value > other().value


def below(other: Callable[[], Measured]) -> Callable[[float], bool]:
    """Whether a number is smaller than another one that is computed."""
    return lambda value: value < other().value

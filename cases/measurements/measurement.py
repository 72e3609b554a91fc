"""One measured number, and the questions that studies ask of many of them.

A study describes settings and scenes; the driver turns each pair into rows of this one kind; what a report shows of
them (coverage, sharpness, cost of accuracy, where a method breaks) is a query on the rows.
"""

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, Literal, TypeAlias, TypeVar, get_args

import numpy as np

from cases.results.status import Status

K = TypeVar("K")
R = TypeVar("R")

End: TypeAlias = Literal["within", "refused", "beyond", "crashed"]
ENDS: Final[tuple[End, ...]] = get_args(End)

# Who judges a scene that was solved a second time, written down in another way: it says nothing about true errors.
RESTATED: Final = "the same scene restated"


@dataclass(frozen=True, kw_only=True)
class Measurement:
    """What one method with one setting made of one scene; all errors are relative.

    Attributes:
        method: Name in the method table, or what the method calls itself.
        settings: Numerical settings of the method.
        scene: What identifies the scene: a family and a number, a rung, a size.
        parameters: What sets the scene apart, such as its family or its band of a/h.
        seed: Of the scene, where it was drawn at random.
        quantity: What was measured; "" for the answer as a whole, which every scene has one row of.
        error: Distance from the reference.
        uncertainty: Of the reference itself.
        stated: Error that the method stated.
        sharpness: Stated over true error where the true error can be told; None elsewhere.
        reference: Who judged; "" where nobody did.
        seconds: Processor time of the answer [s].
        unknowns: Size of the largest system solved.
        counters: Iterations and the like, which repeat exactly.
        status: PASS with an answer, INVALID for a refusal by name, FAIL for a crash.
        reason: Of a status other than PASS, one sentence.
    """

    method: str
    settings: Mapping[str, Any] = field(default_factory=dict)
    scene: str = ""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    seed: int | None = None
    quantity: str = ""
    error: float = 0.0
    uncertainty: float = 0.0
    stated: float = 0.0
    sharpness: float | None = None
    reference: str = ""
    seconds: float = 0.0
    unknowns: int = 0
    counters: Mapping[str, int] = field(default_factory=dict)
    status: Status = Status.PASS
    reason: str = ""

    @property
    def bound(self) -> float:
        """U = error + uncertainty of the reference, by which settings are ranked."""
        return self.error + self.uncertainty

    @property
    def holds(self) -> bool:
        """Whether the stated error covers the distance, as far as the reference can tell."""
        return self.error <= self.stated + self.uncertainty


def grouped(rows: Iterable[R], key: Callable[[R], K]) -> dict[K, list[R]]:
    """Rows, or records of any kind, by a key, in the order in which keys appear."""
    found: dict[K, list[R]] = {}
    for row in rows:
        found.setdefault(key(row), []).append(row)
    return found


def answers(rows: Iterable[Measurement]) -> list[Measurement]:
    """The row of each answer as a whole."""
    return [row for row in rows if not row.quantity]


def by_quantity(rows: Iterable[Measurement]) -> dict[str, list[Measurement]]:
    """The rows of quantities that a reference judged."""
    return grouped((row for row in rows if row.quantity and row.reference != RESTATED), lambda row: row.quantity)


def end_of(rows: Sequence[Measurement]) -> tuple[End, str]:
    """How one scene ended, and why.

    "refused" by name, "crashed" with any other error, or with numbers "within" or "beyond" their stated errors.
    """
    whole, *found = rows
    if whole.status is not Status.PASS:
        return ("refused" if whole.status is Status.INVALID else "crashed"), whole.reason
    wrong = [row for row in found if not row.holds]
    message = "; ".join(f"{row.quantity} is off by {row.error:.1e}, stated {row.stated:.1e}" for row in wrong)
    return ("beyond" if wrong else "within"), message


def ends(rows: Iterable[Measurement]) -> dict[End, int]:
    """How many scenes ended in each way."""
    found = Counter(end_of(scene)[0] for scene in grouped(rows, lambda row: row.scene).values())
    return {end: found[end] for end in ENDS}


def defects(rows: Iterable[Measurement]) -> list[tuple[str, End, str]]:
    """Scenes with a wrong number without a word, or a crash: which, how it ended, and why."""
    found = [(scene, *end_of(own)) for scene, own in grouped(rows, lambda row: row.scene).items()]
    return [defect for defect in found if defect[1] in ("beyond", "crashed")]


def covered(rows: Sequence[Measurement]) -> float:
    """Share of the rows, of which there must be some, whose stated error covers the true one."""
    return sum(row.holds for row in rows) / len(rows)


def sharpness(rows: Iterable[Measurement]) -> list[float]:
    """Stated over true error of the rows whose true error can be told."""
    return [row.sharpness for row in rows if row.sharpness is not None]


def median(values: Sequence[float]) -> float | None:
    """The median; None of nothing."""
    return float(np.median(values)) if values else None


def refusals(rows: Iterable[Measurement]) -> dict[str, int]:
    """How often each reason was given for a refusal, numbers left out, the most frequent first."""
    refused = (row.reason for row in rows if row.status is Status.INVALID)
    return dict(Counter(re.sub(r"[-+.\d]+(e[-+]?\d+)?", "..", reason) for reason in refused).most_common())

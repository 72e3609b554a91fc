"""One measured number, and the questions that studies ask of many of them.

A study describes settings and scenes; the driver turns each pair into rows of this one kind; what a report shows of
them (coverage, sharpness, cost of accuracy, where a method breaks) is a query on the rows.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np

from cases.results.status import Status

K = TypeVar("K")


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


def grouped(rows: Iterable[Measurement], key: Callable[[Measurement], K]) -> dict[K, list[Measurement]]:
    """Rows by a key, in the order in which keys appear."""
    found: dict[K, list[Measurement]] = {}
    for row in rows:
        found.setdefault(key(row), []).append(row)
    return found


def answers(rows: Iterable[Measurement]) -> list[Measurement]:
    """The row of each answer as a whole."""
    return [row for row in rows if not row.quantity]


def judged(rows: Iterable[Measurement], quantity: str = "") -> list[Measurement]:
    """The rows of single quantities that somebody judged, of one quantity or of all."""
    return [row for row in rows if row.quantity and quantity in ("", row.quantity)]


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

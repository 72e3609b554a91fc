"""A study as a case of a report: its text, its records, and claims that a measured number keeps within a limit."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any, TypeVar

from cases.results.records.claim import Claim, Kind, Origin, Verdict
from cases.results.records.run import CaseResult
from cases.results.status import Status

R = TypeVar("R")

Say = Callable[[str], None]


def silent(line: str) -> None:
    """Say nothing."""


def study_case(
    name: str, title: str, question: str, text: str, *, equations: tuple[str, ...] = (), **found: Any
) -> CaseResult:
    """The result of a study, which has neither scenes nor runs of its own; `found` holds its claims and records."""
    return CaseResult(
        name=name,
        title=title,
        question=question,
        equations=equations,
        text=text.strip(),
        **{"scenes": (), "runs": (), "claims": (), **found},
    )


def told(records: Iterable[R], summary: Callable[[R], str], say: Say) -> Iterator[R]:
    """Each record as soon as it is there, with one line about it."""
    for record in records:
        say(summary(record))
        yield record


def within_limit(
    name: str,
    observed: float,
    limit: float,
    *,
    holds: bool | None = None,
    undecided: bool = False,
    expected: float | None = 0.0,
    origin: Origin = Origin.INDEPENDENT_METHOD,
    **words: Any,
) -> Claim:
    """The claim that an observed number is at most a limit.

    Args:
        name: Of the claim.
        observed: The number.
        limit: The largest that is allowed.
        holds: Whether it holds, where more than the limit decides.
        undecided: Whether too little was measured to say.
        expected: The best number there could be; None where there is none.
        origin: Where the expectation comes from.
        words: The other fields of a claim: scene, methods, quantity, source, because, derived_from, message.
    """
    passed = observed <= limit if holds is None else holds
    ends = (Status.PASS, Verdict.PASS) if passed else (Status.FAIL, Verdict.FAIL)
    status, verdict = (Status.INCONCLUSIVE, Verdict.INCONCLUSIVE) if undecided else ends
    return Claim(
        name=name,
        kind=Kind.INVARIANT,
        unit="1",
        status=status,
        verdict=verdict,
        observed=observed,
        expected=expected,
        tolerance=limit,
        fraction=observed / limit,
        origin=origin,
        **words,
    )

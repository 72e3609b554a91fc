"""Comparison of a second run with a first one: claims with another status, and numbers that changed."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from cases.answers import Answer, Values
from cases.rules import Judgement, nothing_compared
from cases.runs import Run
from cases.verdicts import Kind, Origin, Status, Verdict, Why
from reports.findings import WORST_FIRST
from reports.words import quantity_words

WHY = Why(
    Origin.OWN_EARLIER_OUTPUT,
    "the first run",
    "two answers to one question agree within the errors that they state",
    "the stated errors of both together",
)


def changed_claims(first: Run, second: Run) -> list[Verdict]:
    """The verdicts of the second run whose status differs in the first run or is absent there."""
    before = {(v.case, v.claim, v.scene, v.methods): v for v in first.judged.verdicts}
    pairs = [(v, before.get((v.case, v.claim, v.scene, v.methods))) for v in second.judged.verdicts]
    return [
        replace(verdict, message=f"{old.word if old else 'absent'} in the first run; {verdict.message}")
        for verdict, old in pairs
        if old is None or old.status is not verdict.status
    ]


def changed_numbers(first: Run, second: Run) -> list[Verdict]:
    """One verdict per quantity of both runs, and one per answer that only one of them has.

    Where each run has a single, different method for a scene, the two methods are compared.
    """
    verdicts: list[Verdict] = []
    for scene in dict.fromkeys((a.case, a.scene) for run in (first, second) for a in run.answers if not a.variant):
        before, after = (
            {a.method: a for a in run.answers if (a.case, a.scene) == scene and a.solved and not a.variant}
            for run in (first, second)
        )
        if len(before) == len(after) == 1:
            after = dict(zip(before, after.values(), strict=True))
        for method in dict.fromkeys([*before, *after]):
            verdicts += _compared(before.get(method), after.get(method))
    return verdicts


def _compared(old: Answer | None, new: Answer | None) -> Iterator[Verdict]:
    """One verdict per quantity of an answer of both runs, or a single one for an answer of one run."""
    answers = [answer for answer in (old, new) if answer is not None]
    if old is None or new is None:
        changes = {"answer": (nothing_compared(Status.INCOMPARABLE, "only one of the runs has it"), 0.0)}
    else:
        names = dict.fromkeys([*old.quantities, *new.quantities])
        pairs = {name: (old.quantities.get(name), new.quantities.get(name)) for name in names}
        changes = {name: change for name, pair in pairs.items() if (change := _change(*pair))}
    for name, (judged, stated) in changes.items():
        yield Verdict(
            case=answers[0].case,
            claim=f"{quantity_words(name)} of both runs",
            kind=Kind.REGRESSION,
            scene=answers[0].scene,
            methods=tuple(dict.fromkeys(answer.method for answer in answers)),
            quantity=name,
            tolerance=stated or 5e-324,
            why=WHY,
            **vars(judged),
        )


def _change(a: Values | None, b: Values | None) -> tuple[Judgement, float] | None:
    """Judgement of the largest change and the error stated there, both over the scale; None for fields at points."""
    if a is None or b is None or len(a.values) != len(b.values) or a.unit != b.unit:
        return nothing_compared(Status.INCOMPARABLE, "missing, or of another length or unit"), 0.0
    if not a.values or a.at:
        return None
    changes = (np.array(b.values) - np.array(a.values)) / a.scale
    step = int(np.argmax(np.abs(changes)))
    change, message = float(changes[step]), f"{b.values[step]:.17g} {b.unit}, was {a.values[step]:.17g}"
    if not (a.error and b.error):
        status = Status.INCONCLUSIVE if change else Status.PASS
        return Judgement(status=status, error=change, message=message), 0.0
    stated = float(np.hypot(a.error[step], b.error[step])) / a.scale
    fraction = abs(change) / stated if stated else None
    status = Status.DIFF if abs(change) > stated else Status.PASS
    return Judgement(status=status, error=change, fraction=fraction, message=message), stated


def headline(claims: list[Verdict], numbers: list[Verdict]) -> tuple[str, str]:
    """The result in a few words, and its tone."""
    worse = sum(verdict.status.is_failure for verdict in claims)
    checks = f"{worse} check{'s'[: worse != 1]} got worse; " if worse else ""
    if not numbers:
        return f"{checks}no number in common", "bad"
    beyond = sum(v.status.is_failure for v in numbers)
    tone = "bad" if worse or beyond else "warn" if claims else "good"
    if all(v.error == 0.0 for v in numbers):
        return f"{checks}all {len(numbers)} numbers identical", tone
    return f"{checks}{beyond} of {len(numbers)} numbers changed beyond their stated errors", tone


def worst_first(verdicts: list[Verdict]) -> list[Verdict]:
    """The verdicts that did not pass and the numbers that changed, the worst and the largest changes first."""
    changed = (v for v in verdicts if v.status is not Status.PASS or v.kind is not Kind.REGRESSION or v.error)
    return sorted(changed, key=lambda v: (WORST_FIRST.index(v.status), -abs(v.error or 0.0)))

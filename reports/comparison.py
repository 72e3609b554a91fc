"""Two runs side by side, the second against the first: checks that end otherwise and numbers that moved."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from cases.answers import Answer, Values
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
    """The verdicts of the second run that the first one has otherwise or not at all."""
    before = {(v.case, v.claim, v.scene, v.methods): v for v in first.judged.verdicts}
    found = []
    for v in second.judged.verdicts:
        old = before.get((v.case, v.claim, v.scene, v.methods))
        if old is None or old.status is not v.status:
            found.append(replace(v, message=f"{old.word if old else 'absent'} in the first run; {v.message}"))
    return found


def changed_numbers(first: Run, second: Run) -> list[Verdict]:
    """One verdict per quantity of both runs, and one per answer that only one of them has.

    Where each run has a single, different method for a scene, the two methods are compared.
    """
    found: list[Verdict] = []
    for scene in dict.fromkeys((a.case, a.scene) for run in (first, second) for a in run.answers if not a.variant):
        one, other = (
            {a.method: a for a in run.answers if (a.case, a.scene) == scene and a.solved and not a.variant}
            for run in (first, second)
        )
        if len(one) == len(other) == 1:
            pairs = [(next(iter(one.values())), next(iter(other.values())))]
        else:
            pairs = [(one[method], other[method]) for method in one if method in other]
            alone = [answer for method, answer in (one | other).items() if (method in one) is not (method in other)]
            found += [_verdict(a, a, "answer", Status.INCOMPARABLE, "only one of the runs has it") for a in alone]
        for a, b in pairs:
            found += _compared(a, b)
    return found


def _compared(one: Answer, other: Answer) -> Iterator[Verdict]:
    for name in dict.fromkeys([*one.quantities, *other.quantities]):
        a, b = one.quantities.get(name), other.quantities.get(name)
        if a is None or b is None or len(a.values) != len(b.values) or a.unit != b.unit:
            yield _verdict(one, other, name, Status.INCOMPARABLE, "missing, or of another length or unit")
        elif a.values and not a.at:
            yield _moved(one, other, name, a, b)


def _moved(one: Answer, other: Answer, name: str, a: Values, b: Values) -> Verdict:
    """The step where a quantity moved most, over its scale."""
    moves = (np.array(b.values) - np.array(a.values)) / a.scale
    step = int(np.argmax(np.abs(moves)))
    stated = float(np.hypot(a.error[step], b.error[step])) / a.scale if a.error and b.error else None
    move = float(moves[step])
    if stated is None:
        status = Status.INCONCLUSIVE if move else Status.PASS
    else:
        status = Status.DIFF if abs(move) > stated else Status.PASS
    words = f"{b.values[step]:.17g} {b.unit}, was {a.values[step]:.17g}"
    return _verdict(one, other, name, status, words, move, stated)


def _verdict(
    one: Answer, other: Answer, quantity: str, status: Status, message: str, *numbers: float | None
) -> Verdict:
    move, stated = numbers or (None, None)
    tolerance = stated or 5e-324
    return Verdict(
        case=one.case,
        claim=f"{quantity_words(quantity)} of both runs",
        kind=Kind.REGRESSION,
        scene=one.scene,
        methods=tuple(dict.fromkeys((one.method, other.method))),
        quantity=quantity,
        status=status,
        error=move,
        tolerance=tolerance,
        fraction=None if move is None or stated is None or not stated else abs(move) / tolerance,
        why=WHY,
        message=message,
    )


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
    return f"{checks}{beyond} of {len(numbers)} numbers moved beyond their stated errors", tone


def worst_first(verdicts: list[Verdict]) -> list[Verdict]:
    """What did not pass or moved, the worst and the furthest first."""
    moved = (v for v in verdicts if v.status is not Status.PASS or v.kind is not Kind.REGRESSION or v.error)
    return sorted(moved, key=lambda v: (WORST_FIRST.index(v.status), -abs(v.error or 0.0)))

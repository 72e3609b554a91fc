"""Compares a run with the accepted results: numbers, stated errors, counters, claims. Missing and new results fail."""

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import replace
from typing import Any, TypeAlias

from cases.answers import Answer, Values
from cases.gate.baseline import AcceptedClaim, Baseline, permitted_change, stored_part
from cases.rules import (
    SMALLEST_RELATIVE,
    Judgement,
    decided,
    judge_regression,
    judge_residual,
    nothing_compared,
    worst_judgement,
)
from cases.runs import CaseText, Run
from cases.stress import worse_than
from cases.studies import StressTest
from cases.verdicts import Kind, Origin, Status, Verdict, Why
from contact.records.extras import NOT_INSTALLED

# Largest permitted ratio of a stated error to the accepted one, and of its inverse: half of it fails for other meshes,
# twice of it misses a wrong error estimate.
LARGEST_RATIO = 10.0
UNKNOWNS = "unknowns"
VALUES = "max(10 x measured spread, 1e-12) of the accepted value or its scale, at least 1 % of its stated error"
COUNTS = "unknowns within 2 %; other counters within max(3, 20 %)"
ERRORS = f"a stated error stays within a factor {LARGEST_RATIO:g} of the accepted one"
CLAIMS = "a claim is judged on as many scenes as when the case was accepted"
ABSENT = "solvers of others are optional: what is not installed is not compared"
DIGITS = "one digit: repeats that differ by single roundings share about as many digits every time"

Watched = Callable[[Answer], bool]
# Case, scene and methods of a verdict.
Place: TypeAlias = tuple[str, str, tuple[str, ...]]


def gate(
    run: Run,
    baselines: Iterable[Baseline],
    *,
    methods: Collection[str] = (),
    watched: Watched = lambda answer: True,
) -> Run:
    """Return ``run`` with a regression verdict for every quantity and counter that was accepted or is new.

    Further verdicts are about the stated error that changed most of each answer, and about each accepted claim that is
    missing. A method that was not installed gets a single skipped verdict.

    Args:
        run: Run whose claims are judged.
        baselines: Accepted results; a case of the run's suite that the run does not have counts as missing.
        methods: Labels of the methods that are compared; empty for all.
        watched: Function that returns whether an answer needs accepted numbers; those of suite nightly alone do not.
    """
    accepted = {baseline.accepted.case: baseline for baseline in baselines}
    present = {text.name for text in run.judged.cases}
    suite = run.judged.suite
    lost = [name for name, b in sorted(accepted.items()) if name not in present and suite in b.accepted.suites]
    verdicts_of_claims = tuple(verdict for verdict in run.judged.verdicts if verdict.kind is not Kind.REGRESSION)

    def wanted(answer: Answer) -> bool:
        return watched(answer) and (not methods or answer.method in methods)

    stripped = replace(run, judged=replace(run.judged, verdicts=verdicts_of_claims))
    verdicts = tuple(
        verdict
        for name in (*present, *lost)
        for verdict in _of_case(stripped, name, accepted.get(name), wanted, methods)
    )
    texts = (*run.judged.cases, *(_lost_case(name) for name in lost))
    return replace(run, judged=replace(run.judged, cases=texts, verdicts=(*verdicts_of_claims, *verdicts)))


def _lost_case(name: str) -> CaseText:
    return CaseText(
        name=name,
        title="accepted, but not in this run",
        question="Where did this case go?",
        text="Baselines of this case exist for the suite of this run, yet the run does not have it.",
    )


def _of_case(
    run: Run, case: str, baseline: Baseline | None, watched: Watched, methods: Collection[str]
) -> Iterator[Verdict]:
    """Yield the verdicts of a case against its baseline, without methods that were not installed."""
    current = {(a.scene, a.method): a for a in run.answers.of_case(case)}
    accepted = {(a.scene, a.method): a for a in baseline.answers} if baseline else {}
    absent = _not_installed(current.values())
    for method, reason in absent.items():
        count = sum(len(answer.quantities) for answer in accepted.values() if answer.method == method)
        if count:
            judged = nothing_compared(Status.SKIP, f"{reason}; {count} accepted numbers are not compared")
            yield _verdict((case, "", (method,)), "numbers", judged, ABSENT)
    for place in dict.fromkeys([*accepted, *current]):
        new, old = current.get(place), accepted.get(place)
        shown = new or old
        if shown is not None and shown.method not in absent and watched(shown):
            yield from _of_answer((case, shown.scene, (shown.method,)), new, old)
    if baseline is not None:
        verdicts = [verdict for verdict in run.judged.verdicts if verdict.case == case]
        yield from _missing_claims(case, baseline.accepted.claims, verdicts, absent, methods)
        tests = [test for test in run.judged.stress_tests if test.case == case]
        yield from _stress_tests(case, tests, baseline.accepted.stress_tests)


def _not_installed(answers: Iterable[Answer]) -> dict[str, str]:
    """Methods that skipped every scene, at least one because they are not installed, with that reason."""
    answers = tuple(answers)
    named = {answer.method: answer.reason for answer in answers if NOT_INSTALLED in answer.reason}
    ran = {answer.method for answer in answers if answer.status is not Status.SKIP}
    return {method: reason for method, reason in named.items() if method not in ran}


def _of_answer(place: Place, new: Answer | None, old: Answer | None) -> Iterator[Verdict]:
    """Compare an answer with the accepted one: values, counters, the stated error that changed most."""
    solved = stored_part(new) if new is not None and new.solved else None
    before, after = (answer.quantities if answer else {} for answer in (old, solved))
    for name in dict.fromkeys([*before, *after]):
        q = before.get(name) or after[name]
        if not q.at:
            absent = _absent(name, after.get(name), before.get(name), new, old)
            judged, more = (absent, {}) if absent else _worst_value(after[name], before[name], new, old)
            yield _verdict(place, name, judged, VALUES, unit=q.unit, **more)
    if old is not None:
        accepted, counted = _counters(old), _counters(solved)
        for name in sorted({*accepted, *counted}):
            now, before_now = counted.get(name, 0), accepted.get(name)
            permitted = permitted_count_change(name, before_now or 0)
            absent = _absent(name, counted.get(name), before_now, new, old)
            judged = absent or judge_regression(now, before_now or 0, permitted=permitted)
            yield _verdict(place, name, judged, COUNTS, tolerance=permitted, expected=before_now)
        if solved is not None and solved.question == old.question:
            yield from _stated(place, after, before)


def _absent(what: str, current: object, accepted: object, new: Answer | None, old: Answer | None) -> Judgement | None:
    """Judgement of a value that was not accepted or that this run does not have; None if both values are there."""
    if accepted is None or old is None:
        scene = new.scene if new else ""
        message = f"extra: {what} of {scene!r} has no accepted value; look at it, then accept the case"
        return nothing_compared(Status.INCOMPARABLE, message)
    if current is None or new is None:
        status = new.status if new and new.status.is_failure else Status.INCOMPARABLE
        reason = f": {new.method} ended with {new.status}, {new.reason}" if new and not new.solved else ""
        return nothing_compared(status, f"missing: {what} of {old.scene!r} was accepted, this run has none{reason}")
    return None


def _worst_value(
    current: Values, accepted: Values, new: Answer | None, old: Answer | None
) -> tuple[Judgement, dict[str, Any]]:
    """Judgement of the worst step, its tolerance and accepted value.

    Answers to another question, or with another unit or number of steps, cannot be compared.
    """
    for what, a, b in (
        ("scene or settings", new and new.question, old and old.question),
        ("unit", current.unit, accepted.unit),
        ("number of steps", len(current.values), len(accepted.values)),
    ):
        if a != b:
            message = f"{what} changed: {a}, accepted {b}; accept the case if that was meant"
            return nothing_compared(Status.INCOMPARABLE, message), {}
    permitted = [permitted_change(accepted, step) for step in range(len(accepted.values))]
    rows = zip(current.values, accepted.values, permitted, strict=True)
    steps = [judge_regression(x, b, permitted=most) for x, b, most in rows]
    worst = worst_judgement(steps)
    step = steps.index(worst)
    return worst, {"tolerance": permitted[step], "expected": accepted.values[step]}


def _counters(answer: Answer | None) -> dict[str, int]:
    return {} if answer is None else {UNKNOWNS: answer.unknowns, **answer.counters}


def permitted_count_change(name: str, accepted: int) -> float:
    """Return the largest change of a counter that counts as equal, at least half a count."""
    return max(0.02 * accepted, 0.5) if name == UNKNOWNS else max(3.0, 0.2 * accepted)


def _stated(place: Place, current: dict[str, Values], accepted: dict[str, Values]) -> Iterator[Verdict]:
    """Judge the stated error that changed most: it may neither grow nor shrink unnoticed."""
    judgements = {
        f"uncertainty of {name}": _stated_error(f"uncertainty of {name}", current[name], b)
        for name, b in accepted.items()
        if name in current and len(current[name].values) == len(b.values) and (current[name].error or b.error)
    }
    if judgements:
        worst = worst_judgement(list(judgements.values()))
        what = next(name for name, judged in judgements.items() if judged is worst)
        yield _verdict(place, what, worst, ERRORS, tolerance=LARGEST_RATIO, expected=1.0)


def _stated_error(what: str, current: Values, accepted: Values) -> Judgement:
    """Judge the stated error of a field, or of the worst step.

    The ratio (stated + floor)/(accepted + floor) lies between 1/`LARGEST_RATIO` and `LARGEST_RATIO`. The floor is the
    error of a few thousand roundings: between smaller ones there is no difference.
    """
    if len(current.error) != len(accepted.error):
        words = f"extra: nobody accepted an {what}" if current.error else f"missing: this run does not state the {what}"
        return nothing_compared(Status.INCOMPARABLE, words)
    sizes = [1.0] if accepted.at else [max(abs(value), accepted.scale) for value in accepted.values]
    judgements = []
    for stated, before, size in zip(current.error, accepted.error, sizes, strict=True):
        ratio = (stated + SMALLEST_RELATIVE * size) / (before + SMALLEST_RELATIVE * size)
        fraction = max(ratio, 1.0 / ratio) / LARGEST_RATIO
        message = f"{what} {stated:.3g} against accepted {before:.3g}: {ratio:.3g} times, permitted 0.1 to 10 times"
        judgements.append(decided(fraction <= 1.0, ratio, fraction, message, Status.DIFF))
    return worst_judgement(judgements)


def judged_claims(verdicts: Iterable[Verdict]) -> tuple[AcceptedClaim, ...]:
    """Return each claim with the number of its verdicts, without regressions, which the gate itself adds."""
    judged = (verdict for verdict in verdicts if verdict.kind is not Kind.REGRESSION)
    counts = Counter((v.claim, v.kind, v.quantity, v.methods) for v in judged)
    return tuple(
        AcceptedClaim(name=name, kind=kind, quantity=quantity, methods=methods, judged=count)
        for (name, kind, quantity, methods), count in sorted(counts.items())
    )


def _missing_claims(
    case: str,
    accepted: Iterable[AcceptedClaim],
    verdicts: Iterable[Verdict],
    absent: Collection[str],
    methods: Collection[str],
) -> Iterator[Verdict]:
    """Yield a failure, under the claim's own name, for each accepted claim that the run does not judge as often.

    Claims about absent methods or methods that were not chosen are left out. If ``methods`` are chosen, orders of
    convergence are left out too: their reference may be another method, which an accepted claim does not name.
    """
    counts = {claim.identity: claim.judged for claim in judged_claims(verdicts)}
    for claim in accepted:
        chosen = not methods or (set(claim.methods) <= set(methods) and claim.kind is not Kind.ORDER)
        left_out = not chosen or any(label in absent for label in claim.methods)
        if left_out or (count := counts.get(claim.identity, 0)) >= claim.judged:
            continue
        message = (
            f"missing: the {claim.kind} claim {claim.name!r} about {claim.quantity} of {' and '.join(claim.methods)} "
            f"was accepted on {claim.judged} scenes, this run judges it on {count}; restore it, or accept the case "
            "with --loosen"
        )
        judged = nothing_compared(Status.INCOMPARABLE, message)
        verdict = _verdict((case, "", claim.methods), f"claim {claim.name!r}", judged, CLAIMS)
        yield replace(verdict, quantity=claim.quantity)


def _stress_tests(case: str, tests: list[StressTest], accepted: Iterable[StressTest]) -> Iterator[Verdict]:
    """Yield a verdict per stress test: no earlier breakdown, no more than one digit lost.

    An accepted test by a method fails if it is missing while both occur in other tests of the run. Without accepted
    tests there are no verdicts.
    """
    before = {(test.name, test.method): test for test in accepted}
    current = {(test.name, test.method): test for test in tests}
    names, methods = {name for name, _ in current}, {method for _, method in current}
    lost = {place: test for place, test in sorted(before.items()) if place[0] in names and place[1] in methods}
    for place, shown in ({**lost, **current} if before else {}).items():
        old = before.get(place)
        if old is None:
            message = "extra: this stress test was never accepted; look at it, then accept the run"
            judged = nothing_compared(Status.INCOMPARABLE, message)
        else:
            worse = worse_than(current.get(place, replace(old, steps=())), old)
            words = "; ".join(worse) or "no step lost, no more than one digit lost"
            judged = replace(judge_residual(float(len(worse)), tolerance=0.5, failure=Status.DIFF), message=words)
        expected = None if old is None else 0.0
        more: dict[str, Any] = {"tolerance": 0.5, "expected": expected}
        verdict = _verdict((case, shown.name, (shown.method,)), "steps and digits", judged, DIGITS, **more)
        yield replace(verdict, quantity=shown.quantity)


def _verdict(place: Place, what: str, judged: Judgement, basis: str, *, tolerance: float = 1.0, **more: Any) -> Verdict:
    """The verdict of a comparison with an accepted result.

    Args:
        place: Case, scene and methods.
        what: Name of the result.
        judged: Judgement of the comparison.
        basis: Choice of the tolerance.
        tolerance: Largest permitted change.
        more: Unit and accepted value.
    """
    case, scene, methods = place
    because = "an accepted number should not change unnoticed"
    return Verdict(
        case=case,
        claim=f"accepted {what}",
        kind=Kind.REGRESSION,
        scene=scene,
        methods=methods,
        quantity=what,
        tolerance=tolerance,
        why=Why(Origin.OWN_EARLIER_OUTPUT, f"baselines/{case}.jsonl", because, basis),
        **more,
        **vars(judged),
    )

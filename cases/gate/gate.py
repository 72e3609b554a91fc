"""Compares a run with the accepted results: numbers, stated errors, counters, claims. Missing and new results fail."""

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, replace

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

# A stated error may be this many times larger or smaller than the accepted one: half of it would see no bug, twice as
# much is more than another mesh makes of it.
LARGEST_RATIO = 10.0
UNKNOWNS = "unknowns"
VALUES = "max(10 x measured spread, 1e-12) of the accepted value or its scale, at least 1 % of its stated error"
COUNTS = "unknowns within 2 %; other counters within max(3, 20 %)"
ERRORS = f"a stated error stays within a factor {LARGEST_RATIO:g} of the accepted one"
CLAIMS = "a claim is judged on as many scenes as when the case was accepted"
ABSENT = "solvers of others are optional: what is not installed is not compared"
DIGITS = "one digit: repeats that differ by single roundings share about as many digits every time"

Watched = Callable[[Answer], bool]


@dataclass(frozen=True, kw_only=True)
class _Check:
    """One comparison with the accepted answer: what is compared, how it ended, its tolerance in the unit."""

    what: str
    judged: Judgement
    basis: str
    unit: str = "1"
    tolerance: float = 1.0
    expected: float | None = None


def gate(
    run: Run,
    baselines: Iterable[Baseline],
    *,
    methods: Collection[str] = (),
    watched: Watched = lambda answer: True,
) -> Run:
    """Return ``run`` with a regression verdict for every quantity and counter that was accepted or is new.

    The stated error that changed most is another one for each answer, as is each accepted claim that is missing. A
    method that is not installed where the run was made is named once and not compared.

    Args:
        run: Run whose claims are judged.
        baselines: Accepted results; a case of the run's suite that the run does not have counts as missing.
        methods: Labels of the methods that are compared; empty for all.
        watched: Whether an answer needs accepted numbers; those of the nightly suite alone do not.
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
    now = {(a.scene, a.method): a for a in run.answers.of_case(case)}
    then = {(a.scene, a.method): a for a in baseline.answers} if baseline else {}
    absent = _not_installed(now.values())
    for method, reason in absent.items():
        count = sum(len(answer.quantities) for answer in then.values() if answer.method == method)
        if count:
            words = nothing_compared(Status.SKIP, f"{reason}; {count} accepted numbers are not compared")
            yield _verdict(case, "", (method,), _Check(what="numbers", judged=words, basis=ABSENT))
    for place in dict.fromkeys([*then, *now]):
        new, old = now.get(place), then.get(place)
        shown = new or old
        if shown is not None and shown.method not in absent and watched(shown):
            for check in checks(new, old):
                yield _verdict(case, shown.scene, (shown.method,), check)
    if baseline is not None:
        verdicts = [verdict for verdict in run.judged.verdicts if verdict.case == case]
        yield from _missing_claims(case, baseline.accepted.claims, verdicts, absent, methods)
        tests = [test for test in run.judged.stress_tests if test.case == case]
        yield from _stress_tests(case, tests, baseline.accepted.stress_tests)


def _not_installed(answers: Iterable[Answer]) -> dict[str, str]:
    """Methods skipped on every scene, once at least since they are not installed, and that reason."""
    answers = tuple(answers)
    named = {answer.method: answer.reason for answer in answers if NOT_INSTALLED in answer.reason}
    asked = {answer.method for answer in answers if answer.status is not Status.SKIP}
    return {method: reason for method, reason in named.items() if method not in asked}


def checks(new: Answer | None, old: Answer | None) -> Iterator[_Check]:
    """Yield the comparison of an answer with the accepted one: values, counters, the stated error that changed most."""
    solved = stored_part(new) if new is not None and new.solved else None
    before, after = ({} if one is None else one.quantities for one in (old, solved))
    for name in dict.fromkeys([*before, *after]):
        now, then = after.get(name), before.get(name)
        shown = then or now
        if shown and not shown.at:
            absent = _absent(name, now, then, new, old)
            other = _Check(what=name, judged=absent, basis=VALUES, unit=shown.unit) if absent else None
            yield other or _value(name, now or shown, then or shown, new, old)
    if old is not None:
        counts, counted = _counters(old), _counters(solved)
        for name in sorted({*counts, *counted}):
            value, accepted = counted.get(name), counts.get(name)
            absent = _absent(name, value, accepted, new, old)
            yield _count(name, value or 0, accepted, absent)
        if solved is not None and solved.question == old.question:
            yield from _stated(after, before)


def _absent(what: str, now: object, then: object, new: Answer | None, old: Answer | None) -> Judgement | None:
    """Why there is nothing to compare: nobody accepted it, or this run does not have it."""
    if then is None or old is None:
        scene = new.scene if new else ""
        message = f"extra: {what} of {scene!r} has no accepted value; look at it, then accept the case"
        return nothing_compared(Status.INCOMPARABLE, message)
    if now is None or new is None:
        status = new.status if new and new.status.is_failure else Status.INCOMPARABLE
        reason = f": {new.method} ended with {new.status}, {new.reason}" if new and not new.solved else ""
        return nothing_compared(status, f"missing: {what} of {old.scene!r} was accepted, this run has none{reason}")
    return None


def _value(name: str, now: Values, then: Values, new: Answer | None, old: Answer | None) -> _Check:
    """Judge the worst step; another question, unit or number of steps cannot be compared."""
    for what, a, b in (
        ("scene or settings", new and new.question, old and old.question),
        ("unit", now.unit, then.unit),
        ("number of steps", len(now.values), len(then.values)),
    ):
        if a != b:
            message = f"{what} changed: {a}, accepted {b}; accept the case if that was meant"
            judged = nothing_compared(Status.INCOMPARABLE, message)
            return _Check(what=name, judged=judged, basis=VALUES, unit=then.unit)
    permitted = [permitted_change(then, step) for step in range(len(then.values))]
    rows = zip(now.values, then.values, permitted, strict=True)
    steps = [judge_regression(x, b, permitted=most) for x, b, most in rows]
    worst = worst_judgement(steps)
    step = steps.index(worst)
    more = {"tolerance": permitted[step], "expected": then.values[step]}
    return _Check(what=name, judged=worst, basis=VALUES, unit=then.unit, **more)


def _counters(answer: Answer | None) -> dict[str, int]:
    return {} if answer is None else {UNKNOWNS: answer.unknowns, **answer.counters}


def _count(name: str, value: int, accepted: int | None, absent: Judgement | None) -> _Check:
    """Judge a deterministic counter, which no noise on the machine changes; half a count permits not a single one."""
    permitted = permitted_count_change(name, accepted or 0)
    change = abs(value - (accepted or 0))
    message = f"{name} {value} against accepted {accepted}, permitted change {permitted:g}"
    fraction = change / permitted if permitted > 0 else float(change)
    judged = absent or decided(change <= permitted, float(value), fraction, message, Status.DIFF)
    expected = None if accepted is None else float(accepted)
    return _Check(what=name, judged=judged, basis=COUNTS, tolerance=max(permitted, 0.5), expected=expected)


def permitted_count_change(name: str, accepted: int) -> float:
    """Return the largest change of a counter that counts as equal."""
    return 0.02 * accepted if name == UNKNOWNS else max(3.0, 0.2 * accepted)


def _stated(now: dict[str, Values], then: dict[str, Values]) -> Iterator[_Check]:
    """Judge the stated error that changed most: it may neither grow nor shrink unnoticed."""
    judgements = {
        f"uncertainty of {name}": _stated_error(f"uncertainty of {name}", now[name], b)
        for name, b in then.items()
        if name in now and len(now[name].values) == len(b.values) and (now[name].error or b.error)
    }
    if judgements:
        worst = worst_judgement(list(judgements.values()))
        what = next(name for name, judged in judgements.items() if judged is worst)
        yield _Check(what=what, judged=worst, basis=ERRORS, tolerance=LARGEST_RATIO, expected=1.0)


def _stated_error(what: str, now: Values, then: Values) -> Judgement:
    """Judge the stated error of the worst step, or of a field."""
    if len(now.error) != len(then.error):
        words = f"extra: nobody accepted an {what}" if now.error else f"missing: this run does not state the {what}"
        return nothing_compared(Status.INCOMPARABLE, words)
    sizes = [1.0] if then.at else [max(abs(value), then.scale) for value in then.values]
    rows = zip(now.error, then.error, sizes, strict=True)
    return worst_judgement([judge_stated(what, x, y, SMALLEST_RELATIVE * size) for x, y, size in rows])


def judge_stated(name: str, stated: float, accepted: float, floor: float) -> Judgement:
    """Judge (stated + floor) / (accepted + floor), which lies between 1 / `LARGEST_RATIO` and `LARGEST_RATIO`.

    Args:
        name: Name of the error, for the message.
        stated: Error that this run states.
        accepted: Error in the baseline.
        floor: Error of a few thousand roundings, same unit; between smaller ones there is no difference.
    """
    ratio = (stated + floor) / (accepted + floor)
    fraction = max(ratio, 1.0 / ratio) / LARGEST_RATIO
    message = f"{name} {stated:.3g} against accepted {accepted:.3g}: {ratio:.3g} times, permitted 0.1 to 10 times"
    return decided(fraction <= 1.0, ratio, fraction, message, Status.DIFF)


def judged_claims(verdicts: Iterable[Verdict]) -> tuple[AcceptedClaim, ...]:
    """Return how often each claim was judged; regression, which the gate itself adds, is none of them."""
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

    Claims that need an absent method, or another one than the chosen ``methods``, are left out, and then so are orders:
    these may be measured against the answer of another method, which an accepted claim does not name.
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
        check = _Check(what=f"claim {claim.name!r}", judged=judged, basis=CLAIMS)
        yield replace(_verdict(case, "", claim.methods, check), quantity=claim.quantity)


def _stress_tests(case: str, tests: list[StressTest], accepted: Iterable[StressTest]) -> Iterator[Verdict]:
    """One verdict per stress test: no earlier breakdown, no more than one digit lost.

    A test that its method no longer takes though it takes others and others take it fails by its name. Nothing is
    claimed as long as none was accepted.
    """
    before = {(test.name, test.method): test for test in accepted}
    now = {(test.name, test.method): test for test in tests}
    names, methods = {name for name, _ in now}, {method for _, method in now}
    lost = {place: test for place, test in sorted(before.items()) if place[0] in names and place[1] in methods}
    for place, shown in ({**lost, **now} if before else {}).items():
        then = before.get(place)
        if then is None:
            message = "extra: this stress test was never accepted; look at it, then accept the run"
            judged = nothing_compared(Status.INCOMPARABLE, message)
        else:
            worse = worse_than(now.get(place, replace(then, steps=())), then)
            words = "; ".join(worse) or "no step lost, no more than one digit lost"
            judged = replace(judge_residual(float(len(worse)), tolerance=0.5, failure=Status.DIFF), message=words)
        expected = None if then is None else 0.0
        check = _Check(what="steps and digits", judged=judged, basis=DIGITS, tolerance=0.5, expected=expected)
        yield replace(_verdict(case, shown.name, (shown.method,), check), quantity=shown.quantity)


def _verdict(case: str, scene: str, methods: tuple[str, ...], check: _Check) -> Verdict:
    source, because = f"baselines/{case}.jsonl", "an accepted number should not change unnoticed"
    own = {name: value for name, value in vars(check).items() if name in ("unit", "tolerance", "expected")}
    return Verdict(
        case=case,
        claim=f"accepted {check.what}",
        kind=Kind.REGRESSION,
        scene=scene,
        methods=methods,
        quantity=check.what,
        why=Why(Origin.OWN_EARLIER_OUTPUT, source, because, check.basis),
        **own,
        **vars(check.judged),
    )

"""A run against what was accepted: every number, stated error, counter and claim, nothing missing and nothing extra."""

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import dataclass, replace

from cases.answers import Answer, Values
from cases.gate.baseline import AcceptedClaim, Baseline, kept, permitted_change
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
        run: a run whose own claims are judged.
        baselines: what was accepted; a case of the run's suite that the run does not have counts as missing.
        methods: that are compared; empty for all.
        watched: whether an answer needs accepted numbers; those of the nightly suite alone do not.
    """
    accepted = {baseline.accepted.case: baseline for baseline in baselines}
    present = {text.name for text in run.judged.cases}
    suite = run.judged.suite
    lost = [name for name, b in sorted(accepted.items()) if name not in present and suite in b.accepted.suites]
    own = tuple(verdict for verdict in run.judged.verdicts if verdict.kind is not Kind.REGRESSION)

    def wanted(answer: Answer) -> bool:
        return watched(answer) and (not methods or answer.method in methods)

    stripped = replace(run, judged=replace(run.judged, verdicts=own))
    verdicts = tuple(
        verdict
        for name in (*present, *lost)
        for verdict in _of_case(stripped, name, accepted.get(name), wanted, methods)
    )
    texts = (*run.judged.cases, *(_lost_case(name) for name in lost))
    return replace(run, judged=replace(run.judged, cases=texts, verdicts=(*own, *verdicts)))


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
        own = [verdict for verdict in run.judged.verdicts if verdict.case == case]
        yield from _missing_claims(case, baseline.accepted.claims, own, absent, methods)
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
    solved = kept(new) if new is not None and new.solved else None
    before = old.quantities if old is not None else {}
    after = solved.quantities if solved is not None else {}
    for name in dict.fromkeys([*before, *after]):
        a, b = after.get(name), before.get(name)
        if not (a.at if a is not None else b is not None and b.at):
            yield _value(name, a, b, new, old)
    if old is not None:
        yield from _counts(_counters(solved), old, new)
        if solved is not None and solved.question == old.question:
            yield from _stated(after, before)


def _value(name: str, now: Values | None, then: Values | None, new: Answer | None, old: Answer | None) -> _Check:
    """Judge the worst step; another question, unit or number of steps cannot be compared."""
    if then is None or old is None:
        return _Check(what=name, judged=_extra(name, new), basis=VALUES, unit=now.unit if now else "1")
    if now is None or new is None:
        return _Check(what=name, judged=_missing(name, new, old), basis=VALUES, unit=then.unit)
    for what, a, b in (
        ("scene or settings", new.question, old.question),
        ("unit", now.unit, then.unit),
        ("number of steps", len(now.values), len(then.values)),
    ):
        if a != b:
            message = f"{what} changed: {a}, accepted {b}; accept the case if that was meant"
            return _Check(
                what=name, judged=nothing_compared(Status.INCOMPARABLE, message), basis=VALUES, unit=then.unit
            )
    pairs = enumerate(zip(now.values, then.values, strict=True))
    steps = [judge_regression(x, b, permitted=permitted_change(then, step)) for step, (x, b) in pairs]
    worst = worst_judgement(steps)
    step = steps.index(worst)
    return _Check(
        what=name,
        judged=worst,
        basis=VALUES,
        unit=then.unit,
        tolerance=permitted_change(then, step),
        expected=then.values[step],
    )


def _extra(what: str, answer: Answer | None) -> Judgement:
    scene = answer.scene if answer else ""
    message = f"extra: {what} of {scene!r} has no accepted value; look at it, then accept the case"
    return nothing_compared(Status.INCOMPARABLE, message)


def _missing(what: str, new: Answer | None, old: Answer) -> Judgement:
    status = new.status if new and new.status.is_failure else Status.INCOMPARABLE
    reason = f": {new.method} ended with {new.status}, {new.reason}" if new and not new.solved else ""
    return nothing_compared(status, f"missing: {what} of {old.scene!r} was accepted, this run has none{reason}")


def _counters(answer: Answer | None) -> dict[str, int]:
    return {} if answer is None else {UNKNOWNS: answer.unknowns, **answer.counters}


def _counts(now: dict[str, int], old: Answer, new: Answer | None) -> Iterator[_Check]:
    """Judge deterministic counters, which no noise on the machine changes."""
    then = _counters(old)
    for name in sorted({*then, *now}):
        accepted, value = then.get(name), now.get(name)
        permitted = permitted_count_change(name, accepted or 0)
        if accepted is None:
            judged = _extra(name, new)
        elif value is None:
            judged = _missing(name, new, old)
        else:
            change = abs(value - accepted)
            message = f"{name} {value} against accepted {accepted}, permitted change {permitted:g}"
            fraction = change / permitted if permitted > 0 else float(change)
            judged = decided(change <= permitted, float(value), fraction, message, Status.DIFF)
        # Half a count permits not a single one.
        tolerance, expected = max(permitted, 0.5), None if accepted is None else float(accepted)
        yield _Check(what=name, judged=judged, basis=COUNTS, tolerance=tolerance, expected=expected)


def permitted_count_change(name: str, accepted: int) -> float:
    """Return the largest change of a counter that counts as equal."""
    return 0.02 * accepted if name == UNKNOWNS else max(3.0, 0.2 * accepted)


def _stated(now: dict[str, Values], then: dict[str, Values]) -> Iterator[_Check]:
    """Judge the stated error that changed most: it may neither grow nor shrink unnoticed."""
    found: dict[str, Judgement] = {}
    for name, b in then.items():
        a = now.get(name)
        if a is None or len(a.values) != len(b.values) or not (a.error or b.error):
            continue
        what = f"uncertainty of {name}"
        if len(a.error) != len(b.error):
            words = f"extra: nobody accepted an {what}" if a.error else f"missing: this run does not state the {what}"
            found[name] = nothing_compared(Status.INCOMPARABLE, words)
            continue
        sizes = [1.0] if b.at else [max(abs(value), b.scale) for value in b.values]
        triples = zip(a.error, b.error, sizes, strict=True)
        found[name] = worst_judgement([judge_stated(what, x, y, SMALLEST_RELATIVE * size) for x, y, size in triples])
    if found:
        worst = worst_judgement(list(found.values()))
        name = next(name for name, judged in found.items() if judged is worst)
        what = f"uncertainty of {name}"
        yield _Check(what=what, judged=worst, basis=ERRORS, tolerance=LARGEST_RATIO, expected=1.0)


def judge_stated(name: str, stated: float, accepted: float, floor: float) -> Judgement:
    """Judge (stated + floor) / (accepted + floor), which lies between 1 / `LARGEST_RATIO` and `LARGEST_RATIO`.

    Args:
        name: of the error, for the message.
        stated: by this run.
        accepted: with the baseline.
        floor: error of a few thousand roundings, same unit; between smaller ones there is no difference.
    """
    ratio = (stated + floor) / (accepted + floor)
    fraction = max(ratio, 1.0 / ratio) / LARGEST_RATIO
    message = f"{name} {stated:.3g} against accepted {accepted:.3g}: {ratio:.3g} times, permitted 0.1 to 10 times"
    return decided(fraction <= 1.0, ratio, fraction, message, Status.DIFF)


def judged_claims(verdicts: Iterable[Verdict]) -> tuple[AcceptedClaim, ...]:
    """Return how often each claim was judged; regression, which the gate itself adds, is none of them."""
    own = (verdict for verdict in verdicts if verdict.kind is not Kind.REGRESSION)
    counts = Counter((v.claim, v.kind, v.quantity, v.methods) for v in own)
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
    for place in dict.fromkeys([*now, *sorted(before)]) if before else ():
        then, test = before.get(place), now.get(place)
        if test is None and (then is None or place[0] not in names or place[1] not in methods):
            continue
        yield _stress_test(case, test, then)


def _stress_test(case: str, test: StressTest | None, then: StressTest | None) -> Verdict:
    if then is None:
        message = "extra: this stress test was never accepted; look at it, then accept the run"
        judged = nothing_compared(Status.INCOMPARABLE, message)
    else:
        worse = worse_than(test or replace(then, steps=()), then)
        words = "; ".join(worse) or "no step lost, no more than one digit lost"
        judged = replace(judge_residual(float(len(worse)), tolerance=0.5, failure=Status.DIFF), message=words)
    (shown, *_) = [one for one in (test, then) if one is not None]
    expected = None if then is None else 0.0
    check = _Check(what="steps and digits", judged=judged, basis=DIGITS, tolerance=0.5, expected=expected)
    return replace(_verdict(case, shown.name, (shown.method,), check), quantity=shown.quantity)


def _verdict(case: str, scene: str, methods: tuple[str, ...], check: _Check) -> Verdict:
    source, because = f"baselines/{case}.jsonl", "an accepted number should not change unnoticed"
    return Verdict(
        case=case,
        claim=f"accepted {check.what}",
        kind=Kind.REGRESSION,
        scene=scene,
        methods=methods,
        quantity=check.what,
        unit=check.unit,
        status=check.judged.status,
        error=check.judged.error,
        fraction=check.judged.fraction,
        expected=check.expected,
        tolerance=check.tolerance,
        why=Why(Origin.OWN_EARLIER_OUTPUT, source, because, check.basis),
        message=check.judged.message,
    )

"""All stress tests by all methods: digits, breakdowns, and the claim that nothing fails silently."""

from collections.abc import Callable, Iterable, Mapping
from typing import Any, Final

from cases.declare.methods import build
from cases.measurements.ladders.ladders import NAME, LadderPlan, climb
from cases.rules import judge_residual
from cases.runs import CaseText, Part
from cases.studies import Step, StressTest
from cases.verdicts import Kind, Origin, Status, Verdict, Why
from contact import InvalidInput, Method

# Settings at which each method is tested: what counts are digits that repeats share, not the size of errors.
CLIMBERS: Final[Mapping[str, Mapping[str, Any]]] = {
    "mdr": {},
    "mdr_table": {"cells": 128, "ratios": 60, "radii": 200},
    "integral_equation": {},
    "bem": {"points": 256},
    "fem": {"order": 3, "edge_cell": 1e-5},
}
TEXT: Final = """
A parameter is made harder step by step for every method that supports the scene. Each step is solved again with all
inputs moved by one unit in the last place, in other units, amid other steps and on two threads: the digits that all
these answers share are significant. Laws of mechanics are checked on every step, and so is the distance from the fast
method. A step may be refused with a named error. A number beyond its stated error, a warning or a crash is a failure.
"""
WHY = Why(
    Origin.INDEPENDENT_METHOD,
    "laws of mechanics, repeats, and the fast method",
    "a method may refuse a scene with a reason, but a number it gives has to lie within the error it states",
    "half a step: not one may fail",
)


def ladder_case(
    plans: Iterable[LadderPlan],
    climbers: Mapping[str, Mapping[str, Any]] = CLIMBERS,
    progress: Callable[[str], None] = lambda line: None,
) -> Part:
    """Return every test by every method that supports it.

    Args:
        plans: what is made harder.
        climbers: settings by name in the method table.
        progress: called with a line per test, and with one per step that was not answered.
    """
    methods = {name: build(name, settings) for name, settings in climbers.items()}
    tests = []
    for plan in plans:
        for name, method in methods.items():
            if climbs(plan, name, method):
                tests.append(climb(plan, method, name))
                progress("\n".join((summary(tests[-1]), *refusals(tests[-1]))))
    text = CaseText(
        name=NAME,
        title="Hard parameters, step by step until something breaks",
        question="Where does each method stop, how many digits are left, and does it say so?",
        text=TEXT.strip(),
    )
    return Part(text=text, verdicts=tuple(map(no_silent_failure, tests)), stress_tests=tuple(tests))


def climbs(plan: LadderPlan, name: str, method: Method) -> bool:
    """Whether a method takes this test: it is asked to, and it supports the first scene."""
    asked = name in plan.only if plan.only else name not in plan.spared
    return asked and bool(method.supports(plan.scene(plan.values[0])))


def breakdown(test: StressTest) -> Step | None:
    """Return the first step that was refused or failed; None if all were answered."""
    return next((step for step in test.steps if step.status != Status.PASS), None)


def summary(test: StressTest) -> str:
    """Return one line: where it stops and how many digits are left."""
    stop = breakdown(test)
    end = "answered to the end" if stop is None else f"stops at {test.parameter} = {stop.value:g}"
    fewest = min((step.digits for step in test.steps if step.digits is not None), default=0.0)
    return f"{test.name}, {test.method}: {end}, at least {fewest:.1f} digits"


def refusals(test: StressTest) -> list[str]:
    """Return one line for each step that was not answered."""
    stopped = [step for step in test.steps if step.status != Status.PASS]
    return [f"  {test.parameter} = {step.value:g}: {step.status}: {step.reason}" for step in stopped]


def worse_than(test: StressTest, accepted: StressTest) -> list[str]:
    """Return the steps that are worse than accepted: refused, not solved, or with one correct digit less."""
    taken = {step.value: step for step in test.steps}
    found = []
    for before in accepted.steps:
        if before.digits is None:
            continue
        step = taken.get(
            before.value, Step(value=before.value, status=Status.INVALID, reason="not solved", digits=None)
        )
        place = f"{test.name}, {test.method}, {test.parameter} = {step.value:g}"
        if step.digits is None:
            found.append(f"{place}: {step.reason or step.status}, but {before.digits:.1f} digits were accepted")
        elif step.digits < before.digits - 1.0:
            found.append(f"{place}: {step.digits:.1f} digits, but {before.digits:.1f} were accepted")
    return found


def no_silent_failure(test: StressTest) -> Verdict:
    """Return the verdict that every step was answered or refused with a reason; its error counts the others."""
    failed = [step for step in test.steps if step.status == Status.FAIL]
    worst = f"; {test.parameter} = {failed[0].value:g}: {failed[0].reason}" if failed else ""
    judged = judge_residual(float(len(failed)), tolerance=0.5)
    return Verdict(
        case=NAME,
        claim="no silent failure",
        kind=Kind.INVARIANT,
        scene=test.name,
        methods=(test.method,),
        quantity=test.quantity,
        status=judged.status,
        error=judged.error,
        expected=0.0,
        tolerance=0.5,
        fraction=judged.fraction,
        why=WHY,
        message=summary(test) + worst,
    )


def chosen(plans: Iterable[LadderPlan], words: Iterable[str]) -> list[LadderPlan]:
    """Return the plans whose names contain one of the words; all if there are no words.

    Raises:
        InvalidInput: If no test has such a name.
    """
    plans, words = list(plans), list(words)
    found = [plan for plan in plans if not words or any(word in plan.name for word in words)]
    if not found:
        raise InvalidInput(f"no stress test {words[0]!r}; there are {', '.join(plan.name for plan in plans)}")
    return found

"""All ladders by all methods as one case of a report: digits, breakdowns, and the claim that nothing fails silently."""

from collections.abc import Iterable, Mapping
from typing import Any, Final

from cases.declare.methods import build
from cases.measurements.ladders.ladders import LadderPlan, climb
from cases.measurements.study import Say, silent, study_case, told, within_limit
from cases.results.records.claim import Claim
from cases.results.records.reliability import Ladder
from cases.results.records.run import CaseResult
from cases.results.status import Status
from contact import InvalidInput, Method

NAME: Final = "stability"
CLIMBERS: Final[Mapping[str, Mapping[str, Any]]] = {
    "mdr": {},
    "mdr_table": {"cells": 128, "ratios": 60, "radii": 200},
    "integral_equation": {},
    "bem": {"points": 256},
    "fem": {"order": 3, "edge_cell": 1e-5},
}
"""Settings at which each method climbs: what is watched are digits that repeats share, not the size of errors."""

TEXT: Final = """
A hard parameter is walked in steps from easy to hard by every method that supports the scene. Each rung is solved
again with all inputs moved by one unit in the last place, in other units, amid other steps and on two threads: the
digits that all these answers share are significant. Laws of mechanics are checked on every rung; so are an
independent solution, where it reaches, and the answer of the fast method. A rung may be refused by a named error; a
number beyond its stated error, a warning or a crash is a failure.
"""


def ladder_case(
    plans: Iterable[LadderPlan],
    climbers: Mapping[str, Mapping[str, Any]] = CLIMBERS,
    progress: Say = silent,
) -> CaseResult:
    """Walk every plan by every climber that supports it.

    Args:
        plans: what is walked.
        climbers: settings by name in the method table.
        progress: called with one line a ladder.
    """
    methods = {name: build(name, settings) for name, settings in climbers.items()}
    walks = (
        climb(plan, method, name) for plan in plans for name, method in methods.items() if climbs(plan, name, method)
    )
    ladders = tuple(told(walks, lambda ladder: "\n".join((summary(ladder), *refusals(ladder))), progress))
    return study_case(
        NAME,
        "Hard parameters, walked until something breaks",
        "Where does each method give up, how many digits are left, and does it say so?",
        TEXT,
        claims=tuple(map(no_silent_failure, ladders)),
        ladders=ladders,
    )


def climbs(plan: LadderPlan, name: str, method: Method) -> bool:
    """Whether a method walks this ladder: it is asked to, and it supports the first rung."""
    asked = name in plan.only if plan.only else name not in plan.spared
    return asked and bool(method.supports(plan.scene(plan.values[0])))


def summary(ladder: Ladder) -> str:
    """One line: where it stops and how many digits are left."""
    stop = ladder.breakdown
    end = "climbed to the end" if stop is None else f"stops at {ladder.parameter} = {stop.value:g}"
    return f"{ladder.name}, {ladder.method}: {end}, at least {ladder.fewest_digits or 0.0:.1f} digits"


def refusals(ladder: Ladder) -> list[str]:
    """One line for each rung that was not climbed."""
    stopped = [rung for rung in ladder.rungs if rung.status is not Status.PASS]
    return [f"  {ladder.parameter} = {rung.value:g}: {rung.status}: {rung.reason}" for rung in stopped]


def no_silent_failure(ladder: Ladder) -> Claim:
    """The claim that every rung was climbed or refused by name; observed is the number of rungs that were not."""
    failed = [rung for rung in ladder.rungs if rung.status is Status.FAIL]
    worst = f"; {ladder.parameter} = {failed[0].value:g}: {failed[0].reason}" if failed else ""
    return within_limit(
        "no silent failure",
        float(len(failed)),
        0.5,
        scene=ladder.name,
        methods=(ladder.method,),
        quantity=ladder.quantity,
        source="laws of mechanics, repeats, an integral equation of its own, and the fast method",
        because="a method may refuse a scene by name, but a number it gives has to lie within the error it states",
        derived_from="half a rung: not one may fail",
        message=summary(ladder) + worst,
    )


def chosen(plans: Iterable[LadderPlan], words: Iterable[str]) -> list[LadderPlan]:
    """The plans whose names contain one of the words; all if there are no words.

    Raises:
        InvalidInput: If no ladder has such a name.
    """
    plans, words = list(plans), list(words)
    found = [plan for plan in plans if not words or any(word in plan.name for word in words)]
    if not found:
        raise InvalidInput(f"no ladder called {words[0]!r}; there are {', '.join(plan.name for plan in plans)}")
    return found

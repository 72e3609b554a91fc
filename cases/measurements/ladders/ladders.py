"""A hard parameter walked in steps until something breaks: digits, iterations and invariant residuals of each rung."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cases.declare.methods import build
from cases.measurements.campaigns.invariants import invariant_residuals
from cases.measurements.ladders.repeats import repeated, shared_digits
from cases.results.records.reliability import Ladder, Rung
from cases.results.status import Status
from contact import ContactError, Method, Scene, Solution

_OWN_ERROR = "stated error"
_JUDGES = ("second opinion", "fast method")  # residuals that may not exceed the stated error
_FAST = "mdr"
_LARGEST_EXCESS = 1e-12  # of an invariant residual over the stated error: rounding of the check itself


@dataclass(frozen=True, kw_only=True)
class LadderPlan:
    """What is walked.

    Attributes:
        name: Unique.
        parameter: What is walked, with its symbol.
        unit: "1" for a ratio.
        values: From easy to hard.
        scene: The scene of a rung.
        quantity: Whose last value is followed.
        method: The method of a rung, made from the method that climbs; by default that method itself.
        only: Names of methods that climb; empty means all.
        spared: Names of methods that would take minutes for a rung.
    """

    name: str
    parameter: str
    unit: str = "1"
    values: tuple[float, ...]
    scene: Callable[[float], Scene]
    quantity: str = "normal_force"
    method: Callable[[Method, float], Method] = lambda method, _: method
    only: tuple[str, ...] = ()
    spared: tuple[str, ...] = ()


def climb(plan: LadderPlan, method: Method, label: str | None = None) -> Ladder:
    """Walk the whole ladder; a rung that fails by name does not stop the walk, so that a hole in the middle is seen."""
    rungs = tuple(_rung(plan, plan.method(method, value), value) for value in plan.values)
    return Ladder(
        name=plan.name,
        parameter=plan.parameter,
        unit=plan.unit,
        method=label or method.name,
        quantity=plan.quantity,
        rungs=rungs,
    )


def _rung(plan: LadderPlan, method: Method, value: float) -> Rung:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            return _climbed(plan, method, value)
    except ContactError as error:
        return Rung(value=value, status=Status.INVALID, reason=f"{type(error).__name__}: {error!s:.200}", digits=None)
    except Exception as error:  # a crash is no named refusal; the report has to show it
        return Rung(
            value=value, status=Status.FAIL, reason=f"crash: {type(error).__name__}: {error!s:.200}", digits=None
        )


def _climbed(plan: LadderPlan, method: Method, value: float) -> Rung:
    scene = plan.scene(value)
    answer = method.solve(scene)
    stated = _stated(answer, plan.quantity)
    residuals = invariant_residuals(method, answer) | _beside_the_fast_method(method, answer, plan.quantity)
    wrong = max(residuals.get(judge, 0.0) for judge in _JUDGES) > stated + _LARGEST_EXCESS
    return Rung(
        value=value,
        status=Status.FAIL if wrong else Status.PASS,
        reason="beyond its stated error of an independent answer" if wrong else "",
        digits=shared_digits(list(repeated(method, scene, plan.quantity))),
        iterations=answer.cost.counters.get("iterations"),
        residuals=residuals | {_OWN_ERROR: stated},
    )


def _beside_the_fast_method(method: Method, answer: Solution, quantity: str) -> dict[str, float]:
    """Distance of the quantity from MDR beyond what that states; nothing where MDR refuses the scene or is asked."""
    fast = build(_FAST, {})
    if method == fast:
        return {}
    try:
        other = fast.solve(answer.scene)
    except ContactError:
        return {}
    found, expected = (np.atleast_1d(getattr(path, quantity)) for path in (answer, other))
    distance = np.max(np.abs(found - expected) / np.maximum(np.abs(found), np.abs(expected)))
    return {"fast method": max(float(distance) - _stated(other, quantity), 0.0)}


def _stated(answer: Solution, quantity: str) -> float:
    """The largest relative error the method states for the quantity; zero where it states none."""
    return float(np.max(answer.error_estimate.get(quantity, np.zeros(1))))


def breakdown(ladder: Ladder) -> float | None:
    """The first value that was refused or failed; None if the whole ladder was climbed."""
    return next((rung.value for rung in ladder.rungs if rung.status is not Status.PASS), None)


def fewest_digits(ladder: Ladder) -> float | None:
    """The fewest digits of a rung that was climbed; None if none was."""
    return min((rung.digits for rung in ladder.rungs if rung.digits is not None), default=None)


def worsened(ladder: Ladder, baseline: Ladder) -> list[str]:
    """What is worse than an accepted ladder: an earlier breakdown, a digit lost on a rung, or a rung not walked."""
    walked = {rung.value: rung for rung in ladder.rungs}
    found = []
    for before in baseline.rungs:
        if before.digits is None:
            continue
        rung = walked.get(before.value, _not_walked(before.value))
        place = f"{ladder.name}, {ladder.method}, {ladder.parameter} = {rung.value:g}"
        if rung.digits is None:
            found.append(f"{place}: {rung.reason or rung.status}, but {before.digits:.1f} digits were accepted")
        elif rung.digits < before.digits - 1.0:
            found.append(f"{place}: {rung.digits:.1f} digits, but {before.digits:.1f} were accepted")
    return found


def _not_walked(value: float) -> Rung:
    return Rung(value=value, status=Status.INVALID, reason="not walked", digits=None)

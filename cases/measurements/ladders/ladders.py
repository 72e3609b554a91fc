"""A hard parameter walked in steps until something breaks: digits, iterations and invariant residuals of each rung."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from cases.declare.methods import build
from cases.declare.quantities import values_of
from cases.measurements.driver import measured
from cases.measurements.ladders.invariants import invariant_residuals
from cases.measurements.ladders.repeats import digits_of, relative_spread, repeated
from cases.measurements.measurement import Measurement
from cases.results.records.reliability import Ladder, Rung
from cases.results.status import Status
from contact import ContactError, Method, Scene, Solution

_OWN_ERROR = "stated error"
_REPEATS = "spread of repeats"
_JUDGES = ("second opinion", "fast method")  # residuals that may not exceed the stated error
_FAST = "mdr"
# Largest excess of an invariant residual over the stated error: rounding of the check itself.
_LARGEST_EXCESS = 1e-12


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
    return Ladder(
        name=plan.name,
        parameter=plan.parameter,
        unit=plan.unit,
        method=label or method.name,
        quantity=plan.quantity,
        rungs=tuple(_rung(value, rung_rows(plan, plan.method(method, value), value)) for value in plan.values),
    )


def rung_rows(plan: LadderPlan, method: Method, value: float) -> list[Measurement]:
    """One rung measured: the answer, the spread of its repeats, and every residual."""
    of = Measurement(method=method.name, scene=plan.name, parameters={plan.parameter: value})
    return measured(lambda: method.solve(plan.scene(value)), partial(_judged, plan.quantity, method), of=of)


def _judged(quantity: str, method: Method, answer: Solution) -> Iterator[Measurement]:
    """Only distances from other answers can break the rung; digits and laws of mechanics are shown."""
    stated = _stated(answer, quantity)
    residuals = invariant_residuals(method, answer) | _beside_the_fast_method(method, answer, quantity)
    for name, residual in residuals.items():
        allowed = stated if name in _JUDGES else math.inf
        yield Measurement(
            method=method.name, quantity=name, error=residual, stated=allowed, uncertainty=_LARGEST_EXCESS
        )
    spread = relative_spread(list(repeated(method, answer.scene, quantity)))
    yield Measurement(method=method.name, quantity=_OWN_ERROR, error=stated, stated=math.inf)
    yield Measurement(method=method.name, quantity=_REPEATS, error=spread, stated=math.inf)


def _rung(value: float, rows: list[Measurement]) -> Rung:
    whole, *found = rows
    if whole.status is not Status.PASS:
        crash = "crash: " if whole.status is Status.FAIL else ""
        return Rung(value=value, status=whole.status, reason=crash + whole.reason, digits=None)
    wrong = not all(row.holds for row in found)
    residuals = {row.quantity: row.error for row in found}
    return Rung(
        value=value,
        status=Status.FAIL if wrong else Status.PASS,
        reason="beyond its stated error of an independent answer" if wrong else "",
        digits=digits_of(residuals.pop(_REPEATS)),
        iterations=whole.counters.get("iterations"),
        residuals=residuals,
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
    found, expected = (values_of(path, quantity) for path in (answer, other))
    distance = np.max(np.abs(found - expected) / np.maximum(np.abs(found), np.abs(expected)))
    return {"fast method": max(float(distance) - _stated(other, quantity), 0.0)}


def _stated(answer: Solution, quantity: str) -> float:
    """The largest relative error the method states for the quantity; zero where it states none."""
    return float(np.max(answer.error_estimate.get(quantity, np.zeros(1))))

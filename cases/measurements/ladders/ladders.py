"""A stress test: a parameter made harder step by step, with the digits and the residuals of laws at each step."""

import warnings
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cases.declare.methods import build
from cases.declare.quantities import values_of
from cases.measurements.ladders.invariants import invariant_residuals
from cases.measurements.ladders.repeats import digits_of, relative_spread, repeated
from cases.studies import Step, StressTest
from cases.verdicts import Status
from contact import ContactError, Method, Scene, Solution

NAME = "stability"
_FAST = "mdr"
# Largest excess of a distance from MDR over both stated errors: rounding of the comparison itself.
_LARGEST_EXCESS = 1e-12


@dataclass(frozen=True, kw_only=True)
class LadderPlan:
    """A stress test: its parameter, and the scene for each value.

    Attributes:
        name: Unique.
        parameter: The parameter that is made harder, with its symbol.
        unit: "1" for a ratio.
        values: From easy to hard.
        scene: The scene of a value.
        quantity: Whose last value is followed.
        method: The method of a step, made from the method under test; by default that method itself.
        only: Names of methods that are tested; empty means all.
        spared: Names of methods that would take minutes for a step.
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


def climb(plan: LadderPlan, method: Method, label: str | None = None) -> StressTest:
    """Return all steps; one that is refused does not stop the test, so that a hole in the middle is seen."""
    return StressTest(
        case=NAME,
        name=plan.name,
        parameter=plan.parameter,
        unit=plan.unit,
        method=label or method.name,
        quantity=plan.quantity,
        steps=tuple(_step(plan, plan.method(method, value), value) for value in plan.values),
    )


def _step(plan: LadderPlan, method: Method, value: float) -> Step:
    """One step: correct digits from repeated answers, and residuals of laws; a warning counts as a crash."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            answer = method.solve(plan.scene(value))
            residuals = invariant_residuals(method, answer)
            distance = _beside_the_fast_method(method, answer, plan.quantity)
            spread = relative_spread(list(repeated(method, answer.scene, plan.quantity)))
    except ContactError as error:
        return _without_digits(value, Status.INVALID, f"{type(error).__name__}: {error!s:.300}")
    except Exception as error:
        # Only the errors of `contact` count as a refusal.
        return _without_digits(value, Status.FAIL, f"crash: {type(error).__name__}: {error!s:.300}")
    wrong = distance > _stated(answer, plan.quantity) + _LARGEST_EXCESS
    return Step(
        value=value,
        status=Status.FAIL if wrong else Status.PASS,
        reason=f"differs from MDR by {distance:.1e}, more than both state" if wrong else "",
        digits=digits_of(spread),
        residuals={**residuals, "fast method": distance},
    )


def _without_digits(value: float, status: Status, reason: str) -> Step:
    return Step(value=value, status=status, reason=reason, digits=None)


def _beside_the_fast_method(method: Method, answer: Solution, quantity: str) -> float:
    """max(0, |q - q_MDR|/q - error stated by MDR); zero if MDR refuses the scene, or is the method itself."""
    fast = build(_FAST, {})
    if method == fast:
        return 0.0
    try:
        other = fast.solve(answer.scene)
    except ContactError:
        return 0.0
    values, expected = (values_of(path, quantity) for path in (answer, other))
    distance = np.max(np.abs(values - expected) / np.maximum(np.abs(values), np.abs(expected)))
    return max(float(distance) - _stated(other, quantity), 0.0)


def _stated(answer: Solution, quantity: str) -> float:
    """The largest relative error the method states for the quantity; zero where it states none."""
    return float(np.max(answer.error_estimate.get(quantity, np.zeros(1))))

"""Stress tests: one parameter is made harder step by step until a method stops with an error."""

import math
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, ClassVar, Final

import numpy as np
from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]  # ships no types

from cases.answers import Answer, Table, Values
from cases.case import Case, Task
from cases.claims import Study
from cases.declare.methods import MethodUse, build
from cases.declare.quantities import values_of
from cases.rules import judge_residual
from cases.studies import Step, StressTest
from cases.units import Units, in_units, with_numbers
from cases.verdicts import Kind, Origin, Status, Verdict, Why
from contact import (
    ContactError,
    ContactPath,
    ContactRadii,
    DepthFunction,
    FlatPunch,
    ImpactHistory,
    IndentationDepths,
    Layer,
    Method,
    NormalForces,
    Scene,
    Solution,
)
from contact.records.validation import FloatArray

WHY = Why(
    Origin.INDEPENDENT_METHOD,
    "laws of mechanics, repeats, and the fast method",
    "a method may refuse a scene with a reason, but a number it gives has to lie within the error it states",
    "half a step: no step may fail",
)
DIGITS: Final = "digits"
# Number of repeats with inputs one rounding away: with one alone, digits may agree by chance.
NUDGES: Final = 3
DOUBLE_DIGITS: Final = -math.log10(2.0**-53)
# Largest excess of a distance from MDR over both stated errors: rounding of the comparison itself.
LARGEST_EXCESS: Final = 1e-12
# Factors to other units that are no powers of two: mantissas and roundings differ.
OTHER_UNITS: Final = Units(length=1e-3, stress=1e-6, time=1e-3)
# Nodes of the integral of a pressure: half as many have a relative error of 1e-12 under a cone.
POINTS: Final = 400
# Largest a/h up to which methods on flat-punch data give pressures.
PRESSURE_REACH: Final = 160.0


@dataclass(frozen=True, kw_only=True)
class Ladder(Study):
    """A stress test: no step may fail silently. The step where a method stops and the correct digits are recorded.

    Attributes:
        name: Name of the test, unique.
        parameter: Name of the parameter that is made harder, with its symbol.
        values: Values of the parameter from easy to hard.
        scene: Function that returns the scene of a value.
        quantity: Quantity whose last value is followed.
        setting: Setting of the method that gets the value; "" if the scene alone depends on it.
        methods: Labels of the methods under test; empty for all of the case.
        quick: Whether the suite ci makes the test, by MDR alone.
    """

    kind: ClassVar[str] = "stress test"

    parameter: str
    values: tuple[float, ...]
    scene: Callable[[float], Scene[Any, Any]]
    quantity: str = "normal_force"
    setting: str = ""
    methods: tuple[str, ...] = ()
    quick: bool = False

    def in_suite(self, suite: str) -> "Ladder | None":
        """Return the test as a suite runs it, or None."""
        if suite != "ci":
            return self
        return replace(self, methods=("mdr",)) if self.quick else None

    def tasks(self, case: Case) -> Iterator[Task]:
        """Yield every step by every method."""
        for use in self._uses(case):
            yield from self._steps(case, use)

    def _uses(self, case: Case) -> Iterator[MethodUse]:
        yield from (use for use in case.methods if not self.methods or use.label in self.methods)

    def _steps(self, case: Case, use: MethodUse) -> Iterator[Task]:
        """Yield the tasks of a method, one per value of the parameter."""
        measure = partial(measured, quantity=self.quantity)
        for value in self.values:
            settings = {**use.settings, self.setting: value} if self.setting else use.settings
            yield Task(
                case=case.name,
                scene=self.name,
                variant=f"{self.parameter} = {value:.12g}",
                use=replace(use, settings=settings),
                problem=self.scene(value),
                measure=measure,
            )

    def judge(self, case: Case, answers: Table) -> Iterator[Verdict]:
        """Judge that every step was answered or refused with a reason."""
        for test in self.records(case, answers):
            yield no_silent_failure(test)

    def records(self, case: Case, answers: Table) -> Iterator[StressTest]:
        """Yield the test by each method that supports its first scene.

        A step that is refused does not end the test, so that a hole in the middle is seen.
        """
        for use in self._uses(case):
            step_answers = [
                answer for task in self._steps(case, use) if (answer := answers.get(task.identity)) is not None
            ]
            if len(step_answers) == len(self.values) and step_answers[0].status is not Status.SKIP:
                yield StressTest(
                    case=case.name,
                    name=self.name,
                    parameter=self.parameter,
                    unit="1",
                    method=use.label,
                    quantity=self.quantity,
                    steps=tuple(map(_step, self.values, step_answers)),
                )


def _step(value: float, answer: Answer) -> Step:
    """The step of a stress test with one value of the parameter, from its answer."""
    numbers = {name: q.values[0] for name, q in answer.quantities.items()}
    status = Status.INVALID if answer.status is Status.SKIP else answer.status
    return Step(value=value, status=status, reason=answer.reason, digits=numbers.pop(DIGITS, None), residuals=numbers)


def breakdown(test: StressTest) -> Step | None:
    """Return the first step that was refused or failed; None if all were answered."""
    return next((step for step in test.steps if step.status != Status.PASS), None)


def summary(test: StressTest) -> str:
    """Return one line: where it stops and how many digits are left."""
    stop = breakdown(test)
    end = "answered to the end" if stop is None else f"stops at {test.parameter} = {stop.value:g}"
    fewest = min((step.digits for step in test.steps if step.digits is not None), default=0.0)
    return f"{test.name}, {test.method}: {end}, at least {fewest:.1f} digits"


def no_silent_failure(test: StressTest) -> Verdict:
    """Return the verdict that every step was answered or refused with a reason; its error is the number of others."""
    failed = [step for step in test.steps if step.status == Status.FAIL]
    worst = f"; {test.parameter} = {failed[0].value:g}: {failed[0].reason}" if failed else ""
    judged = judge_residual(float(len(failed)), tolerance=0.5)
    return Verdict(
        case=test.case,
        claim="no silent failure",
        kind=Kind.INVARIANT,
        scene=test.name,
        methods=(test.method,),
        quantity=test.quantity,
        expected=0.0,
        tolerance=0.5,
        why=WHY,
        **vars(replace(judged, message=summary(test) + worst)),
    )


def worse_than(test: StressTest, accepted: StressTest) -> list[str]:
    """Return the steps that are worse than accepted: refused, not solved, or with one correct digit less."""
    steps = {step.value: step for step in test.steps}
    worse = []
    for before in accepted.steps:
        if before.digits is None:
            continue
        step = steps.get(
            before.value, Step(value=before.value, status=Status.INVALID, reason="not solved", digits=None)
        )
        place = f"{test.name}, {test.method}, {test.parameter} = {step.value:g}"
        if step.digits is None:
            worse.append(f"{place}: {step.reason or step.status}, but {before.digits:.1f} digits were accepted")
        elif step.digits < before.digits - 1.0:
            worse.append(f"{place}: {step.digits:.1f} digits, but {before.digits:.1f} were accepted")
    return worse


# -- one step ---------------------------------------------------------------------------------------------------------
def measured(method: Method, scene: Scene, quantity: str) -> dict[str, Any]:
    """Return fields of an `Answer`: status, reason, and as quantities the shared digits and residuals of a step.

    A warning counts as a crash.
    """
    if not method.supports(scene):
        return {"status": Status.SKIP, "reason": str(getattr(method.supports(scene), "reason", "not supported"))}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            answer = method.solve(scene)
            residuals = invariant_residuals(method, answer)
            distance = distance_from_mdr(method, answer, quantity)
            digits = digits_of(relative_spread(list(repeated(method, answer.scene, quantity))))
    except ContactError as error:
        return {"status": Status.INVALID, "reason": f"{type(error).__name__}: {error!s:.300}"}
    except Exception as error:
        # Only the errors of `contact` count as a refusal.
        return {"status": Status.FAIL, "reason": f"crash: {type(error).__name__}: {error!s:.300}"}
    wrong = distance > _stated(answer, quantity) + LARGEST_EXCESS
    numbers = {DIGITS: digits, **residuals, "fast method": distance}
    return {
        "status": Status.FAIL if wrong else Status.PASS,
        "reason": f"differs from MDR by {distance:.1e}, more than both state" if wrong else "",
        "quantities": {name: Values(unit="1", scale=1.0, values=(value,)) for name, value in numbers.items()},
    }


def distance_from_mdr(method: Method, answer: Solution, quantity: str) -> float:
    """max(0, |q - q_MDR|/q - error stated by MDR); zero if MDR refuses the scene, or is the method itself."""
    fast = build("mdr", {})
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


# -- repeats ----------------------------------------------------------------------------------------------------------
def repeated(method: Method, scene: Scene, quantity: str) -> Iterator[float]:
    """Yield the last value of a quantity from repeated solutions.

    The scene itself; with every input changed by one unit in the last place at random; in other units; with other steps
    before the last; on two threads.
    """

    def last(problem: Scene) -> float:
        return float(values_of(method.solve(problem), quantity)[-1])

    yield last(scene)
    for seed in range(NUDGES):
        yield last(nudged(scene, np.random.default_rng(seed)))
    yield last(in_units(scene, OTHER_UNITS)) / OTHER_UNITS.factor(quantity)
    if (with_other_steps := amid_other_steps(scene)) is not None:
        yield last(with_other_steps)
    with threadpool_limits(2):
        yield last(scene)


def relative_spread(values: Sequence[float]) -> float:
    """Largest distance from the median over the median; zero where all agree."""
    middle = float(np.median(values))
    spread = float(np.max(np.abs(np.asarray(values) - middle)))
    return 0.0 if spread == 0.0 else spread / abs(middle) if middle else math.inf


def digits_of(spread: float) -> float:
    """Significant digits that values with this relative spread share, at most those of double precision."""
    return float(np.clip(-np.log10(spread), 0.0, DOUBLE_DIGITS)) if spread else DOUBLE_DIGITS


def nudged(scene: Scene, draw: np.random.Generator) -> Scene:
    """The scene with each number changed at random by -1, 0 or 1 unit in the last place; functions of depth stay."""
    return with_numbers(scene, lambda _, name, value: _one_ulp(name, value, draw))


def _one_ulp(name: str, value: Any, draw: np.random.Generator) -> Any:
    """The value changed at random by -1, 0 or 1 unit in the last place."""
    if isinstance(value, DepthFunction):
        return value
    steps = draw.integers(-1, 2, np.shape(value))
    changed = np.where(steps == 0, value, np.nextafter(value, np.where(steps > 0, np.inf, -np.inf)))
    # Zero has no last place.
    changed = np.where(np.asarray(value) == 0.0, value, changed)
    if name == "poissons_ratio":
        # Exactly incompressible is another problem.
        return float(min(float(changed), 0.5)) if value != 0.5 else 0.5
    return changed if isinstance(value, np.ndarray) else float(changed)


def amid_other_steps(scene: Scene) -> Scene | None:
    """The scene with other steps before its last one; None where steps are not independent."""
    loading = scene.loading
    if isinstance(loading, ContactRadii):
        flat, last = scene.indenter.flat_radius, float(loading.values[-1])
        return scene.replace(loading=ContactRadii(values=flat + (last - flat) * np.array([0.3, 0.8, 1.0])))
    if isinstance(loading, IndentationDepths | NormalForces):
        values = np.array([0.4, 1.0, 0.7, 1.0]) * loading.values[-1]
        return scene.replace(loading=type(loading)(values=values))
    return None


# -- laws of mechanics: relative residuals, zero for an exact answer of any method -------------------------------------
def invariant_residuals(method: Method, answer: Solution) -> dict[str, float]:
    """The residual of each law that applies to the answer, by name."""
    residuals = {name: law(method, answer) for name, law in LAWS.items()}
    return {name: residual for name, residual in residuals.items() if residual is not None}


def stiffer_layer(method: Method, answer: Solution) -> float | None:
    """Residual of F(2 E) = 2 F(E) at the same radii or depths."""
    if not isinstance(answer, ContactPath):
        return None
    twice = in_units(answer.scene, Units(stress=2.0))
    return _distance(values_of(method.solve(twice), "normal_force"), 2.0 * answer.normal_force)


def unbonded_layer_is_independent_of_nu(method: Method, answer: Solution) -> float | None:
    """Relative difference of the forces on unbonded layers with another nu and the same E*."""
    layer = answer.scene.layer
    if not isinstance(answer, ContactPath) or not layer.is_uniform or layer.is_half_space or layer.support == "bonded":
        return None
    nu = 0.1 if layer.poissons_ratio > 0.2 else 0.4
    modulus = layer.contact_modulus * (1 - nu**2)
    other = Layer(thickness=layer.thickness, youngs_modulus=modulus, poissons_ratio=nu, support="unbonded")
    other_answer = method.solve(answer.scene.replace(layer=other))
    return _distance(values_of(other_answer, "normal_force"), answer.normal_force)


def pressure_carries_the_load(method: Method, answer: Solution) -> float | None:
    """Residual of F = 2 pi int p r dr, by the midpoint rule in r = a sin(theta): spectral with a root at the edge."""
    if not isinstance(answer, ContactPath) or not _pressure_is_known(answer) or answer.scene.indenter.breakpoints:
        return None
    a = float(answer.contact_radius[-1])
    theta = (np.arange(POINTS) + 0.5) * 0.5 * np.pi / POINTS
    p = answer.pressure(a * np.sin(theta), step=len(answer) - 1)
    force = 2 * np.pi * a**2 * float(p @ (np.sin(theta) * np.cos(theta))) * 0.5 * np.pi / POINTS
    return abs(force / float(answer.normal_force[-1]) - 1.0)


def pressure_presses(method: Method, answer: Solution) -> float | None:
    """Largest tension over the largest pressure, which vanishes without adhesion."""
    if not isinstance(answer, ContactPath) or not _pressure_is_known(answer) or answer.scene.effects:
        return None
    # The pressure under a flat punch is singular at the edge.
    if isinstance(answer.scene.indenter, FlatPunch):
        return None
    # Irrational radii avoid the tip of a cone and kinks.
    rho = np.sqrt(np.arange(1, 50) / 50.3)
    p = answer.pressure(float(answer.contact_radius[-1]) * rho, step=len(answer) - 1)
    return float(max(-p.min(), 0.0) / p.max())


def energy_is_conserved(method: Method, answer: Solution) -> float | None:
    """Residual of the conservation of kinetic + stored + dissipated energy."""
    return answer.energy_residual if isinstance(answer, ImpactHistory) else None


def restitution_is_below_one(method: Method, answer: Solution) -> float | None:
    """Distance of the coefficient of restitution from [0, 1]."""
    if not isinstance(answer, ImpactHistory):
        return None
    return max(answer.coefficient_of_restitution - 1.0, -answer.coefficient_of_restitution, 0.0)


def _pressure_is_known(answer: ContactPath) -> bool:
    reach = PRESSURE_REACH * answer.scene.layer.surface.thickness
    return answer.fields is not None and bool(answer.contact_radius[-1] <= reach)


def _distance(values: FloatArray, expected: FloatArray) -> float:
    return float(np.max(np.abs(values - expected)) / np.max(np.abs(expected)))


LAWS: Mapping[str, Callable[[Method, Solution], float | None]] = {
    "twice the modulus": stiffer_layer,
    "unbonded does not see nu": unbonded_layer_is_independent_of_nu,
    "pressure carries the load": pressure_carries_the_load,
    "no tension": pressure_presses,
    "energy": energy_is_conserved,
    "restitution in (0, 1]": restitution_is_below_one,
}

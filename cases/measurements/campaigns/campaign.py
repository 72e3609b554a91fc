"""Random scenes by the thousand: every answer within its stated error of an independent one, or a named refusal.

The referee of elastic scenes is `referee` as far as it reaches; beyond a/h = 100, where it is costly, the method
with half the discretisation length checks every eighth scene. Depth histories of viscoelastic layers are followed
spring by spring, and by the refined method, which is closer and knows radii; what the fast method says of forces in
time, in closed form where it can, is stepped in time. For other loadings the refined method checks every scene, or
another method does. Every solved scene is also solved in other units, where it must give the same answer, contacts by
another of radius, depth and force, and relaxation written down in other ways.
"""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cases.declare.quantities import IMPACT_NUMBERS, single_numbers, values_of
from cases.measurements.campaigns.random_scenes import RATIO, Family, scene_of
from cases.measurements.campaigns.referee import LARGEST_RATIO, adhesive_states, second_opinion
from cases.measurements.campaigns.restated import changes_when_restated
from cases.measurements.campaigns.spring_by_spring import spring_by_spring, stepped_in_time
from cases.measurements.campaigns.units import Units, in_units
from cases.measurements.driver import measured
from cases.measurements.measurement import RESTATED, Measurement
from contact import (
    ContactError,
    ContactPath,
    ContactRadii,
    DepthHistory,
    DetachmentPath,
    FlatPunch,
    ForceHistory,
    HistoryPath,
    ImpactHistory,
    IndentationDepths,
    Loading,
    Method,
    NormalForces,
    NotConvergedError,
    Scene,
    Solution,
)
from contact.records.validation import FloatArray
from contact.scene.effects import Viscoelasticity

OTHER_UNITS = Units(length=2.0**17, stress=2.0**-23, time=2.0**11)
_MOTION = ("indentation_depth", "normal_force")
# The same scene in other units differs by roundings of powers and logarithms only.
UNITS_AGREEMENT = 1e-12

# How far a depth history may change, relative to its largest force, when its scene is written down in another way.
# Nothing iterates there, so only rounding changes: 8e-15 at most in 150 histories (seed 3, measured 2026-11-22).
RESTATED_AGREEMENT = 1e-12
# A few operations round, also what was prescribed.
_ROUNDING = 64 * float(np.finfo(float).eps)
# One thin layer in so many is refined.
_THIN_LAYERS_REFINED = 8
_STATES_OF_A_BRANCH = 5
_ALL = slice(None)
# A quantity without a stated error still may not be this far off.
_UNLISTED_MOST = 1e-2
# Sharpness is asked for where the relative true error is above this: below, roundings decide how large an error is.
HUNDRED_ROUNDINGS = 100 * float(np.finfo(float).eps)


def campaign(
    method: Method,
    *,
    seed: int,
    count: int,
    family: Family = "elastic",
    ratio: tuple[float, float] = RATIO,
    numbers: Iterable[int] | None = None,
    referee: Method | None = None,
    other_units: bool = True,
) -> list[Measurement]:
    """Draw scenes, let the method answer, and check each answer.

    Args:
        method: Who answers.
        seed: Of the scenes.
        count: How many scenes.
        family: Kind of scenes.
        ratio: Range of a/h.
        numbers: Only these of the scenes; all if None.
        referee: Another method that checks what the second opinion cannot; the refined method itself if None.
        other_units: Whether each scene is solved in other units as well.
    """
    chosen = ((n, scene_of(seed, n, family, ratio)) for n in (range(count) if numbers is None else numbers))
    of = Measurement(method=method.name, parameters={"family": family}, seed=seed)
    return list(answered(method, chosen, partial(_judged, method, other=referee, restated=other_units), of))


def answered(
    method: Method,
    scenes: Iterable[tuple[int, Scene]],
    judge: Callable[..., Iterable[Measurement]],
    of: Measurement,
) -> Iterator[Measurement]:
    """Rows of numbered scenes, each answered and judged by its number.

    Args:
        method: Who answers.
        scenes: Their numbers, and the scenes.
        judge: Compares an answer to the scene of a number, which is its keyword `number`.
        of: What all rows share.
    """
    for n, scene in scenes:
        yield from measured(partial(method.solve, scene), partial(judge, number=n), of=replace(of, scene=f"{n}"))


def _judged(
    method: Method, answer: Solution, *, number: int, other: Method | None, restated: bool
) -> list[Measurement]:
    """Rows of the best referee there is and, if wanted, of the same scene restated."""
    again = _restated(method, answer) if restated else ()
    return [*refereed(method, answer, number, other), *(replace(row, reference=RESTATED) for row in again)]


def refereed(method: Method, answer: Solution, number: int, other: Method | None) -> Iterator[Measurement]:
    """Rows of the best referee there is, none of thin layers that are not looked at.

    Args:
        method: Who answered.
        answer: The answer.
        number: Of the scene.
        other: Another method that checks what the second opinion cannot; the refined method itself if None.
    """
    scene = answer.scene
    if isinstance(answer, ContactPath) and not scene.effects:
        if answer.contact_radius.max() <= LARGEST_RATIO * scene.layer.thickness:
            yield from against_second_opinion(answer)
            return
        if number % _THIN_LAYERS_REFINED:
            return
    if other is None and isinstance(answer, HistoryPath) and _is_followed_by_springs(scene):
        yield _against_springs(answer)
    if isinstance(answer, DetachmentPath):
        yield from _branch_checks(answer)
    in_steps = _is_stepped_by_springs(answer)
    try:
        finer = stepped_in_time(scene) if in_steps else (other or method.refined()).solve(scene)
    except NotConvergedError:
        return
    alike = "steps in time" if in_steps else "refinement"
    reference = "another method" if not in_steps and other is not None and other.name != method.name else alike
    for q in _comparable(answer, finer):
        if q in answer.error_estimate:
            allowance = np.atleast_1d(finer.error_estimate.get(q, 0.0))
            yield _check(answer, q, values_of(finer, q), allowance, reference=reference)


def against_second_opinion(answer: ContactPath) -> Iterator[Measurement]:
    """Radius, depth, force and stiffness of elastic contacts against the integral equation of their own."""
    opinion = second_opinion(answer)
    for quantity, value in opinion.values.items():
        yield _check(answer, quantity, value, opinion.uncertainty, reference="second opinion")


def _is_followed_by_springs(scene: Scene) -> bool:
    return isinstance(scene.loading, DepthHistory) and scene.effect(Viscoelasticity) is not None


def _is_stepped_by_springs(answer: Solution) -> bool:
    return answer.method == "mdr" and isinstance(answer.scene.loading, ForceHistory)


def _against_springs(answer: HistoryPath) -> Measurement:
    """The force at its worst instant."""
    opinion = spring_by_spring(answer.scene, float(answer.contact_radius.max()))
    allowance = np.full(answer.normal_force.shape, opinion.uncertainty) / _scale(answer, "normal_force")
    return _check(answer, "normal_force", opinion.force, allowance, reference="spring by spring")


def _branch_checks(answer: DetachmentPath) -> tuple[Measurement, ...]:
    """Some states of a branch, as far as the second opinion reaches, each at its own contact radius."""
    scene = answer.scene
    # Before the last state of the first radius a punch's front is held.
    first = np.flatnonzero(answer.contact_radius == answer.contact_radius[0])[-1]
    chosen = np.linspace(first, len(answer.contact_radius) - 1, _STATES_OF_A_BRANCH).round().astype(int)
    radii = answer.contact_radius[chosen]
    if np.max(radii) > LARGEST_RATIO * scene.layer.thickness or np.min(radii) <= 0:
        return ()
    opinion = adhesive_states(scene, radii)
    return tuple(
        _check(answer, quantity, value, opinion.uncertainty, chosen, reference="second opinion")
        for quantity, value in opinion.values.items()
    )


def _comparable(answer: Solution, other: Solution) -> tuple[str, ...]:
    """Quantities of two answers that stand for the same states; an impact's samples lie where its steps fall."""
    # States of two branches lie at different radii.
    if isinstance(answer, ImpactHistory | DetachmentPath):
        return single_numbers(answer)
    # Its contact radius jumps where contact is lost.
    if isinstance(answer, HistoryPath):
        same = isinstance(other, HistoryPath) and np.array_equal(answer.time, other.time)
        return tuple(answer.error_estimate) if same else ()
    names = (*answer.ARRAYS, *answer.SCALARS)
    return tuple(q for q in names if np.shape(getattr(other, q)) == np.shape(getattr(answer, q)))


def _check(
    answer: Solution,
    quantity: str,
    expected: FloatArray,
    allowance: FloatArray,
    chosen: NDArray[np.intp] | slice = _ALL,
    *,
    reference: str,
) -> Measurement:
    """The step, among those chosen, with the largest excess of distance over what is allowed."""
    scale = np.maximum(answer.scale(quantity), np.finfo(float).tiny)
    values = values_of(answer, quantity)
    error = np.abs(values[chosen] - expected) / np.broadcast_to(scale, values.shape)[chosen]
    stated = _fitted(answer.error_estimate.get(quantity, np.array(_UNLISTED_MOST)), values.shape)[chosen]
    allowance = _fitted(np.maximum(allowance, _ROUNDING), error.shape)
    worst = int(np.argmax(error - stated - allowance))
    return Measurement(
        method=answer.method,
        quantity=quantity,
        reference=reference,
        error=float(error[worst]),
        stated=float(stated[worst]),
        uncertainty=float(allowance[worst]),
        sharpness=_sharpness(error, stated, allowance),
    )


def _sharpness(error: FloatArray, stated: FloatArray, allowance: FloatArray) -> float | None:
    """Stated over true error at the step with the largest true error that can be told."""
    told = np.where(error > np.maximum(allowance, HUNDRED_ROUNDINGS), error, 0.0)
    largest = int(np.argmax(told))
    return float(stated[largest] / error[largest]) if told[largest] > 0.0 else None


def _fitted(values: FloatArray, shape: tuple[int, ...]) -> FloatArray:
    """One value for each entry; a scalar that has errors along a whole path gets the largest."""
    return np.array(values) if np.shape(values) == shape else np.full(shape, np.max(values))


def _restated(method: Method, answer: Solution) -> tuple[Measurement, ...]:
    """The same scene in other units and, where there is relaxation, with that written down in other ways."""
    elsewhere = _in_other_units(method, answer) + _asked_otherwise(method, answer)
    if not isinstance(answer, HistoryPath | ImpactHistory) or answer.scene.effect(Viscoelasticity) is None:
        return elsewhere
    quantities = IMPACT_NUMBERS if isinstance(answer, ImpactHistory) else _MOTION
    exact = isinstance(answer.scene.loading, DepthHistory)
    found = changes_when_restated(method, answer, quantities)
    allowed = 0.0 if exact else 2.0 * max(_largest_stated(answer, quantity) for quantity in quantities)
    return elsewhere + tuple(
        Measurement(method=answer.method, quantity=name, error=change, stated=RESTATED_AGREEMENT, uncertainty=allowed)
        for name, change in found.items()
    )


def _in_other_units(method: Method, answer: Solution) -> tuple[Measurement, ...]:
    """The same scene with lengths, stresses and times in other units.

    Roundings differ there, and each of the two answers may miss the true one by what it states: they may be twice as
    far apart. That either is near the truth is what the referee checks.
    """
    other = method.solve(in_units(answer.scene, OTHER_UNITS))
    return tuple(
        Measurement(
            method=answer.method,
            quantity=f"{q} in other units",
            error=float(
                np.max(np.abs(values_of(answer, q) - values_of(other, q) / OTHER_UNITS.factor(q)) / _scale(answer, q))
            ),
            stated=UNITS_AGREEMENT,
            uncertainty=_largest_stated(answer, q) + _largest_stated(other, q),
        )
        for q in _comparable(answer, other)
    )


def _asked_otherwise(method: Method, answer: Solution) -> tuple[Measurement, ...]:
    """The same contacts prescribed by what was answered: depths for radii, forces for depths, radii for forces.

    What is prescribed then errs as the answer states, and depth, force and radius follow each other with powers up to
    two. A rounded radius tells little where the contact has hardly left a flat end or has a sphere's equator close by.

    Raises:
        RuntimeError: If the method refuses what it has answered.
    """
    if not isinstance(answer, ContactPath) or answer.scene.effects:
        return ()
    try:
        loading, order = _other_loading(answer)
        other = method.solve(answer.scene.replace(loading=loading))
    except ContactError as refusal:
        raise RuntimeError(f"answered, but refused if asked for otherwise: {refusal}") from refusal
    assert isinstance(other, ContactPath)
    indenter, a = answer.scene.indenter, other.contact_radius
    told = np.minimum(a - indenter.flat_radius, indenter.max_radius - a if indenter.ends_upright else np.inf)
    rounding = float(np.max(_ROUNDING * np.divide(a, told, out=np.ones_like(a), where=told > 0.0)))
    return tuple(
        Measurement(
            method=answer.method,
            quantity=f"{q} asked for otherwise",
            error=float(np.max(np.abs(values_of(answer, q) - values_of(other, q)[order]) / _scale(answer, q))),
            stated=UNITS_AGREEMENT,
            uncertainty=rounding
            + 2.0 * max(_largest_stated(one, name) for one in (answer, other) for name in answer.ARRAYS),
        )
        for q in answer.ARRAYS
    )


def _other_loading(answer: ContactPath) -> tuple[Loading, NDArray[np.intp] | slice]:
    """Another way to prescribe the same contacts, and where they stand then; a flat punch has no other radius."""
    if isinstance(answer.scene.loading, IndentationDepths):
        return NormalForces(answer.normal_force), _ALL
    if isinstance(answer.scene.loading, ContactRadii) or isinstance(answer.scene.indenter, FlatPunch):
        return IndentationDepths(answer.indentation_depth), _ALL
    radii, order = np.unique(answer.contact_radius, return_inverse=True)
    return ContactRadii(radii), order


def _largest_stated(answer: Solution, quantity: str) -> float:
    """The error stated for the quantity or, where none is, the largest stated for any."""
    stated = answer.error_estimate.get(quantity)
    found = answer.error_estimate.values() if stated is None else [stated]
    return max((float(np.max(error)) for error in found), default=0.0)


def _scale(answer: Solution, quantity: str) -> FloatArray:
    return np.maximum(answer.scale(quantity), np.finfo(float).tiny)

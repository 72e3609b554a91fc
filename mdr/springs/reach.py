"""How far a loading reaches: the equivalent system that covers the largest radius a scene will need.

A stiff film on a soft base carries a small contact by bending, and g falls where the base begins to carry. Several
radii then have one depth. The contact problem without tension has one solution only, so the circle that presses
everywhere inside, and is not touched beside, is the answer (`beyond_falls`); where none does, there is none.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from bem.kernels.moduli import contact_modulus
from bem.layer_equation.protocol import FlatPunchSource, RatioNotCovered
from contact import (
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Loading,
    NormalForces,
    Profile,
    Scene,
    UnsupportedSceneError,
)
from contact.answer.one_circle import refuse_touching
from contact.records.validation import FloatArray
from mdr.radius_search import SeveralContacts
from mdr.springs.assembly import EndsTooSoon, contact_fields, equivalent_system
from mdr.springs.beside_contact import circle_of
from mdr.springs.equivalent_system import LEAST_EXCESS, EquivalentSystem
from mdr.springs.error_model import SPRING_ROUNDING
from mdr.springs.half_space_profile import half_space_profile, is_endless
from mdr.springs.pulling import LEAST_TENSION, OneStep, refuse_pulling

# First trial radius: the half-space's, capped at this a/h, beyond which that is no guide any more; chosen.
FIRST_RATIO = 10.0
# Radii, in units of a length made of the loading, on which the half-space's answer is tabulated: neighbours differ by
# a fifth.
TRIAL_RADII = np.geomspace(1e-12, 1e12, 289)
# A radius that was sketched is tried with so much more beyond the flat end, for what the sketch errs beside rims: of
# 350 first trials one needed more than 2 % (`tests.stacked_scenes`, seeds 5 and 11, 2026-11-22).
BEYOND = 1.05
# Growth of the radius up to which depth or force are sketched; chosen.
SKETCHED = 1.5
# Growth of the trial radius beyond a falling stretch; chosen.
GROWTH = 1.5
_Objection: TypeAlias = SeveralContacts | EndsTooSoon | RatioNotCovered


def covering_system(scene: Scene, flat_punch: FlatPunchSource) -> EquivalentSystem:
    """The equivalent system up to the largest radius under prescribed radii, depths or forces.

    Raises:
        InvalidInput: If the indenter or the flat-punch data end before the loading is reached.
        EndsTooSoon: If the flat-punch data ask for more of the indenter than there is.
        SeveralContacts: If the contact would not be one circle.
    """
    layer, indenter, loading = scene.layer, scene.indenter, scene.loading
    if isinstance(indenter, FlatPunch):
        return equivalent_system(layer, indenter, indenter.radius, flat_punch)
    if isinstance(loading, ContactRadii):
        return equivalent_system(layer, indenter, float(loading.values.max()), flat_punch)
    radius = _first_radius(scene) if layer.is_uniform else _sketched_radius(scene, flat_punch, _first_radius(scene))
    while True:
        system, objection = _up_to(scene, radius, flat_punch)
        reached, wanted = _reached(system, loading)
        if reached >= wanted:
            return system
        if objection is not None:
            raise objection
        if radius >= indenter.max_radius:
            raise InvalidInput(
                f"loading.values = {wanted:g}: the indenter ends at a radius of {radius:g} m, where {reached:g} is "
                "reached; ask for less or describe the indenter further out"
            )
        radius = _next_radius(system, indenter, wanted, reached, isinstance(loading, NormalForces))
        if is_endless(indenter, radius * (1 + SPRING_ROUNDING)):
            raise InvalidInput(f"loading.values = {wanted:g}: {indenter.upright_end}; press less")


def _up_to(scene: Scene, radius: float, flat_punch: FlatPunchSource) -> tuple[EquivalentSystem, _Objection | None]:
    """The system up to this radius, or up to where there is no answer beyond, and that objection."""
    objection: _Objection | None = None
    while True:
        try:
            return equivalent_system(scene.layer, scene.indenter, radius, flat_punch), objection
        except (SeveralContacts, EndsTooSoon, RatioNotCovered) as own:
            covered = scene.layer.surface.thickness * (1 - SPRING_ROUNDING)
            answered = covered * own.largest if isinstance(own, RatioNotCovered) else own.radius
            # Up to a node at which g falls it may fall at another one, which lies elsewhere with the grid.
            if not scene.indenter.flat_radius < answered < radius:
                raise
            objection, radius = objection or own, answered


def _reached(system: EquivalentSystem, loading: Loading) -> tuple[float, float]:
    """What the system's largest radius stands for, and what is wanted."""
    if isinstance(loading, IndentationDepths):
        return float(system.mdr_profile(system.max_radius)), float(loading.values.max())
    if isinstance(loading, NormalForces):
        return float(system.elastic_force(system.max_radius)), float(loading.values.max())
    raise UnsupportedSceneError(f"loading {type(loading).__name__} has no largest contact radius of its own")


def _next_radius(system: EquivalentSystem, indenter: Profile, wanted: float, reached: float, is_force: bool) -> float:
    """Where depth or force are reached if they go on as they do, and a little [m].

    They grow with a power of the radius, and towards an end that stands upright with the logarithm of what is left.
    """
    a, end = system.max_radius, indenter.max_radius
    rise = float(system.mdr_profile_slope(a)) * (float(system.contact_stiffness(a)) if is_force else 1.0)  # Eq. (5)
    further = a * float(np.clip(1.05 * (wanted / reached) ** (reached / (a * rise)), 1.05, 2.0))
    if not is_endless(indenter, end):
        return min(further, end)
    gap = end - a
    return min(further, end - gap * min(0.5, math.exp(-1.05 * (wanted - reached) / (rise * gap))))


def _first_radius(scene: Scene) -> float:
    """About the half-space's contact radius, within the indenter and `FIRST_RATIO`."""
    values = getattr(scene.loading, "values", np.ones(1))
    wanted = float(values.max())
    is_force = isinstance(scene.loading, NormalForces)
    scale = np.sqrt(wanted / contact_modulus(scene.layer)) if is_force else wanted
    flat, end = scene.indenter.flat_radius, scene.indenter.max_radius
    # A little short of the end, where a sphere is upright.
    limit = min(end * (1 - 1e-6), max(FIRST_RATIO * scene.layer.surface.thickness, 1.5 * flat)) - flat
    excess = np.minimum(scale * TRIAL_RADII, limit)
    if excess[-1] < limit < np.inf:
        # A steep power law touches wide before it has sunk by much.
        steps = int(np.ceil(np.log(limit / excess[-1]) / np.log(TRIAL_RADII[1] / TRIAL_RADII[0])))
        excess = np.append(excess, np.geomspace(excess[-1], limit, steps + 1)[1:])
    depth, force = half_space_answer(scene.indenter, excess)
    answer = contact_modulus(scene.layer) * force if is_force else depth
    guess = np.interp(wanted, answer, excess)
    return flat + max(min(1.02 * float(guess), limit), LEAST_EXCESS * flat)


def _sketched_radius(scene: Scene, flat_punch: FlatPunchSource, guess: float) -> float:
    """A little beyond where a sketch of the springs reaches what is wanted; the guess [m] where that tells nothing.

    A system that has to be made again for a larger radius takes half as long as all the rest of an answer.
    """
    indenter, unit = scene.indenter, scene.layer.surface.thickness
    flat, end = indenter.flat_radius, indenter.max_radius * (1 - 1e-6)
    wanted, ratio = float(getattr(scene.loading, "values", np.ones(1)).max()), guess / unit
    while True:
        try:
            punch = flat_punch.solution(scene.layer, ratio)
        except RatioNotCovered:
            return unit * ratio
        drawn = punch.sketch(lambda x: half_space_profile(indenter, np.clip(unit * x - flat, 0.0, end - flat)), ratio)
        if drawn is None:
            return guess
        radius, profile, stiffness = (values[unit * drawn[0] > flat] for values in drawn)
        if not radius.size:
            return guess
        # dF = k_N dg, Eq. (5).
        steps = np.diff(profile, prepend=0.0) * (stiffness + np.append(stiffness[0], stiffness[:-1])) / 2
        is_force = isinstance(scene.loading, NormalForces)
        reached = contact_modulus(scene.layer) * unit * np.cumsum(steps) if is_force else profile
        first = int(np.argmax(reached >= wanted))
        if first:
            between = slice(first - 1, first + 1)
            found = unit * float(np.interp(wanted, reached[between], radius[between]))
            return min(flat + BEYOND * (found - flat), end) if reached[first - 1] > 0.0 else guess
        if reached[0] >= wanted or reached.argmax() < reached.size - 1 or unit * radius[-1] >= end:
            return guess
        ratio = SKETCHED * float(radius[-1])


def half_space_answer(indenter: Profile, excess: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Depth and force/E* on the half-space, the force by the trapezoidal rule: a guess needs no more."""
    depth = half_space_profile(indenter, excess)
    steps = np.diff(excess, prepend=0.0) * (depth + np.concatenate([[0.0], depth[:-1]])) / 2
    return depth, 2 * ((indenter.flat_radius + excess) * depth - np.cumsum(steps))


def beyond_falls(
    scene: Scene, flat_punch: FlatPunchSource, ring: SeveralContacts
) -> tuple[EquivalentSystem, FloatArray]:
    """The system across the falling stretch and the excess a - b [m] of every prescribed value.

    Args:
        scene: The problem, under prescribed radii, depths or forces.
        flat_punch: Where the flat punch comes from.
        ring: The objection to going on beyond the falling stretch, raised again where no circle is an answer.

    Raises:
        SeveralContacts: Where no single circle presses everywhere, or on one uniform layer.
        InvalidInput: If the flat-punch data end before the loading is reached.
    """
    if scene.layer.is_uniform or isinstance(scene.indenter, FlatPunch):
        raise ring
    values = np.asarray(getattr(scene.loading, "values", np.empty(0)), dtype=np.float64)
    system = _system_across(scene, flat_punch, ring, float(values.max()))
    return system, np.array([_only_valid(scene, system, _candidates(scene, system, v), ring) for v in values.tolist()])


def _system_across(scene: Scene, flat_punch: FlatPunchSource, ring: SeveralContacts, wanted: float) -> EquivalentSystem:
    """Up to the prescribed radius, or to where depth or force are reached by a rising profile."""
    end = scene.indenter.max_radius
    radius = wanted if isinstance(scene.loading, ContactRadii) else min(GROWTH * ring.radius, end)
    while True:
        system = equivalent_system(scene.layer, scene.indenter, radius, flat_punch, may_fall=True)
        last = np.array([system.max_radius - system.flat_radius])
        if isinstance(scene.loading, ContactRadii) or float(_curve(scene, system)(last)[0]) >= wanted:
            return system
        if radius >= end:
            raise ring
        radius = min(GROWTH * radius, end)


def _curve(scene: Scene, system: EquivalentSystem) -> Callable[[FloatArray], FloatArray]:
    """Depth or force over the excess."""
    if isinstance(scene.loading, IndentationDepths):
        return system.profile_beyond
    return lambda excess: system.elastic_force(system.flat_radius + excess)


def _candidates(scene: Scene, system: EquivalentSystem, value: float) -> list[float]:
    """Every excess with this value at which the profile rises, the widest first."""
    if isinstance(scene.loading, ContactRadii):
        return [value - system.flat_radius]
    # Only profiles that fall on the way come here, and SciPy's roots would double the time of all other first answers.
    from scipy.optimize import brentq  # noqa: PLC0415

    curve, grid = _curve(scene, system), system.profile.grid
    last = system.max_radius - system.flat_radius
    places = np.minimum(system.length_unit * np.unique(np.append(grid.ends, grid.nodes)), last)
    off = curve(places) - value
    rises = np.flatnonzero((off[:-1] < 0) & (off[1:] >= 0))
    found = [
        brentq(lambda e: float(curve(np.array([e]))[0]) - value, places[i], places[i + 1], xtol=1e-300, rtol=1e-14)
        for i in rises
    ]
    return found[::-1]


def _only_valid(scene: Scene, system: EquivalentSystem, candidates: list[float], ring: SeveralContacts) -> float:
    objection: UnsupportedSceneError = ring
    for excess in candidates:
        try:
            _refuse_invalid(scene, system, excess)
        except UnsupportedSceneError as own:
            # A circle short of the falling stretch has its own reason, which does not depend on how far was looked.
            if system.flat_radius + excess < ring.radius:
                objection = own
            continue
        return excess
    raise objection


def _refuse_invalid(scene: Scene, system: EquivalentSystem, excess: float) -> None:
    """Refuse a circle that pulls inside or is touched beside.

    Raises:
        UnsupportedSceneError: With the place.
    """
    radius = np.array([system.flat_radius + excess])
    depth = system.profile_beyond(np.array([excess]))
    contact = contact_fields(
        scene.layer, scene.indenter, system.flat_punch, excess=excess, depth=float(depth[0]), edge=False
    )
    refuse_pulling(scene, OneStep(contact.pressure), radius, system.force(radius, depth), LEAST_TENSION)
    refuse_touching(scene, [circle_of(scene, system, float(radius[0]), float(depth[0]))])

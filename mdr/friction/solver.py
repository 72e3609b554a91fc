"""Contact under full stick: equilibria under prescribed radii, depths or forces, reached by loading alone."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq

from bem.kernels.moduli import contact_modulus
from bem.kernels.of_layer import stack_kernel
from bem.layer_equation.flat_punch_source import IntegralEquation
from bem.layer_equation.protocol import FlatPunchSource
from bem.layer_equation.stick.adhered_punch import adhered_punch
from bem.layer_equation.stick.growth import growth_table
from contact import (
    ContactPath,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    NotConvergedError,
    Scene,
    StageLog,
    UnsupportedSceneError,
)
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from mdr.friction.fields import PunchFields, StickFields
from mdr.friction.growth import Growth, growth
from mdr.springs.half_space_profile import half_space_profile

EPS = float(np.finfo(float).eps)
# Unknowns of a stretch, at X = 0 and per thickness that the contact spans: errors then are below 1e-10 (paraboloids,
# cones, spheres and power laws, a/h 0.1 to 10, seeds 5 and 90, 2026-11-22).
_UNKNOWNS = (20.0, 5.0)
# More of them for the root of that span times how much longer than the film the longest length of its kernel is: 30
# left 2e-7 at a/h = 1.9 over a base a hundred times as soft, 38 left 8e-10 at 3.7, ten times (seed 3, 2026-11-22).
_UNKNOWNS_OF_LENGTH = 2.5
# But no more than so many for that reason, since rounding grows with them: six more moved 9e-11 at 46, 5e-10 at 58 and
# 5e-8 at 70 (cone, a/h = 1.6, nu = 0, over a base a hundred times as soft, 2026-11-22).
_MOST_OF_LENGTH = 60.0
# More unknowns, whose answer the one with fewer is compared with.
_MORE = 6
# Where the first trial radius does not reach the wanted depth or force, the next is this much larger.
_FURTHER = 1.3
# Times what others move: one is the difference itself, which is up to a quarter less than the error where six unknowns
# more leave a fifth of it (24 contacts of seed 3: 0.80 to 1.5 of the error, 2026-11-22).
_SAFETY = 2.0
# Roundings of depth and force (a/h 0.1 to 6, 2026-11-22).
_ROUNDINGS = 50.0
# Roundings of an adhered punch's stiffness over the condition number of its matrix: at most 8.1, against other nodes
# and functions (nu = 0, 0.3, 0.45 and 1/2, a/h = 0.02 to 50, 2026-11-22).
_PER_CONDITION = 10.0
# Largest relative error of depth and force that is answered; beyond, the growth is refused.
_LARGEST_ERROR = 1e-3


@dataclass(frozen=True)
class StickSystem:
    """Growing contact of one scene; lengths in `unit`, forces in E* unit^2.

    Attributes:
        unit: Thickness of the surface material, or the largest radius on a half-space [m].
        growths: The answer, that with more unknowns, and that from a table without its last coefficients.
    """

    unit: float
    growths: tuple[Growth, ...]

    def depth(self, radius: FloatArray) -> FloatArray:
        """delta at a."""
        return self.growths[0].depth_and_force(radius)[0]

    def errors(self, radius: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Relative errors of depth and force: what more unknowns, and the table's last coefficients, move."""
        answer, *others = (np.array(g.depth_and_force(radius)) for g in self.growths)
        errors = sum(
            (_SAFETY * np.abs(other / answer - 1.0) for other in others), np.full_like(answer, _ROUNDINGS * EPS)
        )
        return errors[0], errors[1]


def prescribed(scene: Scene) -> FloatArray:
    """The radii, depths or forces asked for, shape (n,)."""
    values: FloatArray = scene.loading.values  # type: ignore[attr-defined]  # the dispatch sends equilibria only
    return values


def solve_stick(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> ContactPath:
    """Contact radius, depth, force and stiffness where nothing slides from the first touch on.

    Raises:
        UnsupportedSceneError: A flat end that grows, on a compressible layer.
        InvalidInput: If a prescribed value is out of the indenter's reach.
        NotConvergedError: If the growth is not resolved.
    """
    log = StageLog()
    with log.stage("stick"):
        answer = (
            _flat_punch(scene) if isinstance(scene.indenter, FlatPunch) else _growing(scene, _refinement(flat_punch))
        )
    unknowns = int(answer.pop("unknowns"))
    return ContactPath(
        scene=scene, method="mdr", settings=settings, cost=log.cost(unknowns=unknowns), stages=log.records, **answer
    )


def _flat_punch(scene: Scene) -> dict[str, Any]:
    """k_stick delta: nothing grows."""
    radius, layer = scene.indenter.flat_radius, scene.layer
    ratio = 0.0 if layer.is_half_space else radius / layer.surface.thickness
    punch = adhered_punch(ratio, stack_kernel(layer))
    stiffness = 2.0 * contact_modulus(layer) * radius * punch.stiffness
    values = prescribed(scene)
    by_depth = isinstance(scene.loading, IndentationDepths)
    depth = values if by_depth else values / stiffness
    exact, error = np.zeros_like(values), np.full_like(values, EPS * (20.0 + _PER_CONDITION * punch.condition))
    return {
        "unknowns": punch.coefficients.size,
        "contact_radius": np.full_like(values, radius),
        "indentation_depth": depth,
        "normal_force": stiffness * depth,
        "contact_stiffness": np.full_like(values, stiffness),
        "error_estimate": {
            "contact_radius": exact,
            "indentation_depth": exact if by_depth else error,
            "normal_force": error if by_depth else exact,
            "contact_stiffness": error,
        },
        "fields": PunchFields(punch, radius, contact_modulus(layer), depth),
    }


def _refinement(flat_punch: FlatPunchSource) -> float:
    """Nodes of the integral equation over the usual ones, and the root of usual panel widths over its own.

    Growth takes that many unknowns more.
    """
    if not isinstance(flat_punch, IntegralEquation):
        return 1.0
    usual = IntegralEquation()
    return flat_punch.nodes / usual.nodes * math.sqrt(usual.panel_width / flat_punch.panel_width)


def _growing(scene: Scene, refinement: float) -> dict[str, Any]:
    nu = scene.layer.surface.poissons_ratio
    if scene.indenter.flat_radius and nu < 0.5:
        raise UnsupportedSceneError(
            f"a flat end of radius {scene.indenter.flat_radius:g} m that grows under full stick on a layer with "
            f"poissons_ratio = {nu:g}: its edge field oscillates, and growth from it has no "
            "stable answer; give Poisson's ratio 0.5, or a rounded edge"
        )
    system, radius = _covering(scene, refinement)
    depth, force = system.growths[0].depth_and_force(radius)
    table, modulus = system.growths[0].table, contact_modulus(scene.layer)
    stiffness = table.contact_stiffness(radius)
    of_table = np.abs(table.shortened().contact_stiffness(radius) / stiffness - 1.0)
    of_depth, of_force = system.errors(radius)
    if not max(of_depth.max(), of_force.max()) <= _LARGEST_ERROR:
        raise NotConvergedError(
            f"growth under full stick is resolved to {max(of_depth.max(), of_force.max()):.1g} only"
        )
    slope = radius * _slope(system, radius)
    exact = np.zeros_like(radius)
    given = type(scene.loading)
    moved = exact
    if given is not ContactRadii:
        moved = of_depth * depth / slope if given is IndentationDepths else of_force * force / (stiffness * slope)
        moved = moved + 4.0 * EPS
    return {
        "unknowns": system.growths[0].unknowns.size,
        "contact_radius": radius * system.unit,
        "indentation_depth": depth * system.unit,
        "normal_force": force * modulus * system.unit**2,
        "contact_stiffness": stiffness * modulus * system.unit,
        "error_estimate": {
            "contact_radius": moved,
            "indentation_depth": exact if given is IndentationDepths else of_depth + of_force,
            "normal_force": exact if given not in (ContactRadii, IndentationDepths) else of_depth + of_force,
            # k_stick grows with the third power of the radius at most.
            "contact_stiffness": 3.0 * moved + _SAFETY * of_table + _ROUNDINGS * EPS,
        },
        "fields": StickFields(scene, system.growths[0], system.unit, modulus, radius, depth * system.unit),
    }


def _slope(system: StickSystem, radius: FloatArray) -> FloatArray:
    """d delta/da by a difference: it scales errors only."""
    step = 1e-4 * radius
    return (system.depth(radius) - system.depth(radius - step)) / step


def _covering(scene: Scene, refinement: float) -> tuple[StickSystem, FloatArray]:
    """The growth up to the largest radius of the loading, and all its radii."""
    layer, values = scene.layer, prescribed(scene)
    unit = layer.surface.thickness if not layer.is_half_space else _first_reach(scene)
    if isinstance(scene.loading, ContactRadii):
        return _system(scene, unit, float(values.max()), refinement), values / unit
    by_depth = isinstance(scene.loading, IndentationDepths)
    wanted = values / unit if by_depth else values / (contact_modulus(layer) * unit**2)
    reach, end = min(_first_reach(scene), scene.indenter.max_radius), scene.indenter.max_radius
    while True:
        system = _system(scene, unit, reach, refinement)
        reached = system.growths[0].depth_and_force(np.array([reach / unit]))[0 if by_depth else 1][0]
        if reached >= wanted.max():
            return system, _radii(system.growths[0], wanted, reach / unit, 0 if by_depth else 1)
        if reach >= end:
            raise InvalidInput(
                f"loading.values = {values.max():g}: the indenter ends at a radius of {end:g} m, before it is reached; "
                "ask for less or describe the indenter further out"
            )
        reach = min(_FURTHER * reach, end)


def _first_reach(scene: Scene) -> float:
    """Radius [m] at which the half-space's profile passes the wanted depth, or a Hertzian guess of it."""
    layer, indenter = scene.layer, scene.indenter
    largest = float(prescribed(scene).max())
    if isinstance(scene.loading, ContactRadii):
        return largest
    modulus = contact_modulus(layer)
    room = min(indenter.max_radius, 1e12) - indenter.flat_radius

    def missing(log_excess: float) -> float:
        """What the frictionless half-space lacks of the largest depth or force."""
        excess = math.exp(log_excess)
        depth = float(half_space_profile(indenter, np.array([excess]))[0])
        if isinstance(scene.loading, IndentationDepths):
            return depth - largest
        return modulus * (indenter.flat_radius + excess) * depth - largest

    # A trillionth less than the room there is: beyond a sphere's equator the profile is no number.
    low, high = math.log(1e-15 * min(room, 1.0)), math.log(room) - 1e-12
    found = brentq(missing, low, high, xtol=1e-3) if missing(high) > 0.0 > missing(low) else high
    return indenter.flat_radius + math.exp(found)


def _system(scene: Scene, unit: float, reach: float, refinement: float) -> StickSystem:
    ratio = reach / unit
    table = growth_table(_rounded_up(ratio), stack_kernel(scene.layer))
    span = 0.0 if table.is_half_space else ratio
    usual = _UNKNOWNS[0] + _UNKNOWNS[1] * span
    more = _UNKNOWNS_OF_LENGTH * math.sqrt((table.kernel.longest - 1.0) * span)
    count = math.ceil(refinement * max(usual, min(usual + more, _MOST_OF_LENGTH)))
    solves = ((table, count), (table, count + _MORE), (table.shortened(), count))
    return StickSystem(unit, tuple(growth(scene.indenter, unit, ratio, one, n) for one, n in solves))


def _rounded_up(ratio: float) -> float:
    """Up to a fifth more, so that scenes share tables."""
    return float(1.2 ** math.ceil(math.log(ratio) / math.log(1.2)))


def _radii(found: Growth, wanted: FloatArray, reach: float, which: int) -> FloatArray:
    def missing(radius: float, value: float) -> float:
        return float(found.depth_and_force(np.array([radius]))[which][0]) - value

    start = found.stretches[0].start
    radii = [brentq(missing, start, reach, args=(value,), xtol=1e-300, rtol=4.0 * EPS) for value in wanted]
    return np.array(radii)

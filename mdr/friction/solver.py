"""Contact under full stick: equilibria under prescribed radii, depths or forces, reached by loading alone."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq

from bem.kernels.moduli import contact_modulus
from bem.kernels.of_layer import sticking_kernel
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
# Fewer unknowns, whose answers tell how fast the errors fall.
_FEWER = (12, 6)
# Where the first trial radius does not reach the wanted depth or force, the next is this much larger.
_FURTHER = 1.3
# Safety factor on the error that is left, chosen on seed 5 (160 of 160 depths and forces covered). On seed 90 it covers
# 95 of 96, the miss being 1.4e-13 where 8e-14 is stated (a/h 0.1 to 10, both supports, four kinds of profile, against
# twice the unknowns and a larger table, 2026-11-22).
_SAFETY = 5.0
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
        growths: With all unknowns, and with fewer.
    """

    unit: float
    growths: tuple[Growth, ...]

    def depth(self, radius: FloatArray) -> FloatArray:
        """delta at a."""
        return self.growths[0].depth_and_force(radius)[0]

    def errors(self, radius: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Relative errors of depth and force: differences shrink by one factor with each six unknowns more."""
        finest, fine, coarse = (np.array(g.depth_and_force(radius)) for g in self.growths)
        last, before = np.abs(fine / finest - 1.0), np.abs(coarse / fine - 1.0)
        rate = np.minimum(1.0, np.divide(last, before, out=np.ones_like(last), where=before > 0.0))
        errors = _SAFETY * last * rate + self.growths[0].table.truncation + 50.0 * EPS
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
        answer = _flat_punch(scene) if isinstance(scene.indenter, FlatPunch) else _growing(scene)
    unknowns = int(answer.pop("unknowns"))
    return ContactPath(
        scene=scene, method="mdr", settings=settings, cost=log.cost(unknowns=unknowns), stages=log.records, **answer
    )


def _flat_punch(scene: Scene) -> dict[str, Any]:
    """k_stick delta: nothing grows."""
    radius, layer = scene.indenter.flat_radius, scene.layer
    ratio = 0.0 if layer.is_half_space else radius / layer.surface.thickness
    punch = adhered_punch(ratio, sticking_kernel(layer))
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


def _growing(scene: Scene) -> dict[str, Any]:
    nu = scene.layer.surface.poissons_ratio
    if scene.indenter.flat_radius and nu < 0.5:
        raise UnsupportedSceneError(
            f"a flat end of radius {scene.indenter.flat_radius:g} m that grows under full stick on a layer with "
            f"poissons_ratio = {nu:g}: its edge field oscillates, and growth from it has no "
            "stable answer; give Poisson's ratio 0.5, or a rounded edge"
        )
    system, radius = _covering(scene)
    depth, force = system.growths[0].depth_and_force(radius)
    table, modulus = system.growths[0].table, contact_modulus(scene.layer)
    stiffness = table.contact_stiffness(radius)
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
            "contact_stiffness": 3.0 * moved + table.truncation + 50.0 * EPS,
        },
        "fields": StickFields(scene, system.growths[0], system.unit, modulus, radius, depth * system.unit),
    }


def _slope(system: StickSystem, radius: FloatArray) -> FloatArray:
    """d delta/da by a difference: it scales errors only."""
    step = 1e-4 * radius
    return (system.depth(radius) - system.depth(radius - step)) / step


def _covering(scene: Scene) -> tuple[StickSystem, FloatArray]:
    """The growth up to the largest radius of the loading, and all its radii."""
    layer, values = scene.layer, prescribed(scene)
    unit = layer.surface.thickness if not layer.is_half_space else _first_reach(scene)
    if isinstance(scene.loading, ContactRadii):
        return _system(scene, unit, float(values.max())), values / unit
    by_depth = isinstance(scene.loading, IndentationDepths)
    wanted = values / unit if by_depth else values / (contact_modulus(layer) * unit**2)
    reach, end = min(_first_reach(scene), scene.indenter.max_radius), scene.indenter.max_radius
    while True:
        system = _system(scene, unit, reach)
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


def _system(scene: Scene, unit: float, reach: float) -> StickSystem:
    ratio = reach / unit
    table = growth_table(_rounded_up(ratio), sticking_kernel(scene.layer))
    span = 0.0 if table.is_half_space else ratio
    count = math.ceil(_UNKNOWNS[0] + _UNKNOWNS[1] * span)
    counts = (count, *(count - fewer for fewer in reversed(_FEWER)))
    return StickSystem(unit, tuple(growth(scene.indenter, unit, ratio, table, n) for n in counts))


def _rounded_up(ratio: float) -> float:
    """Up to a fifth more, so that scenes share tables."""
    return float(1.2 ** math.ceil(math.log(ratio) / math.log(1.2)))


def _radii(found: Growth, wanted: FloatArray, reach: float, which: int) -> FloatArray:
    def missing(radius: float, value: float) -> float:
        return float(found.depth_and_force(np.array([radius]))[which][0]) - value

    start = found.stretches[0].start
    radii = [brentq(missing, start, reach, args=(value,), xtol=1e-300, rtol=4.0 * EPS) for value in wanted]
    return np.array(radii)

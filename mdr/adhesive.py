"""Adhesive equilibria at prescribed radii, depths or forces, with stated errors: Eqs. (40), (41), (4).

Errors: the same answer on finer springs, and rounding errors of the terms whose differences depth and force are.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from bem.branch import DEPTH, FORCE, Branch
from bem.flat_punch import FlatPunchSource
from contact import (
    ContactPath,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    Scene,
    StageLog,
    UnsupportedSceneError,
)
from contact.answer.solution import Setting, StatedErrors
from contact.records.validation import FloatArray
from contact.stated import stated_error
from mdr.adhesive_branch import Adhesive, refuse_touching, work_of_adhesion
from mdr.contact_surface import Surface
from mdr.equilibria import (
    PathFields,
    StatedError,
    compared_displacement,
    compared_pressure,
    is_simple,
    solve_elastic,
    springs_of,
    surface_pair,
)
from mdr.radius_search import RadiusSearch, refuse_too_wide

# Contact radius [m], depth [m] and force [N].
Triple: TypeAlias = tuple[FloatArray, FloatArray, FloatArray]


def solve_adhesive(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> ContactPath:
    """Adhesive equilibria at prescribed radii, depths or forces.

    A depth or force is reached from the undeformed layer: of several stable states the one of smallest radius.

    Raises:
        InvalidInput: If a prescribed value lies beyond pull-off.
        UnsupportedSceneError: If the indenter would touch outside its circle of contact.
    """
    if work_of_adhesion(scene) == 0.0:
        return replace(solve_elastic(scene.replace(effects=()), flat_punch, settings), scene=scene)
    log = StageLog()
    with log.stage("adhesion"):
        contacts = Adhesive(scene, springs_of(scene, flat_punch, log))
        springs = contacts.springs
        found, other = _prescribed(contacts), _prescribed(contacts.finer)
        radius, depth, force = found
        refuse_touching(contacts, radius, depth)
        stiffness = 2 * springs.modulus * springs.at(radius).K
        errors = _path_errors(contacts, found, other)
    return ContactPath(
        scene=scene,
        method="mdr",
        settings=settings,
        error_estimate=StatedErrors(errors, "mdr"),
        cost=log.cost(unknowns=springs.punches.unknowns(float(radius.max()) / springs.unit)),
        stages=log.records,
        contact_radius=radius,
        indentation_depth=depth,
        normal_force=force,
        contact_stiffness=stiffness,
        fields=PathFields(scene, springs, radius, depth, flat_punch, settings, adheres=True),
    )


def _prescribed(contacts: Adhesive) -> Triple:
    """Radius [m], depth [m] and force [N] of the states that the loading asks for."""
    scene, springs = contacts.scene, contacts.springs
    loading, indenter = scene.loading, scene.indenter
    if isinstance(loading, ContactRadii):
        refuse_too_wide(springs, float(loading.values[-1]))
        RadiusSearch(springs, may_fall=not is_simple(scene)).refuse_falls(float(loading.values[-1]))
        return loading.values, *contacts.states(loading.values)
    if not isinstance(loading, IndentationDepths | NormalForces):
        raise UnsupportedSceneError(
            f"loading = {type(loading).__name__}: adhesion needs radii, depths, forces, Detachment"
        )
    quantity, values = DEPTH if isinstance(loading, IndentationDepths) else FORCE, loading.values
    if isinstance(indenter, FlatPunch):
        branch = contacts.branch(indenter.radius)
        # A punch keeps its radius down to where the front sets off.
        held = values >= branch.at(quantity, branch.end)
    else:
        largest = float(values.max())
        branch = contacts.reaching(lambda b: b.at(quantity, b.end) >= largest)
        held = np.zeros(values.size, dtype=bool)
    y = np.where(held, branch.end, branch.smallest(quantity, values))
    _refuse_missing(y, values, branch, quantity)
    radius = np.where(held, indenter.max_radius, branch.radius(y))
    at = springs.at(radius)
    if quantity == DEPTH:
        return radius, values, 2 * springs.modulus * (values * at.K - at.M)
    depth = (values / (2 * springs.modulus) + at.M) / at.K
    return radius, np.asarray(depth), values


def _refuse_missing(y: FloatArray, values: FloatArray, branch: Branch, quantity: int) -> None:
    missing = np.flatnonzero(np.isnan(y))
    if not missing.size:
        return
    reach = branch.values(np.array([*branch.folds(quantity), branch.end]))[quantity]
    unit = "m" if quantity == DEPTH else "N"
    raise InvalidInput(
        f"loading.values = {values[missing[0]]:g} (entry {missing[0]}): no stable contact; "
        f"the indenter holds from {reach.min():g} {unit} on, up to {reach.max():g} {unit} at its rim"
    )


def _path_errors(
    contacts: Adhesive,
    found: Triple,
    other: Triple,
) -> dict[str, StatedError]:
    """Stated errors of a path, relative to its largest values."""
    springs, (radius, depth, force) = contacts.springs, found
    loading, rounding = contacts.scene.loading, contacts.rounding(radius)
    values, floor = springs.at(radius), np.max(springs.floor(radius), axis=0)
    size = [max(float(np.abs(one).max()), 1e-300) for one in found]
    by_radius, is_punch = isinstance(loading, ContactRadii), isinstance(contacts.scene.indenter, FlatPunch)
    given = 0.0 if by_radius or is_punch else 1.0
    slope = _rise(contacts, radius, DEPTH if isinstance(loading, IndentationDepths) else FORCE)
    row = DEPTH if isinstance(loading, IndentationDepths) else FORCE
    moved = np.asarray(stated_error(radius, other[0], scale=size[0], floor=given * 2 * rounding[row] / slope / size[0]))
    stiffness, finer = values.K, springs.finer.at(other[0]).K
    growth = radius * values.y1**2 / values.K
    errors: dict[str, StatedError] = {
        "contact_radius": moved,
        "indentation_depth": stated_error(depth, other[1], scale=size[1], floor=rounding[DEPTH] / size[1]),
        "normal_force": stated_error(force, other[2], scale=size[2], floor=rounding[FORCE] / size[2]),
        "contact_stiffness": stated_error(
            stiffness, finer, scale=stiffness.max(), floor=floor + growth * moved * size[0] / radius
        ),
    }
    if isinstance(loading, IndentationDepths | NormalForces):
        errors["indentation_depth" if isinstance(loading, IndentationDepths) else "normal_force"] = np.zeros(
            radius.size
        )
    return errors | _field_errors(contacts, found, moved)


def _rise(contacts: Adhesive, radius: FloatArray, row: int) -> FloatArray:
    """|d(depth or force)/da| by differences."""
    step = 1e-4
    inner = radius * (1 - step)
    change = contacts.states(radius)[row] - contacts.states(inner)[row]
    return np.asarray(np.maximum(np.abs(change), 1e-300) / (step * radius))


def _field_errors(contacts: Adhesive, found: Triple, moved: FloatArray) -> dict[str, StatedError]:
    """Stated errors of pressure and displacement: two resolutions, and the errors of the radius."""
    springs, (radius, depth, force) = contacts.springs, found
    values, floor = springs.at(radius), np.max(springs.floor(radius), axis=0)
    load = np.maximum(np.abs(force), 2 * springs.modulus * values.K * np.abs(depth))
    scale = float((load / (np.pi * radius**2)).max())
    steps = sorted({int(radius.argmin()), int(radius.argmax())})

    def pair(step: int) -> list[Surface]:
        return surface_pair(springs, float(radius[step]), float(depth[step]), is_singular=True)

    def displacement() -> float:
        widest = int(radius.argmax())
        return compared_displacement(pair(widest)) * float(abs(depth[widest])) / size

    terms = values.g + np.abs(values.g - depth)
    beside = 2 / np.pi * np.abs(values.g - depth) * np.sqrt(2 * moved * radius.max() / radius)
    size = max(float(np.abs(depth).max()), 1e-300)
    spread = 2 * springs.modulus * values.K * terms / (np.pi * radius**2) / scale
    return {
        "pressure": lambda: (
            max(compared_pressure(pair(step), scale) for step in steps) + (floor + moved) * np.maximum(spread, 1.0)
        ),
        "surface_displacement": lambda: displacement() + (floor * terms + beside) / size,
    }

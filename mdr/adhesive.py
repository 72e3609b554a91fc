"""JKR adhesion of any profile with any layer, Eqs. (40)-(46): detachment, and equilibria at prescribed values.

    dl(a) = sqrt(2 pi dgamma a/c_N)   the outermost spring lets go                  Eq. (40)
    depth = g(a) - dl(a),  F = 2 E* (depth K - M)                                   Eqs. (41), (4)

All equilibria are sampled over the contact radius (`bem.adhesion.equilibrium_branch`), so no fold is ever met. Errors:
the same answer on finer springs, and rounding errors of the terms whose differences depth and force are.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np

from bem.adhesion.equilibrium_branch import DEPTH, FORCE, EquilibriumBranch
from bem.adhesion.withdrawal import CONTROLS, Route
from bem.layer_equation.protocol import FlatPunchSource
from contact import (
    ContactPath,
    ContactRadii,
    Detachment,
    DetachmentPath,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    Scene,
    StageLog,
    UnsupportedSceneError,
)
from contact.answer.solution import Setting
from contact.records.validation import BoolArray, FloatArray
from contact.stated import stated_error
from mdr.adhesion.solver import POINTS, balance_radius, work_of_adhesion
from mdr.admissible import is_touched_nowhere, refuse_touching_outside
from mdr.contact_surface import surface_of
from mdr.equilibria import (
    PathFields,
    compared_displacement,
    compared_pressure,
    is_simple,
    solve_elastic,
    springs_of,
    surface_pair,
)
from mdr.profiles import FlatTip
from mdr.radius_search import RadiusSearch, refuse_too_wide
from mdr.spring_bed import Springs
from mdr.springs.shared_tables import growing_radii

# Share of the states of a detachment during which the front rests at a punch's edge.
_PINNED = POINTS // 5
# Relative error down to which branches are sampled. A tenth of it meets rounding.
_SAMPLED = 2e-14
# The companion's branch is so much longer, so that its polynomials have other nodes.
_LONGER = 1.03
# First trial radius over the flat end, in units of where height and elongation are equal on the half-space.
_FIRST_WAY = 2.0
# a/h from which the half-space is no guide to the first trial radius.
_THIN = 10.0
# A punch's tension may be largest in its centre from this Poisson's ratio on; beyond this a/h it keeps its shape.
_CONFINED, _THINNEST, _INSIDE = 0.45, 50.0, 0.1
# Rounding errors where contact is lost, over those of other states: the place itself is rounded there.
_LOST = 4.0
# Largest number of contacts of a path that are checked for touching outside.
_CHECKED = 12


# Contact radius [m], depth [m] and force [N].
Triple: TypeAlias = tuple[FloatArray, FloatArray, FloatArray]


@dataclass(frozen=True, eq=False)
class Adhesive:
    """Equilibria of one scene at one resolution.

    Attributes:
        scene: The problem.
        springs: Springs of the scene.
        longer: Factor by which branches exceed their first trial radius.
    """

    scene: Scene
    springs: Springs
    longer: float = 1.0

    @property
    def finer(self) -> Adhesive:
        """The companion whose change states errors."""
        return replace(self, springs=self.springs.finer, longer=_LONGER)

    @cached_property
    def _work(self) -> float:
        return work_of_adhesion(self.scene)

    def elongation(self, radius: FloatArray, y1: FloatArray) -> FloatArray:
        """dl [m], Eq. (40)."""
        return np.asarray(np.sqrt(2 * np.pi * self._work * radius / self.springs.modulus) / y1)

    def states(self, radius: FloatArray, excess: FloatArray | None = None) -> FloatArray:
        """Depth [m] and force [N] at contact radii [m], with their excess over a flat end if known, shape (2, n)."""
        radius = np.maximum(radius, np.finfo(float).tiny)
        values = self.springs.at(radius, excess)
        depth = values.g - self.elongation(radius, values.y1)
        return np.stack([depth, 2 * self.springs.modulus * (depth * values.K - values.M)])

    def rounding(self, radius: FloatArray) -> FloatArray:
        """Rounding errors of depth [m] and force [N] at contact radii [m], from the terms of their differences."""
        radius = np.maximum(radius, np.finfo(float).tiny)
        values, floor = self.springs.at(radius), np.max(self.springs.floor(radius), axis=0)
        terms = values.g + self.elongation(radius, values.y1)
        return np.asarray(floor * np.stack([terms, 2 * self.springs.modulus * (terms * values.K + values.M)]))

    def branch(self, radius: float) -> EquilibriumBranch:
        """All equilibria up to a contact radius [m]."""
        indenter, flat = self.scene.indenter, self.scene.indenter.flat_radius
        refuse_too_wide(self.springs, radius)
        if not isinstance(indenter, FlatPunch):
            RadiusSearch(self.springs, may_fall=not is_simple(self.scene)).refuse_falls(radius)
        return EquilibriumBranch.sampled(
            lambda start, way: self.states(start + way, (start - flat) + way if start >= flat > 0.0 else None),
            breakpoints=(indenter.flat_radius, *indenter.breakpoints),
            radius=radius,
            error=max(_SAMPLED, float(np.max(self.springs.floor(np.array([radius]))))),
        )

    def reaching(self, enough: Callable[[EquilibriumBranch], bool]) -> EquilibriumBranch:
        """A branch that is long enough, or ends with the indenter."""
        for radius in growing_radii(self.scene.indenter, self._first_radius()):
            try:
                branch = self.branch(radius)
            except InvalidInput as refusal:
                raise InvalidInput(
                    f"the adhering contact is sought up to a = {radius:g} m, where the flat-punch data end "
                    f"({refusal}); a Detachment may begin at a smaller initial_contact_radius"
                ) from None
            if enough(branch):
                break
        return branch

    def _first_radius(self) -> float:
        flat, thickness = self.scene.indenter.flat_radius, self.scene.layer.surface.thickness
        first = flat + self.longer * _FIRST_WAY * (balance_radius(self.scene) - flat)
        return (
            first
            if first <= self.springs.largest_ratio / 6 * thickness
            else self.longer * max(_THIN * thickness, 2 * flat)
        )


def _adhesive(scene: Scene, flat_punch: FlatPunchSource) -> Adhesive:
    return Adhesive(scene, springs_of(scene.layer, scene.indenter, flat_punch))


@dataclass(frozen=True, eq=False)
class Withdrawal:
    """A detachment at one resolution.

    Attributes:
        contacts: Its equilibria.
        route: The way from the first contact radius inwards.
    """

    contacts: Adhesive
    route: Route

    @classmethod
    def of(cls, contacts: Adhesive, loading: Detachment) -> Withdrawal:
        """The withdrawal that a loading asks for.

        Raises:
            InvalidInput: If there is nothing to detach, or the indenter ends too early.
        """
        scene = contacts.scene
        is_punch, compliance = isinstance(scene.indenter, FlatPunch), 1.0 / (loading.machine_stiffness or np.inf)
        if is_punch or loading.initial_contact_radius is not None:
            branch = contacts.branch(loading.initial_contact_radius or scene.indenter.max_radius)
            return cls(contacts, Route(branch, float(branch.section_ends[-1]), is_punch, compliance))
        if work_of_adhesion(scene) == 0.0:
            raise InvalidInput(
                "effects: without work of adhesion nothing says where to start; give initial_contact_radius"
            )
        branch = contacts.reaching(lambda b: bool(b.values(b.section_ends[-1:])[FORCE, 0] >= b.strength))
        start = float(branch.solutions(FORCE, np.array([branch.strength]))[0])
        return cls(
            contacts, Route(branch, float(branch.section_ends[-1]) if np.isnan(start) else start, False, compliance)
        )

    def states(self) -> tuple[FloatArray, FloatArray, BoolArray]:
        """Radius, depth and force with it, and stability by control, the radius falling.

        A pinned front comes first: from rest to where it sets off, depth and force are shares of what they are there.
        """
        route, share, y = self.route, self.share(), self.places()
        stable = (route.branch.slopes(y) > 0.0) | (share < 1.0)
        return route.branch.radius(y), share * route.branch.values(y), stable

    def places(self) -> FloatArray:
        """y of the states, shape (POINTS,)."""
        held = _PINNED if self.route.pinned else 0
        way = np.append(np.ones(held), np.linspace(1.0, 0.0, POINTS - held, endpoint=False))
        return np.asarray(self.route.start * way)

    def share(self) -> FloatArray:
        """Share of depth and force at which the front sets off, one from there on, shape (POINTS,)."""
        held = _PINNED if self.route.pinned else 0
        return np.append(np.arange(held) / max(held, 1), np.ones(POINTS - held))

    def scalars(self, control: int) -> dict[str, float]:
        """Numbers of the pull-off."""
        return self.route.scalars(self.route.loss(control), self.route.largest_tension(control))


def solve_detachment(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> DetachmentPath:
    """The whole equilibrium branch of a withdrawal, in order of decreasing contact radius.

    Raises:
        InvalidInput: If there is nothing to detach, or the indenter ends too early.
        UnsupportedSceneError: If the indenter would touch outside its circle of contact.
    """
    log, loading = StageLog(), scene.loading
    if not isinstance(loading, Detachment):
        raise UnsupportedSceneError(f"loading = {type(loading).__name__}: a detachment path needs Detachment")
    with log.stage("adhesion"):
        contacts = _adhesive(scene, flat_punch)
        own, other = Withdrawal.of(contacts, loading), Withdrawal.of(contacts.finer, loading)
        radius, values, stable = own.states()
        _refuse_touching(contacts, radius, values[DEPTH])
        control = CONTROLS.index(loading.controlled)
        scalars = own.scalars(control)
        errors = _detachment_errors(own, other, control)
    return DetachmentPath(
        scene=scene,
        method="mdr",
        settings=settings,
        error_estimate=errors,
        cost=log.cost(unknowns=contacts.springs.punches.unknowns(float(radius[0]) / contacts.springs.unit)),
        stages=log.records,
        notes=_notes(contacts, float(radius[0])),
        contact_radius=radius,
        indentation_depth=values[DEPTH],
        normal_force=values[FORCE],
        stable_displacement_control=stable[DEPTH],
        stable_force_control=stable[FORCE],
        critical_points=own.route.critical_points(),
        **scalars,
    )


def _detachment_errors(own: Withdrawal, other: Withdrawal, control: int) -> dict[str, FloatArray]:
    """Stated errors of a detachment: along the path relative to its largest values."""
    radius, values, _ = own.states()
    companion, _, _ = other.states()
    rounding = own.contacts.rounding(radius)
    found = {"contact_radius": stated_error(radius, companion, scale=radius.max(), floor=1e-14)}
    share = own.share()
    direct = other.contacts.states(radius, own.route.branch.excess(own.places(), own.contacts.springs.tip.flat))
    for row, name in enumerate(("indentation_depth", "normal_force")):
        size = np.abs(values[row]).max()
        found[name] = stated_error(values[row], share * direct[row], scale=size, floor=rounding[row] / size)
    first, second = own.scalars(control), other.scalars(control)
    lost = np.array([first["pull_off_contact_radius"]])
    floors = _LOST * own.contacts.rounding(lost)[:, 0] if lost[0] else np.zeros(2)
    floor = {"pull_off_depth": floors[DEPTH], "pull_off_contact_radius": 1e-13 * lost[0]}
    for name, value in first.items():
        size = abs(value) or 1.0
        own_floor = floor.get(name, floors[FORCE])
        found[name] = stated_error(value, second[name], scale=size, floor=float(own_floor) / size)
    return found


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
        contacts = _adhesive(scene, flat_punch)
        springs = contacts.springs
        found, other = _prescribed(contacts), _prescribed(contacts.finer)
        radius, depth, force = found
        _refuse_touching(contacts, radius, depth)
        stiffness = 2 * springs.modulus * springs.at(radius).K
        errors = _path_errors(contacts, found, other)
    return ContactPath(
        scene=scene,
        method="mdr",
        settings=settings,
        error_estimate=errors,
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
        held = values >= branch.values(branch.section_ends[-1:])[quantity, 0]
    else:
        largest = float(values.max())
        branch = contacts.reaching(lambda b: bool(b.values(b.section_ends[-1:])[quantity, 0] >= largest))
        held = np.zeros(values.size, dtype=bool)
    y = np.where(held, branch.section_ends[-1], branch.solutions(quantity, values))
    _refuse_missing(y, values, branch, quantity)
    radius = np.where(held, indenter.max_radius, branch.radius(y))
    at = springs.at(radius)
    if quantity == DEPTH:
        return radius, values, 2 * springs.modulus * (values * at.K - at.M)
    depth = (values / (2 * springs.modulus) + at.M) / at.K
    return radius, np.asarray(depth), values


def _refuse_missing(y: FloatArray, values: FloatArray, branch: EquilibriumBranch, quantity: int) -> None:
    missing = np.flatnonzero(np.isnan(y))
    if not missing.size:
        return
    reach = branch.values(np.append(branch.folds(quantity), branch.section_ends[-1]))[quantity]
    unit = "m" if quantity == DEPTH else "N"
    raise InvalidInput(
        f"loading.values = {values[missing[0]]:g} (entry {missing[0]}): no stable contact; "
        f"the indenter holds from {reach.min():g} {unit} on, up to {reach.max():g} {unit} at its rim"
    )


def _path_errors(
    contacts: Adhesive,
    found: Triple,
    other: Triple,
) -> dict[str, FloatArray]:
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
    errors = {
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


def _field_errors(contacts: Adhesive, found: Triple, moved: FloatArray) -> dict[str, FloatArray]:
    """Stated errors of pressure and displacement: compared in the widest contact, and by the errors of the radius."""
    springs, (radius, depth, force) = contacts.springs, found
    values, floor = springs.at(radius), np.max(springs.floor(radius), axis=0)
    load = np.maximum(np.abs(force), 2 * springs.modulus * values.K * np.abs(depth))
    scale = float((load / (np.pi * radius**2)).max())
    pressure = displacement = 0.0
    for step in sorted({int(radius.argmin()), int(radius.argmax())}):
        pair = surface_pair(springs, float(radius[step]), float(depth[step]), is_singular=True)
        pressure = max(pressure, compared_pressure(pair, scale))
        height = abs(depth[step]) / max(float(np.abs(depth).max()), 1e-300)
        displacement = compared_displacement(pair) * float(height)
    terms = values.g + np.abs(values.g - depth)
    beside = 2 / np.pi * np.abs(values.g - depth) * np.sqrt(2 * moved * radius.max() / radius)
    size = max(float(np.abs(depth).max()), 1e-300)
    spread = 2 * springs.modulus * values.K * terms / (np.pi * radius**2) / scale
    return {
        "pressure": pressure + (floor + moved) * np.maximum(spread, 1.0),
        "surface_displacement": displacement + (floor * terms + beside) / size,
    }


def _refuse_touching(contacts: Adhesive, radius: FloatArray, depth: FloatArray) -> None:
    """Refuse contacts outside which the indenter would touch; adhesion, which lifts it, only widens gaps."""
    scene, springs = contacts.scene, contacts.springs
    if is_touched_nowhere(scene) or isinstance(scene.indenter, FlatPunch):
        return
    widest = float(radius.max())
    try:
        refuse_touching_outside(scene, surface_of(springs, widest, float(springs.at([widest]).g[0])))
    except UnsupportedSceneError:
        order = np.argsort(radius)[::-1]
        for i in order[:: -(-order.size // _CHECKED)].tolist():
            refuse_touching_outside(scene, surface_of(springs, float(radius[i]), float(depth[i]), is_singular=True))


def _notes(contacts: Adhesive, radius: float) -> tuple[str, ...]:
    """A warning where the contact is likely to lose its circle before the theory lets it detach."""
    layer, springs = contacts.scene.layer, contacts.springs
    if layer.is_half_space or (layer.is_uniform and (layer.support != "bonded" or layer.poissons_ratio < _CONFINED)):
        return ()
    thickness = springs.unit * springs.kernel.units
    asked = min(radius, _THINNEST * thickness)
    punch = replace(springs, tip=FlatTip(FlatPunch(radius=asked)))
    pressure = surface_of(punch, asked, 1.0, is_singular=True).pressure(asked * np.array([0.0, _INSIDE]))
    if pressure[0] <= pressure[1]:
        return ()
    warning = (
        f"At a/h = {radius / thickness:.3g} the tension under the indenter has a second maximum in its centre: "
        "cavitation or fingering may come before the axisymmetric detachment computed here (Webber et al. 2003)."
    )
    return (warning,)

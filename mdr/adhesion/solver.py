"""JKR adhesion of any profile with any layer, Eqs. (40)-(46): detachment, and equilibria at prescribed values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from bem.adhesion.equilibrium_branch import DEPTH, FORCE, EquilibriumBranch
from bem.adhesion.withdrawal import CONTROLS, MACHINE, Route
from bem.kernels.moduli import contact_modulus
from bem.layer_equation.protocol import LARGEST_FACTORISED_RATIO, FlatPunchSource
from contact import (
    Adhesion,
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
from contact.records.validation import FloatArray
from contact.scene.extent import radius_of_elongation
from mdr.adhesion.branch import adhesive_branch, critical_elongation
from mdr.adhesion.errors import RADIUS, BranchErrors, errors_at_radius
from mdr.adhesion.own_panels import state_again
from mdr.adhesion.pressure_errors import pressure_errors
from mdr.elastic import PathFields, by_finer_data, density_errors, solve_elastic
from mdr.springs.assembly import equivalent_system
from mdr.springs.beside_contact import refuse_touching_beside
from mdr.springs.equivalent_system import EquivalentSystem
from mdr.springs.error_model import PRESSURE_ROUNDING
from mdr.springs.reach import FIRST_RATIO
from mdr.springs.shared_tables import growing_radii, power_law

# States of a detachment path.
POINTS = 200
# States of them with the front at a punch's edge.
_PINNED = POINTS // 5
# First trial excess over the flat end, in units of the way to where height and critical elongation are equal; chosen.
FIRST_WAY = 2.0

# a/h beyond which the half-space's radius is no guide to the layer's: the largest that one factorisation covers.
_THIN = LARGEST_FACTORISED_RATIO

# Poisson's ratio from which a punch's pressure may have a second maximum in its centre.
_CONFINED = 0.45
# a/h beyond which the pressure inside no longer changes its shape.
_THINNEST = 50.0
# Share of the contact radius at which the pressure is compared with its value in the centre; chosen.
_INSIDE = 0.1


def solve_detachment(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> DetachmentPath:
    """The whole equilibrium branch of a withdrawal, in order of decreasing contact radius.

    Raises:
        InvalidInput: If there is nothing to detach, or the indenter ends too early.
        UnsupportedSceneError: If the indenter would touch beside its circle of contact.
    """
    log, loading = StageLog(), scene.loading
    if not isinstance(loading, Detachment):
        raise UnsupportedSceneError(f"loading = {type(loading).__name__}: a detachment path needs Detachment")
    with log.stage("adhesion"):
        route, bounds, uncertain = _withdrawal(scene, loading, flat_punch)
        system = bounds.system
        radius, values, errors, stable = _states(route, bounds, uncertain)
        refuse_touching_beside(scene, system, radius, values[DEPTH])
        control = CONTROLS.index(loading.controlled)
        loss, tension = route.loss(control), route.largest_tension(control)
        lost_radius, lost_depth, lost_force = route.state(loss)
        lost = _point_errors(route, bounds, uncertain, loss)
        torn = lost if tension == loss else _point_errors(route, bounds, uncertain, tension)
        force = route.state(tension)[2]
    return DetachmentPath(
        scene=scene,
        method="mdr",
        settings=settings,
        error_estimate={
            **_relative_along(errors, radius, values),
            "pull_off_force": _relative(torn[FORCE], force),
            "pull_off_depth": _relative(lost[DEPTH], lost_depth),
            "pull_off_contact_radius": _relative(lost[RADIUS], lost_radius),
            "force_at_loss": _relative(lost[FORCE], lost_force),
        },
        cost=log.cost(unknowns=getattr(system.flat_punch, "unknowns", 0)),
        stages=log.records,
        notes=_notes(scene, system, radius[0]),
        contact_radius=radius,
        indentation_depth=values[DEPTH],
        normal_force=values[FORCE],
        stable_displacement_control=stable[DEPTH],
        stable_force_control=stable[FORCE],
        pull_off_force=force,
        pull_off_depth=lost_depth,
        pull_off_contact_radius=lost_radius,
        force_at_loss=lost_force,
        critical_points=route.critical_points(),
    )


def _relative_along(errors: FloatArray, radius: FloatArray, values: FloatArray) -> dict[str, FloatArray]:
    """Errors of the states over the largest radius, depth and force."""
    depth_scale, force_scale = np.abs(values).max(axis=1)
    return {
        "contact_radius": errors[RADIUS] / radius.max(),
        "indentation_depth": errors[DEPTH] / depth_scale,
        "normal_force": errors[FORCE] / force_scale,
    }


def solve_adhesive(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> ContactPath:
    """Adhesive equilibria at prescribed radii, depths or forces.

    A depth or force is reached from the undeformed layer: of several stable states the one of smallest radius.

    Raises:
        InvalidInput: If a prescribed value lies beyond pull-off.
        UnsupportedSceneError: If the indenter would touch beside its circle of contact.
    """
    if work_of_adhesion(scene) == 0.0:
        return replace(solve_elastic(scene.replace(effects=()), flat_punch, settings), scene=scene)
    log = StageLog()
    with log.stage("adhesion"):
        found = _prescribed(scene, flat_punch)
        system, radius, depth, errors = found.system, found.radius, found.depth, found.errors
        refuse_touching_beside(scene, system, radius, depth)
        force = np.asarray(system.force(radius, depth))
        if isinstance(scene.loading, NormalForces):
            force = scene.loading.values
        stiffness = np.asarray(system.contact_stiffness(radius))
        springs = 2.0 * system.spring_stiffness(radius)
        # An elongation that is off by so much [m] moves the density's value at the edge by y1 = sqrt(c_bar) of it.
        at_edge = found.edge * np.sqrt(system.flat_punch.normalized_spring_stiffness(radius / system.length_unit))
        known_inside = partial(density_errors, system, scene, radius)
        finer = by_finer_data(solve_adhesive, scene, flat_punch, settings)
        fields = PathFields(scene, system.flat_punch, found.excess, depth, known_inside, at_edge, True, finer)
        pressure = pressure_errors(system, fields, radius, edge=found.edge, moved=errors[RADIUS])
    relative = system.relative_errors(radius)["contact_stiffness"]
    return ContactPath(
        scene=scene,
        method="mdr",
        settings=settings,
        error_estimate={
            "contact_radius": _relative(errors[RADIUS], radius),
            "indentation_depth": _relative(errors[DEPTH], depth),
            "normal_force": _relative(errors[FORCE], force),
            "contact_stiffness": _relative(relative * stiffness + springs * errors[RADIUS], stiffness),  # Eq. (6)
            "pressure": pressure,
        }
        | _displacement_error(system, radius, depth, errors),
        cost=log.cost(unknowns=getattr(system.flat_punch, "unknowns", 0)),
        stages=log.records,
        contact_radius=radius,
        indentation_depth=depth,
        normal_force=force,
        contact_stiffness=stiffness,
        fields=fields,
    )


def _displacement_error(
    system: EquivalentSystem, radius: FloatArray, depth: FloatArray, errors: FloatArray
) -> dict[str, FloatArray]:
    """Of the depth, and beside the edge of the radius: there the surface rises from it by the root of the distance."""
    if system.variants:
        return {}
    hanging = np.abs(system.mdr_profile(radius) - depth)
    beside = 2.0 / np.pi * hanging * np.sqrt(2.0 * errors[RADIUS] / radius)
    return {"surface_displacement": _relative(errors[DEPTH] + beside, depth) + PRESSURE_ROUNDING}


def _relative(errors: FloatArray | float, values: FloatArray | float) -> FloatArray:
    """Errors over the values' largest magnitude, as a path states them; what is exactly zero has no error."""
    largest = np.abs(np.atleast_1d(values)).max()
    return np.atleast_1d(errors) / (largest if largest > 0.0 else 1.0)


def _point_errors(route: Route, bounds: BranchErrors, uncertain: float, y: float) -> FloatArray:
    """Errors of depth, force and radius where contact is lost, or where it pulls most."""
    if MACHINE in route.controls and y in route.folds(MACHINE) and y not in route.branch.section_ends:
        return bounds.of_machine_fold(y, route.compliance)
    return bounds.of_point(y, uncertain)


def _withdrawal(scene: Scene, loading: Detachment, flat_punch: FlatPunchSource) -> tuple[Route, BranchErrors, float]:
    """The way from the first contact radius inwards, errors along it, and how uncertain its start is in y."""
    is_punch = isinstance(scene.indenter, FlatPunch)
    compliance = 1.0 / (loading.machine_stiffness or np.inf)
    if is_punch or loading.initial_contact_radius is not None:
        system, branch = _branch(scene, loading.initial_contact_radius or scene.indenter.max_radius, flat_punch)
        bounds = _bounds(scene, system, branch)
        return Route(branch, float(branch.section_ends[-1]), pinned=is_punch, compliance=compliance), bounds, 0.0
    if work_of_adhesion(scene) == 0.0:
        raise InvalidInput("effects: without work of adhesion nothing says where to start; give initial_contact_radius")
    system, branch = _reaching(scene, flat_punch, lambda b: b.values(b.section_ends[-1:])[FORCE, 0] >= b.strength)
    bounds, start = _bounds(scene, system, branch), branch.solutions(FORCE, np.array([branch.strength]))
    if np.isnan(start[0]):
        return Route(branch, float(branch.section_ends[-1]), pinned=False, compliance=compliance), bounds, 0.0
    strongest = max(float(bounds.of_point(y, 0.0)[FORCE]) for y in branch.folds(FORCE))
    uncertain = float(bounds.shift(FORCE, start, strongest)[0])
    return Route(branch, float(start[0]), pinned=False, compliance=compliance), bounds, uncertain


def _bounds(scene: Scene, system: EquivalentSystem, branch: EquilibriumBranch) -> BranchErrors:
    """Errors along a branch, whose single points may be solved again."""
    again = partial(state_again, system, scene.layer, scene.indenter, work_of_adhesion(scene))
    return BranchErrors(system, branch, lru_cache(maxsize=None)(again))


def _branch(scene: Scene, radius: float, flat_punch: FlatPunchSource) -> tuple[EquivalentSystem, EquilibriumBranch]:
    """Springs and equilibria up to a radius [m]."""
    system = equivalent_system(scene.layer, scene.indenter, radius, flat_punch)
    breakpoints = (scene.indenter.flat_radius, *scene.indenter.breakpoints)
    return system, adhesive_branch(
        system,
        breakpoints=breakpoints,
        radius=radius,
        work_of_adhesion=work_of_adhesion(scene),
        error=system.relative_error["spring_stiffness"],
    )


def _reaching(
    scene: Scene, flat_punch: FlatPunchSource, enough: Callable[[EquilibriumBranch], bool]
) -> tuple[EquivalentSystem, EquilibriumBranch]:
    """A branch that is long enough, or ends at the indenter's rim."""
    for radius in growing_radii(scene.indenter, _first_radius(scene)):
        try:
            system, branch = _branch(scene, radius, flat_punch)
        except InvalidInput as refusal:
            raise InvalidInput(
                f"the adhering contact is sought up to a = {radius:g} m, where the flat-punch data end ({refusal}); "
                "a Detachment may begin at a smaller initial_contact_radius"
            ) from None
        if enough(branch):
            break
    return system, branch


def _first_radius(scene: Scene) -> float:
    """Where the search for a branch that is long enough begins [m]: the half-space's radius, unless the layer is thin.

    On a layer much thinner than that radius the elongation is far shorter than on the half-space.
    """
    flat, thickness = scene.indenter.flat_radius, scene.layer.surface.thickness
    first = flat + FIRST_WAY * (balance_radius(scene) - flat)
    return first if first <= _THIN * thickness else max(FIRST_RATIO * thickness, 2.0 * flat)


def balance_radius(scene: Scene) -> float:
    """The contact radius [m] at which the indenter is as high as the elongation on the half-space is long."""
    length, law = work_of_adhesion(scene) / contact_modulus(scene.layer), power_law(scene.indenter)
    if law is None:
        return radius_of_elongation(scene.indenter, length)
    coefficient, exponent = law
    return float((2.0 * np.pi * length / coefficient**2) ** (1.0 / (2.0 * exponent - 1.0)))


@dataclass(frozen=True)
class _Equilibria:
    """States with prescribed radii, depths or forces.

    Attributes:
        system: Springs and profile.
        radius: a [m], shape (n,).
        excess: a - b [m] over the radius b of the flat end, with the digits that a loses close to it.
        depth: delta [m].
        errors: Of depth [m], force [N] and radius [m], shape (3, n).
        edge: Errors of the elongation at the edge at fixed radius [m], shape (n,).
    """

    system: EquivalentSystem
    radius: FloatArray
    excess: FloatArray
    depth: FloatArray
    errors: FloatArray
    edge: FloatArray


def _prescribed(scene: Scene, flat_punch: FlatPunchSource) -> _Equilibria:
    """The states that the loading asks for."""
    loading = scene.loading
    if isinstance(loading, ContactRadii):
        system = equivalent_system(scene.layer, scene.indenter, float(loading.values[-1]), flat_punch)
        depth = system.mdr_profile(loading.values) - critical_elongation(
            system, loading.values, work_of_adhesion(scene)
        )  # Eq. (41)
        errors = errors_at_radius(system, loading.values, depth)
        moved = np.vstack([errors, np.zeros(depth.size)])
        return _Equilibria(system, loading.values, loading.values - system.flat_radius, depth, moved, errors[DEPTH])
    if not isinstance(loading, IndentationDepths | NormalForces):
        raise UnsupportedSceneError(
            f"loading = {type(loading).__name__}: adhesion needs radii, depths, forces, Detachment"
        )
    quantity = DEPTH if isinstance(loading, IndentationDepths) else FORCE
    if isinstance(scene.indenter, FlatPunch):
        return _on_punch(scene, scene.indenter.radius, quantity, loading.values, flat_punch)
    largest = float(loading.values.max())
    system, branch = _reaching(scene, flat_punch, lambda b: bool(b.values(b.section_ends[-1:])[quantity, 0] >= largest))
    y = branch.solutions(quantity, loading.values)
    _refuse_missing(y, loading.values, branch, quantity)
    depth = loading.values if quantity == DEPTH else branch.values(y)[DEPTH]
    errors, edge = _errors_on_branch(system, branch, quantity, y)
    return _Equilibria(system, branch.radius(y), branch.excess(y, system.flat_radius), depth, errors, edge)


def _errors_on_branch(
    system: EquivalentSystem, branch: EquilibriumBranch, quantity: int, y: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Errors of depth, force and radius of states with a prescribed quantity, which is exact; and at their edges."""
    errors = BranchErrors(system, branch)
    return errors.of_given(quantity, y), errors.of_states(y, np.zeros(y.shape))[DEPTH]


def _on_punch(
    scene: Scene, radius: float, quantity: int, values: FloatArray, flat_punch: FlatPunchSource
) -> _Equilibria:
    """A flat punch keeps its radius down to where the front sets off; then it peels, if it can do so stably."""
    system, branch = _branch(scene, radius, flat_punch)
    stiffness = float(system.contact_stiffness(radius))
    held = values >= branch.values(branch.section_ends[-1:])[quantity, 0]
    y = np.where(held, branch.section_ends[-1], branch.solutions(quantity, values))
    _refuse_missing(y, values, branch, quantity)
    depth = values if quantity == DEPTH else np.where(held, values / stiffness, branch.values(y)[DEPTH])
    linear = system.relative_errors(np.full(values.size, radius))["contact_stiffness"] * np.abs(depth)
    at_rest = np.stack([np.zeros(values.size), linear * stiffness, np.zeros(values.size)])  # Eq. (43)
    if quantity == FORCE:
        at_rest = np.stack([linear, *np.zeros((2, values.size))])
    peeling, edge = _errors_on_branch(system, branch, quantity, y)
    excess = np.where(held, 0.0, branch.excess(y, radius))
    errors = np.where(held, at_rest, peeling)
    return _Equilibria(
        system, np.where(held, radius, branch.radius(y)), excess, depth, errors, np.where(held, at_rest[DEPTH], edge)
    )


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


def _states(
    route: Route, bounds: BranchErrors, uncertain: float
) -> tuple[FloatArray, FloatArray, FloatArray, NDArray[np.bool_]]:
    """Radius, depth and force, their errors (as rows depth, force, radius) and stability by control, radius falling.

    A pinned front comes first: from rest to where it sets off, depth and force are shares of what they are there.
    Errors of depth and force are those at the state's own radius; how far radii may be off, their start alone decides.
    """
    held, branch = _PINNED if route.pinned else 0, route.branch
    share = np.append(np.arange(held) / max(held, 1), np.ones(POINTS - held))
    y = np.append(np.full(held, route.start), route.start * np.linspace(1.0, 0.0, POINTS - held, endpoint=False))
    errors = share * bounds.of_states(y, np.zeros(y.shape))
    errors[RADIUS] = branch.radius(y + uncertain * y / route.start) - branch.radius(y)
    return branch.radius(y), share * branch.values(y), errors, (branch.slopes(y) > 0.0) | (share < 1.0)


def work_of_adhesion(scene: Scene) -> float:
    """The scene's dgamma [J/m^2]."""
    adhesion = scene.effect(Adhesion)
    return 0.0 if adhesion is None else adhesion.work_of_adhesion


def _notes(scene: Scene, system: EquivalentSystem, radius: float) -> tuple[str, ...]:
    """A warning where the contact is likely to lose its circle before the theory lets it detach."""
    layer = scene.layer
    if layer.is_half_space or (layer.is_uniform and (layer.support != "bonded" or layer.poissons_ratio < _CONFINED)):
        return ()
    # The branch's first radius may lie a rounding beyond the data.
    ratio = min(radius / system.length_unit, system.flat_punch.max_ratio)
    asked = min(ratio, _THINNEST)
    smooth = system.flat_punch.smooth_pressure(np.array([0.0, _INSIDE]), np.full(2, asked))
    pressure = smooth / np.sqrt(1.0 - np.array([0.0, _INSIDE]) ** 2)
    if pressure[0] <= pressure[1]:
        return ()
    warning = (
        f"At a/h = {ratio:.3g} the tension under the indenter has a second maximum in its centre: cavitation or "
        "fingering may come before the axisymmetric detachment computed here (Webber et al. 2003)."
    )
    return (warning,)

"""Contacts with friction in SI units: equilibria reached by loading alone, histories, and their surface fields."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from contact import (
    ContactPath,
    ContactRadii,
    DepthHistory,
    FrictionHistory,
    FrictionPath,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    Scene,
    StageLog,
)
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from contact.stated import SAFETY
from fem_reference.contact_set import edge_radius
from fem_reference.equilibria import FemEquilibrium
from fem_reference.fields import FemFields
from fem_reference.friction.growth import Growing, GrowthRecord, StripMaker
from fem_reference.friction.step import RubbedContact, RubbedState, followed, stick_radius
from fem_reference.materials import contact_modulus
from fem_reference.settings import Discretisation

# One pair of strips serves contacts with radii down to this share of its largest.
SERVED = 0.5
# Names of the numbers of a state in an answer.
QUANTITIES = {
    "radius": "contact_radius",
    "depth": "indentation_depth",
    "force": "normal_force",
    "stiffness": "contact_stiffness",
    "stick": "stick_radius",
    "heat": "dissipated_energy",
}
# Error of an edge radius read from pressures, in cells (`contact_set.EDGE_POLYNOMIAL`).
EDGE_UNCERTAIN = 0.1


@dataclass(frozen=True)
class Blend:
    """A state between two touching points, linear in the depth: exact while the set of sliding nodes does not change.

    Attributes:
        contact: the strip.
        before: the touching point before it.
        after: the one after it.
        share: (depth - depth before) / (depth after - depth before).
        modulus: E* [Pa].
    """

    contact: RubbedContact
    before: RubbedState
    after: RubbedState
    share: float
    modulus: float

    @classmethod
    def at(cls, growing: Growing, depth: float, modulus: float) -> Blend:
        """The state at a depth [m], linearly extrapolated before the first and beyond the last touching point."""
        place = int(np.clip(np.searchsorted(growing.depth, depth), 1, len(growing.depth) - 1))
        low, high = growing.depth[place - 1], growing.depth[place]
        share = float((depth - low) / (high - low))
        return cls(growing.contact, growing.states[place - 1], growing.states[place], share, modulus)

    def nodal(self, name: str) -> FloatArray:
        """Interpolated values of an array of `RubbedState`, shape (n,)."""
        before, after = getattr(self.before, name), getattr(self.after, name)
        return np.asarray(before + self.share * (after - before))

    def tractions(self) -> FloatArray:
        """Pressures and radial tractions over E* at the nodes, shape (2 n,)."""
        return np.concatenate([self.nodal("pressure"), self.nodal("shear")])

    def at_radii(self, values: FloatArray, radius: FloatArray) -> FloatArray:
        """A piecewise linear function on the strip at radii [m]."""
        return self.contact.surface.tractions.evaluate(values, radius / self.contact.radius)


@dataclass(frozen=True)
class RubbedFields:
    """Surface fields of a path; satisfies `contact.Fields`."""

    blends: tuple[Blend, ...]

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """Pressure p(r) [Pa]."""
        blend = self.blends[step]
        return blend.modulus * blend.at_radii(blend.nodal("pressure"), radius)

    def tangential_traction(self, radius: FloatArray, step: int) -> FloatArray:
        """Traction q(r) [Pa], positive where the layer is pushed outward, zero outside."""
        blend = self.blends[step]
        return blend.modulus * blend.at_radii(blend.nodal("shear"), radius)

    def slip(self, radius: FloatArray, step: int) -> FloatArray:
        """Outward displacement of the surface since it touched [m], zero outside.

        A moment over w_i is the mean of u_r, weighted by phi_i: it stands for the value at the node.
        """
        blend = self.blends[step]
        moved = (blend.nodal("radial") - blend.nodal("touched")) / blend.contact.surface.resultants
        moved[0] = 0.0
        return blend.contact.radius * blend.at_radii(np.where(blend.nodal("pressure") > 0.0, moved, 0.0), radius)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """Displacement w(r) [m], positive into the layer; zero beyond the mesh."""
        blend, contact = self.blends[step], self.blends[step].contact
        nodal = contact.surface.top_displacements @ blend.tractions()
        return contact.radius * contact.surface.top.evaluate(nodal, radius / contact.radius)


def rubbed_path(
    scene: Scene, settings: Discretisation, *, written: Mapping[str, Setting], log: StageLog
) -> FrictionPath:
    """Equilibria at prescribed radii, depths or forces, each reached from the undeformed layer by loading alone.

    Raises:
        InvalidInput: the contact would reach the end of the profile.
    """
    values: FloatArray = scene.loading.values  # type: ignore[attr-defined]  # `Fem.supports` lets equilibria pass only
    maker, modulus = StripMaker(scene, settings, log), contact_modulus(scene.layer)
    name = {ContactRadii: "radius", IndentationDepths: "depth", NormalForces: "force"}[type(scene.loading)]
    numbers: list[dict[str, float]] = [{}] * len(values)
    errors, blends, meshes, growth = numbers.copy(), {}, [], None
    for step in np.argsort(-values):
        value = float(values[step]) / (modulus if name == "force" else 1.0)
        if growth is None or growth.fine.radius_of(name, value) < SERVED * growth.fine.radius[-1]:
            contacts = maker.fitted(float(values[step]))
            meshes.append(contacts[0].surface.fingerprint)
            with log.stage("grow"):
                growth = GrowthRecord.of(*contacts)
        numbers[step], stated = growth.numbers(name, value), growth.errors(name, value)
        fine, coarse = (Blend.at(strip, numbers[step]["depth"], modulus) for strip in (growth.fine, growth.coarse))
        checks = {**_traction_errors(fine, coarse), "base_force_defect": base_force_defect(fine)}
        errors[step], blends[step] = {QUANTITIES[n]: e for n, e in stated.items()} | checks, fine
    found = {n: np.array([number[n] for number in numbers]) for n in QUANTITIES}
    return FrictionPath(
        scene=scene,
        method="fem",
        settings={**written, "mesh": ", ".join(meshes)},
        error_estimate={n: np.array([error[n] for error in errors]) for n in errors[0]},
        cost=log.cost(unknowns=max(blend.contact.surface.unknowns for blend in blends.values())),
        stages=log.records,
        contact_radius=found["radius"],
        indentation_depth=found["depth"],
        normal_force=modulus * found["force"],
        contact_stiffness=modulus * found["stiffness"],
        stick_radius=found["stick"],
        dissipated_energy=modulus * found["heat"],
        fields=RubbedFields(tuple(blends[step] for step in range(len(values)))),
    )


def _traction_errors(fine: Blend, coarse: Blend) -> dict[str, float]:
    """Errors of p and q by half the cells: root mean square with weight 2 pi r, relative to that of p."""
    radius, weight = (values.ravel() for values in fine.contact.surface.tractions.gauss(2))
    both = [
        [each.contact.surface.tractions.evaluate(each.nodal(name), radius) for name in ("pressure", "shear")]
        for each in (fine, coarse)
    ]
    size = float(weight @ both[0][0] ** 2)
    changes = [SAFETY * sqrt(weight @ (first - second) ** 2 / size) for first, second in zip(*both, strict=True)]
    return dict(zip(("pressure", "tangential_traction"), changes, strict=True))


def base_force_defect(blend: Blend) -> float:
    """|F_base / F - 1|, of the force on the base and that of the indenter: a check of equilibrium."""
    surface = blend.contact.surface
    return abs(
        float(surface.base_forces @ blend.tractions()) / float(surface.resultants @ blend.nodal("pressure")) - 1.0
    )


def rubbed_history(
    scene: Scene, settings: Discretisation, *, written: Mapping[str, Setting], log: StageLog
) -> FrictionHistory:
    """Depths or forces in time, from the undeformed layer, solved at the given instants only.

    Coulomb friction does not depend on the rate. Between two instants the load is monotonic, and `followed` makes the
    steps.

    Raises:
        InvalidInput: a force pulls, or nothing is ever pressed.
    """
    loading, by_depth = scene.loading, isinstance(scene.loading, DepthHistory)
    targets: FloatArray = loading.depth if by_depth else loading.force  # type: ignore[attr-defined]
    largest = float(targets.max())
    if largest <= 0.0 or (not by_depth and targets.min() < 0.0):
        raise InvalidInput(f"a history from {targets.min():g} to {largest:g}: press, and do not pull")
    pressed = scene.replace(loading=(IndentationDepths if by_depth else NormalForces)([largest]))
    contacts = StripMaker(pressed, settings, log).fitted(largest)
    modulus = contact_modulus(scene.layer)
    with log.stage("follow"):
        both = [_states(contact, targets, modulus, by_depth=by_depth) for contact in contacts]
        numbers, coarser = (_numbers(*each, modulus) for each in zip(contacts, both, strict=True))
    fine, states = contacts[0], both[0]
    cell = fine.radius * fine.surface.radii[1] / numbers["contact_radius"].max()
    # Error of radii by the cells they are read from, relative to the largest contact radius.
    reading = {"contact_radius": EDGE_UNCERTAIN * cell, "stick_radius": cell}
    errors = {}
    for name, values in numbers.items():
        if np.any(values) and not (by_depth and name == "indentation_depth"):
            change = SAFETY * np.abs(values - coarser[name]).max() / np.abs(values).max()
            errors[name] = np.full(len(targets), change + reading.get(name, 0.0))
    if by_depth:
        numbers["indentation_depth"], errors["indentation_depth"] = targets, np.zeros(len(targets))
    return FrictionHistory(
        scene=scene,
        method="fem",
        settings={**written, "mesh": fine.surface.fingerprint},
        error_estimate=errors | _checks(fine, states),
        cost=log.cost(unknowns=fine.surface.unknowns),
        stages=log.records,
        time=loading.time,  # type: ignore[attr-defined]
        indentation_depth=numbers["indentation_depth"],
        normal_force=numbers["normal_force"],
        contact_radius=numbers["contact_radius"],
        stick_radius=numbers["stick_radius"],
        dissipated_energy=numbers["dissipated_energy"],
        surface=RubbedFields(tuple(Blend(fine, state, state, 0.0, modulus) for state in states)),
    )


def _states(contact: RubbedContact, targets: FloatArray, modulus: float, *, by_depth: bool) -> list[RubbedState]:
    """States at depths [m] or forces [N]; depths above the surface, which are negative, mean no contact."""
    unit = contact.radius if by_depth else modulus * contact.radius**2
    return followed(contact, [max(0.0, float(target)) / unit for target in targets], by_depth=by_depth)


def _numbers(contact: RubbedContact, states: list[RubbedState], modulus: float) -> dict[str, FloatArray]:
    """Quantities at each instant, in SI units."""
    unit, radii = contact.radius, contact.surface.radii
    return {
        "indentation_depth": unit * np.array([state.depth for state in states]),
        "normal_force": modulus * unit**2 * np.array([state.force for state in states]),
        "contact_radius": unit * np.array([edge_radius(radii, state.pressure) for state in states]),
        "stick_radius": unit * np.array([stick_radius(contact, state) for state in states]),
        "dissipated_energy": modulus * unit**3 * np.array([state.dissipated for state in states]),
    }


def _checks(contact: RubbedContact, states: list[RubbedState]) -> dict[str, FloatArray]:
    """Checks (n,) at the instants, relative to the largest work and force: energy balance, heat, and force on the base.

    They are |work - stored energy - heat|, any decrease of the heat, and |F_base - F|.
    """
    work, heat, force = (np.array([getattr(s, name) for s in states]) for name in ("work", "dissipated", "force"))
    stored = np.array([contact.stored_energy(state) for state in states])
    base = np.array([contact.surface.base_forces @ np.concatenate([s.pressure, s.shear]) for s in states])
    return {
        "energy_defect": np.abs(work - stored - heat) / work.max(),
        "heat_given_back": np.maximum(-np.diff(heat, prepend=0.0), 0.0) / work.max(),
        "base_force_defect": np.abs(base - force) / force.max(),
    }


@dataclass(frozen=True)
class AdheredFemFields(FemFields):
    """Surface fields of a punch that sticks: one solution, scaled by the depth."""

    def tangential_traction(self, radius: FloatArray, step: int) -> FloatArray:
        """Traction q(r) [Pa], positive where the layer is pushed outward, zero outside."""
        state = self.states[step]
        unit = state.contact.contact_trace.evaluate(state.contact.shear_traction, radius / state.contact_radius)
        return self.modulus * state.depth * unit


def with_shear_error(
    path: ContactPath, states: Sequence[FemEquilibrium], coarser: Sequence[FemEquilibrium]
) -> ContactPath:
    """The path with the error of q over the size of p: L2 with the weight ``2 pi r (1 - r^2 / a^2)``, as that of p is.

    The size of q itself would not do: on an incompressible half-space q vanishes.
    """
    contact = states[0].contact
    radius, weight = (values.ravel() for values in contact.contact_trace.gauss(contact.layer.pair.degree + 2))
    weight = weight * (1 - radius**2)
    fine, coarse = (
        each[0].contact.contact_trace.evaluate(each[0].contact.shear_traction, radius) for each in (states, coarser)
    )
    change = np.sqrt(weight @ (fine - coarse) ** 2 / (weight @ contact.pressure(radius, 1.0) ** 2))
    error = np.full(len(path), SAFETY * float(change))
    return replace(path, error_estimate={**path.error_estimate, "tangential_traction": error})

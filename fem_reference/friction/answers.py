"""Contacts with friction in SI units: equilibria reached by loading alone, histories, and their surface fields."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

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
from fem_reference.contact_set import EDGE_ERROR
from fem_reference.equilibria import FemEquilibrium
from fem_reference.fields import FemFields
from fem_reference.friction.growth import GrowthRecord, StripMaker
from fem_reference.friction.step import RubbedState, followed
from fem_reference.materials import contact_modulus
from fem_reference.settings import Discretisation
from fem_reference.stated import contact_rule, l2_change

# Names of the numbers of a state in an answer, and the powers of E* in their units.
QUANTITIES = {
    "radius": ("contact_radius", 0),
    "depth": ("indentation_depth", 0),
    "force": ("normal_force", 1),
    "stiffness": ("contact_stiffness", 1),
    "stick": ("stick_radius", 0),
    "heat": ("dissipated_energy", 1),
}


@dataclass(frozen=True)
class RubbedFields:
    """Surface fields of a path; satisfies `contact.Fields`.

    Attributes:
        states: equilibria of the path.
        modulus: E* [Pa].
    """

    states: Sequence[RubbedState]
    modulus: float

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """Pressure p(r) [Pa]."""
        return self.modulus * self._evaluated(step, self.states[step].pressure, radius)

    def tangential_traction(self, radius: FloatArray, step: int) -> FloatArray:
        """Traction q(r) [Pa], positive where the layer is pushed outward, zero outside."""
        return self.modulus * self._evaluated(step, self.states[step].shear, radius)

    def slip(self, radius: FloatArray, step: int) -> FloatArray:
        """Radial displacement u_r(r) of the surface since the instant of first touch [m], zero outside, shape of r.

        At node i it is the weighted mean ``int phi_i u_r 2 pi r dr / w_i``, with w_i = ``int phi_i 2 pi r dr``. Between
        nodes it is linear.

        Args:
            radius: r [m].
            step: index of the state in the path.
        """
        state = self.states[step]
        slip = (state.radial - state.touched) / state.contact.surface.resultants
        slip[0] = 0.0  # u_r = 0 on the axis
        return state.contact.radius * self._evaluated(step, np.where(state.pressure > 0.0, slip, 0.0), radius)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """Displacement w(r) [m], positive into the layer; zero beyond the mesh."""
        state, surface = self.states[step], self.states[step].contact.surface
        nodal = surface.top_displacements @ state.tractions
        return state.contact.radius * surface.top.evaluate(nodal, radius / state.contact.radius)

    def _evaluated(self, step: int, values: FloatArray, radius: FloatArray) -> FloatArray:
        """Piecewise linear function on the strip of a state with nodal ``values`` (n,), at radii [m]."""
        contact = self.states[step].contact
        return contact.surface.tractions.evaluate(values, radius / contact.radius)


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
    errors, steps, meshes, growth = numbers.copy(), {}, [], None
    for step in np.argsort(-values):
        value = float(values[step]) / (modulus if name == "force" else 1.0)
        if growth is None or not growth.serves(name, value):
            contacts = maker.fitted(float(values[step]))
            meshes.append(contacts[0].surface.fingerprint)
            with log.stage("grow"):
                growth = GrowthRecord.of(*contacts)
        numbers[step], stated = growth.numbers(name, value), growth.errors(name, value)
        fine, coarse = (strip.state_at(numbers[step]["depth"]) for strip in (growth.fine, growth.coarse))
        defect = {"base_force_defect": abs(fine.base_force / fine.force - 1.0)}
        number_errors = {QUANTITIES[n][0]: e for n, e in stated.items()}
        errors[step], steps[step] = number_errors | _traction_errors(fine, coarse) | defect, fine
    quantities: dict[str, Any] = {
        quantity: modulus**power * np.array([number[n] for number in numbers])
        for n, (quantity, power) in QUANTITIES.items()
    }
    return FrictionPath(
        scene=scene,
        method="fem",
        settings={**written, "mesh": ", ".join(meshes)},
        error_estimate={n: np.array([error[n] for error in errors]) for n in errors[0]},
        cost=log.cost(unknowns=max(each.contact.surface.unknowns for each in steps.values())),
        stages=log.records,
        fields=RubbedFields([steps[step] for step in range(len(values))], modulus),
        **quantities,
    )


def _traction_errors(fine: RubbedState, coarse: RubbedState) -> dict[str, float]:
    """Stated errors of p and q from half the cells: L2 norms with weight 2 pi r, relative to that of p."""
    radius, weight = (values.ravel() for values in fine.contact.surface.tractions.gauss(2))
    (p, q), others = (
        [each.contact.surface.tractions.evaluate(values, radius) for values in (each.pressure, each.shear)]
        for each in (fine, coarse)
    )
    changes = [SAFETY * l2_change(weight, *pair, p) for pair in zip((p, q), others, strict=True)]
    return dict(zip(("pressure", "tangential_traction"), changes, strict=True))


def rubbed_history(
    scene: Scene, settings: Discretisation, *, written: Mapping[str, Setting], log: StageLog
) -> FrictionHistory:
    """Response of the undeformed layer to depths or forces in time, solved at the given instants only.

    Coulomb friction does not depend on the rate. Between two instants the load is monotonic, and `followed` divides
    it into steps. A negative depth means no contact.

    Raises:
        InvalidInput: a force is negative, or no depth or force is positive.
    """
    loading, by_depth = scene.loading, isinstance(scene.loading, DepthHistory)
    targets: FloatArray = loading.depth if by_depth else loading.force  # type: ignore[attr-defined]
    largest, modulus = float(targets.max()), contact_modulus(scene.layer)
    if largest <= 0.0 or (not by_depth and targets.min() < 0.0):
        raise InvalidInput(f"a history from {targets.min():g} to {largest:g}: press, and do not pull")
    pressed = scene.replace(loading=(IndentationDepths if by_depth else NormalForces)([largest]))
    runs = []
    for contact in StripMaker(pressed, settings, log).fitted(largest):
        unit = contact.radius if by_depth else modulus * contact.radius**2
        with log.stage("follow"):
            runs.append(followed(contact, [max(0.0, float(target)) / unit for target in targets], by_depth=by_depth))
    fine, coarse = (_numbers(states, modulus) for states in runs)
    contact = runs[0][0].contact
    surface = contact.surface
    cell = contact.radius * surface.radii[1] / fine["contact_radius"].max()
    # Error of radii from the size of cells, relative to the largest contact radius.
    radius_errors = {"contact_radius": EDGE_ERROR * cell, "stick_radius": cell}
    errors = {}
    for name, values in fine.items():
        if np.any(values):
            change = SAFETY * np.abs(values - coarse[name]).max() / np.abs(values).max()
            errors[name] = np.full(len(targets), change + radius_errors.get(name, 0.0))
    if by_depth:
        fine["indentation_depth"], errors["indentation_depth"] = targets, np.zeros(len(targets))
    return FrictionHistory(
        scene=scene,
        method="fem",
        settings={**written, "mesh": surface.fingerprint},
        error_estimate=errors | _checks(runs[0]),
        cost=log.cost(unknowns=surface.unknowns),
        stages=log.records,
        time=loading.time,  # type: ignore[attr-defined]
        surface=RubbedFields(runs[0], modulus),
        **fine,
    )


def _numbers(states: Sequence[RubbedState], modulus: float) -> dict[str, Any]:
    """Quantities at each instant in SI units, by their names in the answer."""
    unit = states[0].contact.radius
    units = {
        "indentation_depth": ("depth", unit),
        "normal_force": ("force", modulus * unit**2),
        "contact_radius": ("radius", unit),
        "stick_radius": ("stick_radius", unit),
        "dissipated_energy": ("dissipated", modulus * unit**3),
    }
    return {name: scale * np.array([getattr(s, own) for s in states]) for name, (own, scale) in units.items()}


def _checks(states: Sequence[RubbedState]) -> dict[str, FloatArray]:
    """Checks (n,) at the instants, relative to the largest work and force: energy balance, heat, and force on the base.

    They are |work - stored energy - heat|, any decrease of the heat, and |F_base - F|.
    """
    work, heat, force, stored, base = (
        np.array([getattr(state, name) for state in states])
        for name in ("work", "dissipated", "force", "stored_energy", "base_force")
    )
    return {
        "energy_defect": np.abs(work - stored - heat) / work.max(),
        "heat_given_back": np.maximum(-np.diff(heat, prepend=0.0), 0.0) / work.max(),
        "base_force_defect": np.abs(base - force) / force.max(),
    }


@dataclass(frozen=True)
class AdheredFemFields(FemFields):
    """Surface fields of a punch that sticks: one solution, proportional to the depth."""

    def tangential_traction(self, radius: FloatArray, step: int) -> FloatArray:
        """Traction q(r) [Pa], positive where the layer is pushed outward, zero outside."""
        state = self.states[step]
        unit = state.contact.contact_trace.evaluate(state.contact.shear_traction, radius / state.contact_radius)
        return self.modulus * state.depth * unit


def with_shear_error(
    path: ContactPath, states: Sequence[FemEquilibrium], coarser: Sequence[FemEquilibrium]
) -> ContactPath:
    """The path with the error of q relative to the norm of p: L2 norms with weight ``2 pi r (1 - r^2 / a^2)``.

    The norm of q itself is no scale: on an incompressible half-space q vanishes.
    """
    contact = states[0].contact
    radius, weight = contact_rule(contact)
    fine, coarse = (
        each[0].contact.contact_trace.evaluate(each[0].contact.shear_traction, radius) for each in (states, coarser)
    )
    change = l2_change(weight * (1 - radius**2), fine, coarse, contact.pressure(radius, 1.0))
    error = np.full(len(path), SAFETY * change)
    return replace(path, error_estimate={**path.error_estimate, "tangential_traction": error})

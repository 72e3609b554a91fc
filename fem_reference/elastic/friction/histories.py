"""Histories of depth or force with friction, forth and back, in SI units."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from contact import (
    DepthHistory,
    ForceHistory,
    FrictionHistory,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    Scene,
    StageLog,
    UnsupportedSceneError,
)
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.material import contact_modulus
from fem_reference.discrete_layer.settings import Discretisation
from fem_reference.elastic.active_set import edge_radius
from fem_reference.elastic.friction.fields import Blend, RubbedFields
from fem_reference.elastic.friction.growth import Growing
from fem_reference.elastic.friction.step import RubbedContact, RubbedState
from fem_reference.elastic.friction.strips import StripMaker
from fem_reference.elastic.friction.walk import followed, stick_radius

# An edge radius is known to this share of a cell (`active_set.EDGE_POLYNOMIAL`).
EDGE_UNCERTAIN = 0.1


def rubbed_history(
    scene: Scene, settings: Discretisation, written: Mapping[str, Setting], log: StageLog
) -> FrictionHistory:
    """A history at its own instants, from the undeformed layer; friction does not know how fast it is gone through.

    Raises:
        InvalidInput: a force pulls, or nothing is ever pressed.
    """
    time, targets, pressed = _prescribed(scene)
    largest = float(targets.max())
    if largest <= 0.0 or (not isinstance(pressed, IndentationDepths) and targets.min() < 0.0):
        raise InvalidInput(f"a history from {targets.min():g} to {largest:g}: press, and do not pull")
    maker = StripMaker(scene.replace(loading=pressed), settings, str(written["solver"]), log)
    fine, coarse, _ = maker.fitted(largest)
    by_depth = isinstance(pressed, IndentationDepths)
    with log.stage("follow"):
        modulus = contact_modulus(scene.layer)
        states, others = (_states(contact, targets, modulus, by_depth=by_depth) for contact in (fine, coarse))
        numbers, coarser = (_numbers(contact, found, modulus) for contact, found in ((fine, states), (coarse, others)))
        if by_depth:
            numbers["indentation_depth"] = coarser["indentation_depth"] = targets
    cell = fine.radius * fine.surface.radii[1] / numbers["contact_radius"].max()
    # What half the cells change, in the worst instant; radii are known to a share of a cell.
    unseen = {"contact_radius": EDGE_UNCERTAIN * cell, "stick_radius": cell}
    errors = {
        name: np.full(len(targets), np.abs(values - coarser[name]).max() / np.abs(values).max() + unseen.get(name, 0.0))
        for name, values in numbers.items()
        if np.any(values)
    }
    return FrictionHistory(
        scene=scene,
        method="fem",
        settings={**written, "mesh": fine.surface.fingerprint},
        error_estimate=errors | _own_checks(fine, states),
        cost=log.cost(unknowns=fine.surface.unknowns),
        stages=log.records,
        time=time,
        indentation_depth=numbers["indentation_depth"],
        normal_force=numbers["normal_force"],
        contact_radius=numbers["contact_radius"],
        stick_radius=numbers["stick_radius"],
        dissipated_energy=numbers["dissipated_energy"],
        surface=RubbedFields(tuple(Blend(Growing(fine, states), state, state, 0.0, modulus) for state in states)),
    )


def _prescribed(scene: Scene) -> tuple[FloatArray, FloatArray, IndentationDepths | NormalForces]:
    """Instants [s], depths [m] or forces [N], and the loading that reaches the largest."""
    loading = scene.loading
    if isinstance(loading, DepthHistory):
        return loading.time, loading.depth, IndentationDepths([float(loading.depth.max())])
    if isinstance(loading, ForceHistory):
        return loading.time, loading.force, NormalForces([float(loading.force.max())])
    raise UnsupportedSceneError(f"loading = {type(loading).__name__}: friction follows histories of depth or force")


def _states(contact: RubbedContact, targets: FloatArray, modulus: float, *, by_depth: bool) -> list[RubbedState]:
    unit = contact.radius if by_depth else modulus * contact.radius**2
    return followed(contact, [max(0.0, float(target)) / unit for target in targets], by_depth=by_depth)


def _numbers(contact: RubbedContact, states: list[RubbedState], modulus: float) -> dict[str, FloatArray]:
    """Everything at each instant, in SI units."""
    unit, radii = contact.radius, contact.surface.radii
    return {
        "indentation_depth": unit * np.array([state.depth for state in states]),
        "normal_force": modulus * unit**2 * np.array([state.force for state in states]),
        "contact_radius": unit * np.array([edge_radius(radii, state.pressure) for state in states]),
        "stick_radius": unit * np.array([stick_radius(contact, state) for state in states]),
        "dissipated_energy": modulus * unit**3 * np.array([state.dissipated for state in states]),
    }


def _own_checks(contact: RubbedContact, states: list[RubbedState]) -> dict[str, FloatArray]:
    """What the indenter's work has that is neither stored nor heat, what heat was given back, what the base misses."""
    work, heat, stored, force, base = np.array(
        [
            (
                state.work,
                state.dissipated,
                contact.stored_energy(state),
                state.force,
                contact.surface.base_forces @ np.concatenate([state.pressure, state.shear]),
            )
            for state in states
        ]
    ).T
    lost = np.diff(heat, prepend=0.0)
    return {
        "energy_defect": np.abs(work - stored - heat) / work.max(),
        "heat_given_back": np.maximum(-lost, 0.0) / work.max(),
        "base_force_defect": np.abs(base - force) / force.max(),
    }

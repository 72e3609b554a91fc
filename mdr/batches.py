"""Impacts and elastic equilibria of many scenes, with results as arrays.

Scenes with the same dimensionless problem (`own_units`) share its solution.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from bem.flat_punch import FlatPunchSource, IntegralEquation
from contact import (
    ContactRadii,
    IndentationDepths,
    InvalidInput,
    NormalForces,
    NotConvergedError,
    Scene,
    UnsupportedSceneError,
)
from contact.answer.one_thread import one_thread
from contact.answer.small_strains import refuse_deep
from contact.records.validation import FloatArray
from mdr.equilibria import solve_elastic
from mdr.many_layers import equilibria_on_layers, takes_part
from mdr.own_units import OwnUnits, is_power_law, own_units

Progress: TypeAlias = Callable[[int, int], None]

_PRESCRIBED = (ContactRadii, IndentationDepths, NormalForces)


@dataclass(frozen=True)
class ImpactResults:
    """Outcome of many impacts, each array of shape (n,).

    Attributes:
        coefficient_of_restitution: e [-].
        contact_time: Duration of the contact [s].
        peak_force: max F_N [N].
        peak_depth: max delta [m].
        peak_contact_radius: max a [m].
        relative_error: Relative errors of these five, in this order, shape (5, n).
    """

    coefficient_of_restitution: FloatArray
    contact_time: FloatArray
    peak_force: FloatArray
    peak_depth: FloatArray
    peak_contact_radius: FloatArray
    relative_error: FloatArray


@dataclass(frozen=True)
class Equilibria:
    """Elastic contacts, each array of shape (n,).

    Attributes:
        contact_radius: Contact radius a [m].
        indentation_depth: delta [m].
        normal_force: Normal force F_N [N].
        contact_stiffness: Contact stiffness k_N [N/m].
    """

    contact_radius: FloatArray
    indentation_depth: FloatArray
    normal_force: FloatArray
    contact_stiffness: FloatArray


@one_thread
def impacts(
    scenes: Sequence[Scene],
    flat_punch: FlatPunchSource,
    *,
    accuracy: float = 1e-9,
    progress: Progress | None = None,
) -> ImpactResults:
    """Restitution, contact time and peaks of many impacts."""
    from mdr.impact.solver import impact_groups  # noqa: PLC0415  # loaded only when asked for

    found, done = np.full((10, len(scenes)), np.nan), 0
    for members, solve in impact_groups(scenes, flat_punch, accuracy):
        found[:, members] = solve(members)
        done += len(members)
        if progress is not None:
            progress(done, len(scenes))
    _refuse_unanswered(scenes, found, found[3])
    time, force, depth, radius = found[1:5]
    return ImpactResults(found[0], time, force, depth, radius, relative_error=found[5:])


@one_thread
def equilibria(scenes: Sequence[Scene], flat_punch: FlatPunchSource, *, progress: Progress | None = None) -> Equilibria:
    """Elastic contacts of scenes with one prescribed radius, depth or force each.

    Power laws on layers of equal ratios share one solution. Contacts of another convex indenter with uniform layers are
    computed together. All other scenes are solved one by one.

    Raises:
        InvalidInput: If a scene lists effects or prescribes more than one value.
        NotConvergedError: If an answer is not finite.
    """
    groups: dict[Hashable, list[int]] = defaultdict(list)
    for number, scene in enumerate(scenes):
        _refuse(number, scene)
        groups[_kind(number, scene)].append(number)
    states, done = np.full((4, len(scenes)), np.nan), 0
    for members in groups.values():
        states[:, members] = _together([scenes[i] for i in members], flat_punch)
        done += len(members)
        if progress is not None:
            progress(done, len(scenes))
    _refuse_unanswered(scenes, states, states[1])
    return Equilibria(*states)


def _refuse_unanswered(scenes: Sequence[Scene], states: FloatArray, depths: FloatArray) -> None:
    """Refuse answers that are not finite, and depths too large for small strains.

    Raises:
        NotConvergedError: With the number of the first scene without a finite answer.
        UnsupportedSceneError: With the number of the scene.
    """
    unknown = np.flatnonzero(~np.isfinite(states).all(axis=0))
    if unknown.size:
        raise NotConvergedError(f"scenes[{unknown[0]}]: no finite answer, nor of {unknown.size - 1} others")
    for number, (scene, depth) in enumerate(zip(scenes, depths.tolist(), strict=True)):
        try:
            refuse_deep(scene, depth)
        except UnsupportedSceneError as error:
            raise UnsupportedSceneError(f"scenes[{number}]: {error}") from None


def _refuse(number: int, scene: Scene) -> None:
    """Refuse scenes with effects, or without one prescribed radius, depth or force."""
    if scene.effects:
        raise InvalidInput(f"scenes[{number}].effects: a batch of equilibria is elastic; leave effects out")
    if not isinstance(scene.loading, _PRESCRIBED) or scene.loading.values.size != 1:
        raise InvalidInput(f"scenes[{number}].loading: give one radius, depth or force a scene")


def _kind(number: int, scene: Scene) -> Hashable:
    """Key of a group of scenes with one solution: dimensionless power law, or one indenter on uniform layers."""
    if not is_power_law(scene.indenter):
        layer = scene.layer.surface
        key = type(scene.loading), layer.poissons_ratio, scene.layer.support, scene.indenter
        return key if takes_part(scene) else number
    shared = own_units(scene.layer, scene.indenter)
    return type(scene.loading), shared.layer, shared.indenter


def _together(scenes: list[Scene], flat_punch: FlatPunchSource) -> FloatArray:
    """Radius, depth, force and stiffness of one group in SI units, shape (4, n)."""
    if not is_power_law(scenes[0].indenter):
        return _on_layers(scenes, flat_punch)
    units = [own_units(scene.layer, scene.indenter) for scene in scenes]
    length, depth, stiffness = (np.array([getattr(unit, name) for unit in units]) for name in OwnUnits.SCALES)
    values = np.array([scene.loading.values[0] for scene in scenes if isinstance(scene.loading, _PRESCRIBED)])
    unit_of = {ContactRadii: length, IndentationDepths: depth, NormalForces: stiffness * depth}
    kind = next(kind for kind in _PRESCRIBED if isinstance(scenes[0].loading, kind))
    ordered, place = np.unique(values / unit_of[kind], return_inverse=True)
    shared: Scene[Any, Any] = Scene(layer=units[0].layer, indenter=units[0].indenter, loading=kind(values=ordered))
    path = solve_elastic(shared, flat_punch, {})
    answers = np.stack([getattr(path, name) for name in path.ARRAYS])
    return np.asarray(answers[:, place] * np.stack([length, depth, stiffness * depth, stiffness]))


def _on_layers(scenes: list[Scene], flat_punch: FlatPunchSource) -> FloatArray:
    """Radius, depth, force and stiffness of one indenter that is no power law, shape (4, n)."""
    states = np.full((4, len(scenes)), np.nan)
    if isinstance(flat_punch, IntegralEquation) and takes_part(scenes[0]):
        states = equilibria_on_layers(scenes, flat_punch.sizes)
    for number in np.flatnonzero(np.isnan(states).any(axis=0)):
        path = solve_elastic(scenes[number], flat_punch, {})
        states[:, number] = np.concatenate([getattr(path, name) for name in path.ARRAYS])
    return states

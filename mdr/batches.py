"""Thousands of scenes at once, results as arrays: impacts, pull-offs and elastic equilibria.

Scenes that are the same in the units of their own layer share all tables; only what differs is computed for each.
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
    Detachment,
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
# Numbers of scenes, and the function that computes the rows of some of them.
Group: TypeAlias = tuple[list[int], Callable[[list[int]], FloatArray]]

_PRESCRIBED = (ContactRadii, IndentationDepths, NormalForces)
# Scenes between two reports of progress.
_CHUNK = 512


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


@dataclass(frozen=True, kw_only=True)
class PullOffs:
    """Where many indenters lose contact, each array of shape (n,).

    Attributes:
        contact_radius: a [m].
        depth: delta [m].
        force: Largest tension on the way, as a negative F_N [N].
    """

    contact_radius: FloatArray
    depth: FloatArray
    force: FloatArray


@dataclass(frozen=True, kw_only=True)
class Equilibria:
    """Elastic contacts, each array of shape (n,).

    Attributes:
        contact_radius: a [m].
        indentation_depth: delta [m].
        normal_force: F_N [N].
        contact_stiffness: k_N [N/m].
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

    found = _solved(scenes, impact_groups(scenes, flat_punch, accuracy), 10, progress, depth_row=3)
    time, force, depth, radius = found[1:5]
    return ImpactResults(found[0], time, force, depth, radius, relative_error=found[5:])


@one_thread
def pull_offs(scenes: Sequence[Scene], flat_punch: FlatPunchSource, *, progress: Progress | None = None) -> PullOffs:
    """Pull-off of many adhering indenters, power laws together and others one by one.

    Args:
        scenes: Scenes whose loading is a detachment.
        flat_punch: Where the flat-punch data come from.
        progress: Told how many of how many scenes are done.

    Raises:
        InvalidInput: If a scene is no detachment.
        NotConvergedError: If an answer is not finite.
    """
    from mdr.pull_offs import pull_off_groups  # noqa: PLC0415  # loaded only when asked for

    for number, scene in enumerate(scenes):
        if not isinstance(scene.loading, Detachment):
            raise InvalidInput(f"scenes[{number}].loading = {type(scene.loading).__name__}: give a Detachment")
    found = _solved(scenes, pull_off_groups(scenes, flat_punch), 3, progress)
    return PullOffs(contact_radius=found[0], depth=found[1], force=found[2])


@one_thread
def equilibria(scenes: Sequence[Scene], flat_punch: FlatPunchSource, *, progress: Progress | None = None) -> Equilibria:
    """Elastic contacts at one prescribed radius, depth or force each.

    Power laws on alike layers share one solution. Any other convex indenter on several plain layers is answered for all
    of them at once; the rest one by one.

    Raises:
        InvalidInput: If a scene lists effects or prescribes more than one value.
        NotConvergedError: If an answer is not finite.
    """
    groups: dict[Hashable, list[int]] = defaultdict(list)
    for number, scene in enumerate(scenes):
        _refuse(number, scene)
        groups[_kind(number, scene)].append(number)
    together = lambda chunk: _together([scenes[i] for i in chunk], flat_punch)  # noqa: E731
    found = _solved(scenes, [(members, together) for members in groups.values()], 4, progress)
    return Equilibria(
        contact_radius=found[0], indentation_depth=found[1], normal_force=found[2], contact_stiffness=found[3]
    )


def _solved(
    scenes: Sequence[Scene], groups: Sequence[Group], rows: int, progress: Progress | None, depth_row: int = 1
) -> FloatArray:
    """Rows of numbers of every scene, shape (rows, n); groups are solved by chunks.

    Raises:
        NotConvergedError: If an answer is not finite.
        UnsupportedSceneError: If a depth is too large for small strains.
    """
    found, done = np.full((rows, len(scenes)), np.nan), 0
    for members, solve in groups:
        for start in range(0, len(members), _CHUNK):
            chunk = members[start : start + _CHUNK]
            found[:, chunk] = solve(chunk)
            done += len(chunk)
            if progress is not None:
                progress(done, len(scenes))
    unknown = np.flatnonzero(~np.isfinite(found).all(axis=0))
    if unknown.size:
        raise NotConvergedError(f"scenes[{unknown[0]}]: no finite answer, nor of {unknown.size - 1} others")
    for number, (scene, depth) in enumerate(zip(scenes, found[depth_row].tolist(), strict=True)):
        try:
            refuse_deep(scene, depth)
        except UnsupportedSceneError as error:
            raise UnsupportedSceneError(f"scenes[{number}]: {error}") from None
    return found


def _refuse(number: int, scene: Scene) -> None:
    if scene.effects:
        raise InvalidInput(f"scenes[{number}].effects: a batch of equilibria is elastic; leave effects out")
    if not isinstance(scene.loading, _PRESCRIBED) or scene.loading.values.size != 1:
        raise InvalidInput(f"scenes[{number}].loading: give one radius, depth or force a scene")


def _kind(number: int, scene: Scene) -> Hashable:
    """What scenes of one group have in common; who takes part in none is a group of its own."""
    if not is_power_law(scene.indenter):
        layer = scene.layer.surface
        alike = type(scene.loading), layer.poissons_ratio, scene.layer.support, scene.indenter
        return alike if takes_part(scene) else number
    shared = own_units(scene.layer, scene.indenter)
    return type(scene.loading), shared.layer, shared.indenter


def _together(scenes: list[Scene], flat_punch: FlatPunchSource) -> FloatArray:
    """Radius, depth, force and stiffness of one group, shape (4, n), from one solution of the shared problem."""
    if not is_power_law(scenes[0].indenter):
        return _on_layers(scenes, flat_punch)
    units = [own_units(scene.layer, scene.indenter) for scene in scenes]
    length, depth, stiffness = (np.array([getattr(one, name) for one in units]) for name in OwnUnits.SCALES)
    values = np.array([scene.loading.values[0] for scene in scenes if isinstance(scene.loading, _PRESCRIBED)])
    unit_of = {ContactRadii: length, IndentationDepths: depth, NormalForces: stiffness * depth}
    kind = next(kind for kind in _PRESCRIBED if isinstance(scenes[0].loading, kind))
    ordered, place = np.unique(values / unit_of[kind], return_inverse=True)
    shared: Scene[Any, Any] = Scene(layer=units[0].layer, indenter=units[0].indenter, loading=kind(values=ordered))
    path = solve_elastic(shared, flat_punch, {})
    answers = np.stack([path.contact_radius, path.indentation_depth, path.normal_force, path.contact_stiffness])
    return np.asarray(answers[:, place] * np.stack([length, depth, stiffness * depth, stiffness]))


def _on_layers(scenes: list[Scene], flat_punch: FlatPunchSource) -> FloatArray:
    """The same of one indenter that is no power law, scenes that must be solved by themselves one by one."""
    found = np.full((4, len(scenes)), np.nan)
    if isinstance(flat_punch, IntegralEquation) and takes_part(scenes[0]):
        found = equilibria_on_layers(scenes, flat_punch.sizes)
    for number in np.flatnonzero(np.isnan(found).any(axis=0)):
        path = solve_elastic(scenes[number], flat_punch, {})
        answers = path.contact_radius, path.indentation_depth, path.normal_force, path.contact_stiffness
        found[:, number] = np.concatenate(answers)
    return found

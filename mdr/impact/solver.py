"""Normal impact of a rigid indenter on an elastic or incompressible viscoelastic layer, Eqs. (47)-(52).

Quasi-static: waves in the layer are neglected.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import TypeAlias

import numpy as np

from bem.flat_punch import FlatPunchSource
from contact import FlatPunch, ImpactHistory, InvalidInput, Scene, StageLog
from contact.answer.small_strains import refuse_deep
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from mdr.equilibria import is_simple, refuse_inadmissible, springs_on
from mdr.impact.blows import OUTCOMES, blow_of, solved
from mdr.impact.history import history
from mdr.method import DEFAULT_ACCURACY
from mdr.radius_search import RadiusSearch

# Accuracies that may be asked for: a coarser one is no impact any more, a finer one is below rounding.
_LEAST_ACCURACY, _BEST_ACCURACY = 1e-4, 1e-13
# Impacts solved together: enough to hide the interpreter, few enough for the cache.
CHUNK = 64
# Contacts of a motion at which pressures are looked at, up to its largest.
_CONTACTS = 6

Progress: TypeAlias = Callable[[int, int], None]


@dataclass(frozen=True, kw_only=True)
class ImpactResults:
    """Outcome of many impacts, each array of shape (n,).

    Attributes:
        coefficient_of_restitution: [-].
        contact_time: [s].
        peak_force: [N].
        peak_depth: [m].
        peak_contact_radius: [m].
        relative_error: Of these five, in this order, shape (5, n).
    """

    coefficient_of_restitution: FloatArray
    contact_time: FloatArray
    peak_force: FloatArray
    peak_depth: FloatArray
    peak_contact_radius: FloatArray
    relative_error: FloatArray


def solve_impact(scene: Scene, flat_punch: FlatPunchSource, settings: Mapping[str, Setting]) -> ImpactHistory:
    """One impact with its whole history.

    Args:
        scene: A scene whose loading is an impact.
        flat_punch: Where the flat-punch data come from.
        settings: Of the method; "accuracy" is the wanted relative accuracy of restitution and peaks.

    Raises:
        NotConvergedError: If the indenter never rebounds.
        InvalidInput: If the contact exceeds the radius of the indenter.
        UnsupportedSceneError: If it would touch outside its largest circle of contact, or pull inside.
    """
    log, known = StageLog(), {"accuracy": DEFAULT_ACCURACY, **settings}
    accuracy = _checked(float(known["accuracy"] or DEFAULT_ACCURACY))
    with log.stage("equivalent_system"):
        blow = blow_of(scene, flat_punch)
    with log.stage("impact"):
        outcome = solved([blow], accuracy)[0]
    _refuse_inadmissible(scene, flat_punch, outcome.in_si(blow)[4])
    return history(blow, outcome, log, known)


def impact_batch(
    scenes: Sequence[Scene],
    flat_punch: FlatPunchSource,
    *,
    accuracy: float = DEFAULT_ACCURACY,
    progress: Progress | None = None,
) -> ImpactResults:
    """Many impacts, those with one kind of tip and the same number of relaxation times together.

    Args:
        scenes: Scenes whose loading is an impact, in any order.
        flat_punch: Where the flat-punch data come from.
        accuracy: Wanted relative accuracy of restitution and peaks.
        progress: Told how many of how many impacts are done.

    Returns:
        Arrays in the order of the scenes. Each entry is what the scene alone would give, to the last digit.
    """
    accuracy = _checked(accuracy)
    blows = [blow_of(scene, flat_punch) for scene in scenes]
    values, errors, done = np.empty((5, len(blows))), np.empty((5, len(blows))), 0
    kinds = [blow.kind for blow in blows]
    for _, group in groupby(sorted(range(len(blows)), key=kinds.__getitem__), key=kinds.__getitem__):
        members = list(group)
        for start in range(0, len(members), CHUNK):
            chunk = members[start : start + CHUNK]
            found = solved([blows[i] for i in chunk], accuracy, chunk)
            for i, one in zip(chunk, found, strict=True):
                values[:, i], errors[:, i] = one.in_si(blows[i]), one.attempt.error[:, one.place]
                refuse_deep(scenes[i], values[3, i])
                _refuse_inadmissible(scenes[i], flat_punch, values[4, i])
            done += len(chunk)
            if progress is not None:
                progress(done, len(blows))
    return ImpactResults(**dict(zip(OUTCOMES, values, strict=True)), relative_error=errors)


def _checked(accuracy: float) -> float:
    """The accuracy.

    Raises:
        InvalidInput: If it is out of reach or worthless.
    """
    if not _BEST_ACCURACY <= accuracy <= _LEAST_ACCURACY:
        raise InvalidInput(f"accuracy = {accuracy:g}: choose between {_BEST_ACCURACY:g} and {_LEAST_ACCURACY:g}")
    return accuracy


def _refuse_inadmissible(scene: Scene, flat_punch: FlatPunchSource, radius: float) -> None:
    """Refuse motions up to a radius [m] during which a contact pulls inside, or the widest one is touched outside.

    Raises:
        UnsupportedSceneError: With the contact radius.
    """
    indenter, flat = scene.indenter, scene.indenter.flat_radius
    is_punch = isinstance(indenter, FlatPunch)
    if is_simple(scene) or (radius <= flat and not is_punch):
        return
    springs = springs_on(scene.layer, indenter, flat_punch)
    if not is_punch:
        RadiusSearch(springs, may_fall=True).refuse_falls(radius)
    radii = np.array([radius]) if is_punch else flat + np.arange(1, _CONTACTS + 1) / _CONTACTS * (radius - flat)
    refuse_inadmissible(scene, springs, springs.state(radii, springs.at(radii), radii if is_punch else None))

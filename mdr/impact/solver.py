"""Normal impact of a rigid indenter on an elastic or incompressible viscoelastic layer, Eqs. (47)-(52).

Quasi-static: waves in the layer are neglected.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Hashable, Mapping, Sequence

import numpy as np

from bem.flat_punch import FlatPunchSource
from contact import FlatPunch, ImpactHistory, InvalidInput, Scene, StageLog
from contact.answer.solution import Setting
from contact.records.validation import FloatArray
from mdr.equilibria import is_simple, refuse_inadmissible, springs_on
from mdr.impact.blows import blow_of, solved
from mdr.impact.history import history
from mdr.method import DEFAULT_ACCURACY
from mdr.radius_search import RadiusSearch

# Accuracies that may be asked for: a coarser one is no impact any more, a finer one is below rounding.
_LEAST_ACCURACY, _BEST_ACCURACY = 1e-4, 1e-13
# Impacts solved together: enough to hide the interpreter, few enough for the cache.
CHUNK = 64
# Contacts of a motion at which pressures are looked at, up to its largest.
_CONTACTS = 6


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
    log, settings = StageLog(), {"accuracy": DEFAULT_ACCURACY, **settings}
    accuracy = _checked(float(settings["accuracy"] or DEFAULT_ACCURACY))
    with log.stage("equivalent_system"):
        blow = blow_of(scene, flat_punch)
    with log.stage("impact"):
        answer = solved([blow], accuracy)[0]
    _refuse_inadmissible(scene, flat_punch, answer.in_si(blow)[4])
    return history(blow, answer, log, settings)


def impact_groups(
    scenes: Sequence[Scene], flat_punch: FlatPunchSource, accuracy: float
) -> list[tuple[list[int], Callable[[list[int]], FloatArray]]]:
    """Numbers of impacts that are solved together, and the function that solves them.

    It returns the five outcomes in SI units and their relative errors, shape (10, n). Each is what the scene alone
    would give, to the last digit.
    """
    blows, kinds = (
        [blow_of(scene, flat_punch, i) for i, scene in enumerate(scenes)],
        defaultdict[Hashable, list[int]](list),
    )
    for blow in sorted(blows, key=lambda blow: blow.level):  # so that few tracks are looked up at once
        kinds[blow.power, blow.rates.size].append(blow.number)

    def solve(chunk: list[int]) -> FloatArray:
        """The five outcomes in SI units and their relative errors of the impacts of these numbers, shape (10, n)."""
        members = [blows[i] for i in chunk]
        answers = solved(members, _checked(accuracy))
        values = np.stack(
            [np.append(answer.in_si(blow), answer.errors) for blow, answer in zip(members, answers, strict=True)]
        )
        for blow, radius in zip(members, values[:, 4], strict=True):
            _refuse_inadmissible(blow.scene, flat_punch, radius)
        return values.T

    return [(group[i : i + CHUNK], solve) for group in kinds.values() for i in range(0, len(group), CHUNK)]


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

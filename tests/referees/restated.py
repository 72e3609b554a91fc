"""The same viscoelastic layer written down in another way: its answer must not change.

Branches in another order, a branch split into two, and another unit of time: three descriptions that a method sees as
different numbers. The unit of time is no power of two, so the mantissa of every time changes.
"""

from collections.abc import Callable, Mapping
from typing import Final

import numpy as np

from cases.declare.quantities import values_of
from cases.units import Units, in_units
from contact import Method, PronySeries, Scene, Solution
from contact.scene.effects import Viscoelasticity

OTHER_TIME: Final = Units(time=3.7)

# Share of a split branch that its first half keeps.
_SHARE: Final = 0.3


def relative_change(values, others):
    """The largest difference over the largest of the first values."""
    return float(np.max(np.abs(values - others)) / max(float(np.max(np.abs(values))), np.finfo(float).tiny))


def _series(scene: Scene) -> PronySeries | None:
    """The scene's relaxation as a Prony series; nothing for an elastic layer or one with a bare dashpot."""
    model = scene.effect(Viscoelasticity)
    if model is None or not model.relaxation.moduli.size:
        return None
    relaxation = model.relaxation
    return PronySeries(
        long_term_shear_modulus=relaxation.long_term_modulus,
        shear_moduli=relaxation.moduli,
        relaxation_times=relaxation.times,
    )


def _with(scene: Scene, series: PronySeries) -> Scene:
    others = tuple(effect for effect in scene.effects if not isinstance(effect, Viscoelasticity))
    return scene.replace(effects=(*others, series))


def in_another_order(scene: Scene) -> Scene | None:
    """The branches from the last to the first; nothing for fewer than two."""
    series = _series(scene)
    if series is None or series.shear_moduli.size < 2:
        return None
    turned = series.replace(
        shear_moduli=series.shear_moduli[::-1].copy(), relaxation_times=series.relaxation_times[::-1].copy()
    )
    return _with(scene, turned)


def with_a_split_branch(scene: Scene) -> Scene | None:
    """The stiffest branch as two of the same relaxation time, one of them last; nothing without branches."""
    series = _series(scene)
    if series is None:
        return None
    stiffest = int(series.shear_moduli.argmax())
    moduli, whole = series.shear_moduli.copy(), float(series.shear_moduli[stiffest])
    moduli[stiffest] = _SHARE * whole
    split = series.replace(
        shear_moduli=np.append(moduli, whole - moduli[stiffest]),
        relaxation_times=np.append(series.relaxation_times, series.relaxation_times[stiffest]),
    )
    return _with(scene, split)


def in_another_time_unit(scene: Scene) -> Scene:
    """The same scene with other numbers for all times."""
    return in_units(scene, OTHER_TIME)


RESTATEMENTS: Mapping[str, tuple[Callable[[Scene], Scene | None], Units]] = {
    "branches in another order": (in_another_order, Units()),
    "a branch split in two": (with_a_split_branch, Units()),
    "another unit of time": (in_another_time_unit, OTHER_TIME),
}


def changes_when_restated(method: Method, answer: Solution, quantities: tuple[str, ...]) -> dict[str, float]:
    """How much each restatement changes an answer, relative to the largest value of each quantity, by name."""
    found: dict[str, float] = {}
    for name, (restate, units) in RESTATEMENTS.items():
        scene = restate(answer.scene)
        if scene is not None:
            other = method.solve(scene)
            found[name] = max(
                relative_change(values_of(answer, q), values_of(other, q) / units.factor(q)) for q in quantities
            )
    return found

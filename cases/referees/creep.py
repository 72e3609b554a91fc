"""A half-space that relaxes under a force that rises in time: what a solver of Maxwell's solids is asked."""

from typing import Any

import numpy as np

from cases.referees.grid import box, deepest, surface
from contact import ForceHistory, Scene, UnsupportedSceneError
from contact.records.validation import FloatArray
from contact.scene.effects import Viscoelasticity


def refused(scene: Scene) -> str:
    """Why a scene is no such history, empty where it is one."""
    viscous, loading = scene.effect(Viscoelasticity), scene.loading
    if viscous is None or len(scene.effects) != 1:
        return "relaxation alone, no other effect"
    if not isinstance(loading, ForceHistory):
        return "a relaxing half-space it presses by a history of the force"
    law = viscous.relaxation
    reasons = {
        "it models half-spaces": not scene.layer.is_half_space,
        "it scales one modulus in time, that of nu = 1/2": not scene.layer.is_incompressible,
        "its solid is a spring beside Maxwell elements": law.viscosity > 0.0 or law.long_term_modulus == 0.0,
        "it is asked for forces that begin at zero, rise at once and never fall": _falls(loading.force),
    }
    return next((reason for reason, there in reasons.items() if there), "")


def _falls(force: FloatArray) -> bool:
    return bool(force[0] != 0.0 or force[1] == 0.0 or np.any(np.diff(force) < 0.0))


def question(scene: Scene, points: int, steps: int) -> tuple[dict[str, Any], float]:
    """Return what to ask, and the unit of length [m]; stresses are over the long-term shear modulus.

    Args:
        scene: such a history.
        points: of the grid, each way.
        steps: of the whole history, at least one in each interval.

    Raises:
        UnsupportedSceneError: if the scene is no such history.
    """
    viscous, loading = scene.effect(Viscoelasticity), scene.loading
    if viscous is None or not isinstance(loading, ForceHistory):
        raise UnsupportedSceneError(refused(scene))
    law = viscous.relaxation
    # Forces that never fall go no deeper than the last one on a solid of compliance J(T) <= 1/G(T); E* is 4 G.
    left = law.long_term_modulus + float(law.moduli @ np.exp(-float(np.ptp(loading.time)) / law.times))
    size = box(scene, deepest(scene, float(loading.force[-1]), 4.0 * left))
    durations = np.diff(loading.time)
    share = durations / durations.sum()
    intervals = [
        {"duration": float(one), "steps": int(np.ceil(steps * part - 1e-9)), "force": float(force)}
        for one, part, force in zip(
            durations, share, loading.force[1:] / (law.long_term_modulus * size**2), strict=True
        )
    ]
    asked = {
        "heights": (np.array(surface(scene, points, size)) / size).tolist(),
        "poisson": scene.layer.poissons_ratio,
        "moduli": (law.moduli / law.long_term_modulus).tolist(),
        "times": law.times.tolist(),
        "intervals": intervals,
    }
    return asked, size

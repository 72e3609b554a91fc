"""A paraboloid pulled off a half-space: what solvers of others are asked, and their states as an answer."""

from collections.abc import Mapping

import numpy as np

from contact import Adhesion, Detachment, DetachmentPath, Paraboloid, Scene, StageLog, UnsupportedSceneError
from contact.answer.solution import Setting
from contact.records.validation import FloatArray


def refused(scene: Scene) -> str:
    """Why a scene is no such detachment, empty where it is one."""
    reasons = {
        "it models half-spaces": not scene.layer.is_half_space,
        "adhesion alone, no other effect": len(scene.effects) != 1 or scene.effect(Adhesion) is None,
        "it has adhesion of paraboloids": not isinstance(scene.indenter, Paraboloid),
        "it takes a detachment by a rigid machine or a force": not _is_plain(scene),
    }
    return next((reason for reason, there in reasons.items() if there), "")


def _is_plain(scene: Scene) -> bool:
    return isinstance(scene.loading, Detachment) and scene.loading.controlled != "machine"


def numbers(scene: Scene) -> dict[str, float]:
    """Radius of curvature R [m], E* [Pa] and work of adhesion [J/m^2].

    Raises:
        UnsupportedSceneError: if the scene is no such detachment.
    """
    adhesion = scene.effect(Adhesion)
    if adhesion is None or not isinstance(scene.indenter, Paraboloid):
        raise UnsupportedSceneError("adhesion of a paraboloid only")
    return {
        "radius": scene.indenter.radius_of_curvature,
        "contact_modulus": scene.layer.youngs_modulus / (1.0 - scene.layer.poissons_ratio**2),
        "work_of_adhesion": adhesion.work_of_adhesion,
    }


def answered(
    scene: Scene,
    found: Mapping[str, FloatArray],
    log: StageLog,
    *,
    method: str,
    settings: Mapping[str, Setting],
    unknowns: int = 1,
    notes: tuple[str, ...] = (),
) -> DetachmentPath:
    """Return states of falling contact radius, the last one where contact is lost; no errors are stated.

    Args:
        scene: a detachment.
        found: contact_radius, indentation_depth, normal_force, shape (n,); force_control, the radius at which the
            branch loses its stability under a prescribed force, shape (1,).
        log: of the solver's stages.
        method: name of the solver.
        settings: of the solver.
        unknowns: of its largest system.
        notes: on the answer.
    """
    radius, force = found["contact_radius"], found["normal_force"]
    by_force = isinstance(scene.loading, Detachment) and scene.loading.control == "force"
    return DetachmentPath(
        scene=scene,
        method=method,
        settings=settings,
        contact_radius=radius,
        indentation_depth=found["indentation_depth"],
        normal_force=force,
        stable_displacement_control=np.ones(radius.size, dtype=bool),
        stable_force_control=radius >= found["force_control"][0],
        pull_off_force=float(force[-1] if by_force else force.min()),
        pull_off_depth=float(found["indentation_depth"][-1]),
        pull_off_contact_radius=float(radius[-1]),
        force_at_loss=float(force[-1]),
        error_estimate={},
        cost=log.cost(unknowns=unknowns),
        stages=log.records,
        notes=notes,
    )

"""The states of an elastic frictionless contact as a path in SI units."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from contact import Adhesion, ContactPath, Fields, Scene, StageLog
from contact.answer.friction import told_of_friction
from fem_reference.discrete_layer.material import contact_modulus
from fem_reference.elastic.path import FemEquilibrium, SurfaceState

# Residuals that are published beside the error estimates.
OWN_CHECKS = ("energy_defect", "patch_defect")


def contact_path(
    scene: Scene,
    equilibria: Sequence[FemEquilibrium],
    settings: Mapping[str, bool | int | float | str | None],
    log: StageLog,
    notes: tuple[str, ...] = (),
    *,
    fields: Callable[[tuple[SurfaceState, ...]], Fields],
) -> ContactPath:
    """The path in SI units; ``fields`` makes the surface fields of its states."""
    modulus = contact_modulus(scene.layer)
    radius = np.array([state.contact.indenter.contact_radius for state in equilibria])
    stiffness = np.array([state.stiffness for state in equilibria])
    states = tuple(state.at_surface(modulus) for state in equilibria)
    force = modulus * radius**2 * np.array([state.force for state in equilibria])
    depth = radius * np.array([state.depth for state in equilibria])
    errors = {name: np.array([state.error[name] for state in equilibria]) for name in equilibria[0].error}
    own_checks = {name: np.array([getattr(s.contact.answer, name) for s in equilibria]) for name in OWN_CHECKS}
    # With adhesion depth and force may cross zero: their errors refer to the largest value along the path.
    if scene.effect(Adhesion) is not None:
        for name in ("indentation_depth", "surface_displacement"):
            errors[name] *= np.abs(depth) / np.abs(depth).max()
        errors["normal_force"] *= np.abs(force) / np.abs(force).max()
    elif not scene.effects:
        notes = (*notes, *told_of_friction(scene.layer, radius))
    meshes = ", ".join(dict.fromkeys(state.contact.layer_mesh.fingerprint for state in equilibria))
    return ContactPath(
        scene=scene,
        method="fem",
        settings={**settings, "mesh": meshes},
        error_estimate=errors | own_checks,
        cost=log.cost(unknowns=max(state.contact.answer.unknowns for state in equilibria)),
        stages=log.records,
        notes=notes,
        contact_radius=radius * np.array([state.radius_factor for state in equilibria]),
        indentation_depth=depth,
        normal_force=force,
        contact_stiffness=modulus * radius * stiffness,
        fields=fields(states),
    )

"""The states of an elastic frictionless contact as a path in SI units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from contact import ContactPath, Fields, Scene, StageLog
from contact.answer.friction import told_of_friction
from contact.answer.solution import Setting
from fem_reference.discrete_layer.material import contact_modulus
from fem_reference.elastic.path import FemEquilibrium


def contact_path(
    scene: Scene, states: Sequence[FemEquilibrium], fields: Fields, settings: Mapping[str, Setting], log: StageLog
) -> ContactPath:
    """The path in SI units at one resolution; it states no errors yet, only the residuals of its own checks."""
    modulus = contact_modulus(scene.layer)
    mesh_radius = np.array([state.contact.contact_radius for state in states])
    radius = np.array([state.contact_radius for state in states])
    meshes = ", ".join(dict.fromkeys(state.contact.layer_mesh.fingerprint for state in states))
    return ContactPath(
        scene=scene,
        method="fem",
        settings={**settings, "mesh": meshes},
        error_estimate={
            name: np.array([getattr(state.contact, name) for state in states])
            for name in ("energy_defect", "patch_defect")
        },
        cost=log.cost(unknowns=max(state.contact.unknowns for state in states)),
        stages=log.records,
        notes=() if scene.effects else told_of_friction(scene.layer, radius),
        contact_radius=radius,
        indentation_depth=mesh_radius * np.array([state.depth for state in states]),
        normal_force=modulus * mesh_radius**2 * np.array([state.force for state in states]),
        contact_stiffness=modulus * mesh_radius * np.array([state.stiffness for state in states]),
        fields=fields,
    )

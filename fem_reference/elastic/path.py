"""Elastic frictionless contact at prescribed radius, or of a flat punch at prescribed depth or force."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from contact import Adhesion, ContactPath, FlatPunch, IndentationDepths, InvalidInput, NormalForces, Scene, StageLog
from contact.answer.friction import told_of_friction
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.material import contact_modulus
from fem_reference.elastic.error_estimate import ContactWithErrors
from fem_reference.elastic.prescribed_radius import PrescribedContact
from fem_reference.elastic.surface_fields import FemFields, SurfaceState

# Residuals that are published beside the error estimates.
OWN_CHECKS = ("energy_defect", "patch_defect")
# Radii over the contact's at which displacements of two degrees are compared.
BESIDE = 1.0 + 2.0 ** np.arange(-6.0, 3.0)
# Solves the contact of a given radius [m].
ContactSolver = Callable[[float], ContactWithErrors]


@dataclass(frozen=True, kw_only=True)
class FemEquilibrium:
    """One state of a path, in units of its contact radius and of E*.

    Attributes:
        contact: the solved contact radius with its error bars.
        depth: delta / a.
        force: F / (E* a^2).
        error: relative error of each reported quantity.
        radius_factor: contact radius over that of the mesh, one up to a last correction.
    """

    contact: ContactWithErrors
    depth: float
    force: float
    error: Mapping[str, float]
    radius_factor: float = 1.0

    @property
    def stiffness(self) -> float:
        """k_N / (E* a) at the corrected radius."""
        answer = self.contact.answer
        return answer.stiffness + answer.stiffness_slope * (self.radius_factor - answer.radius)


def smooth_equilibrium(contact: ContactWithErrors) -> FemEquilibrium:
    """The state in which the pressure vanishes at the contact edge."""
    answer, error = contact.answer, contact.error
    reported = {
        "contact_radius": 0.0,
        "indentation_depth": error["smooth_depth"],
        "normal_force": error["smooth_force"],
        "contact_stiffness": error["stiffness"],
        "pressure": contact.pressure_error,
        "surface_displacement": error["smooth_depth"] + moved_beside(contact, lambda level: level.smooth_depth),
    }
    return FemEquilibrium(
        contact=contact,
        depth=answer.smooth_depth,
        force=answer.smooth_force,
        error=reported,
        radius_factor=answer.radius,
    )


def moved_beside(contact: ContactWithErrors, depth: Callable[[PrescribedContact], float]) -> float:
    """Error of the surface beside the contact by interpolation, over the depth / a that each degree has.

    A flat punch has no depth of smooth contact: nothing is stated then, since that state is not the answer.
    """
    over = abs(depth(contact.answer))
    moved = contact.changes_of(lambda level: level.surface_displacement(BESIDE, depth(level)))
    return float(contact.rate * moved.max() / over) if over > 0.0 else 0.0


def flat_punch_equilibrium(contact: ContactWithErrors, depth: float) -> FemEquilibrium:
    """A flat punch at depth / a; its pressure error is measured with the weight (1 - r^2/a^2), which its edge needs."""
    reported = {
        "contact_radius": 0.0,
        "indentation_depth": 0.0,
        "normal_force": contact.error["stiffness"],
        "contact_stiffness": contact.error["stiffness"],
        "pressure": contact.pressure_error,
        "surface_displacement": contact.error["stiffness"] + moved_beside(contact, lambda _: 1.0),
    }
    return FemEquilibrium(contact=contact, depth=depth, force=contact.answer.force(depth), error=reported)


def equilibria_at_radii(radii: FloatArray, solve: ContactSolver) -> list[FemEquilibrium]:
    """Smooth contact at prescribed radii [m]."""
    return [smooth_equilibrium(solve(float(a))) for a in radii]


def flat_punch_equilibria(scene: Scene, punch: FlatPunch, solve: ContactSolver) -> list[FemEquilibrium]:
    """A flat punch at prescribed depths or forces: one solution, scaled."""
    contact = solve(punch.radius)
    loading, a = scene.loading, punch.radius
    if isinstance(loading, IndentationDepths):
        return [flat_punch_equilibrium(contact, depth / a) for depth in loading.values]
    if isinstance(loading, NormalForces):
        unit = contact_modulus(scene.layer) * a**2 * contact.answer.stiffness
        return [_known_force(flat_punch_equilibrium(contact, force / unit)) for force in loading.values]
    raise InvalidInput(f"loading = {type(loading).__name__}: a flat punch takes depths or forces")


def _known_force(state: FemEquilibrium) -> FemEquilibrium:
    """Depth carries the error when the force is prescribed."""
    error = dict(state.error) | {"indentation_depth": state.error["normal_force"], "normal_force": 0.0}
    return FemEquilibrium(contact=state.contact, depth=state.depth, force=state.force, error=error)


def contact_path(
    scene: Scene,
    equilibria: Sequence[FemEquilibrium],
    settings: Mapping[str, bool | int | float | str | None],
    log: StageLog,
    notes: tuple[str, ...] = (),
    *,
    fields: Callable[[tuple[SurfaceState, ...]], FemFields] = FemFields,
) -> ContactPath:
    """The path in SI units; ``fields`` makes the surface fields of its states."""
    modulus = contact_modulus(scene.layer)
    radius = np.array([state.contact.indenter.contact_radius for state in equilibria])
    stiffness = np.array([state.stiffness for state in equilibria])
    states = tuple(surface_state(state, modulus) for state in equilibria)
    force = modulus * radius**2 * np.array([state.force for state in equilibria])
    depth = radius * np.array([state.depth for state in equilibria])
    errors = {name: np.array([state.error[name] for state in equilibria]) for name in equilibria[0].error}
    own_checks = {name: np.array([getattr(s.contact.answer, name) for s in equilibria]) for name in OWN_CHECKS}
    # With adhesion depth and force may cross zero: their errors refer to the largest value along the path.
    if scene.effect(Adhesion) is not None:
        errors["indentation_depth"] *= np.abs(depth) / np.abs(depth).max()
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


def surface_state(state: FemEquilibrium, modulus: float) -> SurfaceState:
    """What the surface fields of a state are made of; the modulus is E* [Pa]."""
    contact, order = state.contact, state.contact.settings.order
    return SurfaceState(
        contact=contact.answer,
        contact_radius=contact.indenter.contact_radius,
        depth=state.depth,
        contact_modulus=modulus,
        other=contact.levels[order - 1 if order - 1 in contact.levels else order + 1],
        error=max(state.error[name] for name in ContactPath.ARRAYS),
        missed=abs(state.radius_factor - 1),
    )

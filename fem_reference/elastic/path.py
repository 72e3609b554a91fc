"""States of an elastic frictionless contact at prescribed radius, or of a flat punch at prescribed depth or force."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from contact import ContactPath, FlatPunch, IndentationDepths, InvalidInput, NormalForces, Scene
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.material import contact_modulus
from fem_reference.elastic.beside_contact import moved_beside, pressed_punch_error, root_at_edge
from fem_reference.elastic.error_estimate import ContactWithErrors
from fem_reference.elastic.prescribed_radius import PrescribedContact

# Solves the contact of a given radius [m].
ContactSolver = Callable[[float], ContactWithErrors]


@dataclass(frozen=True)
class SurfaceState:
    """One equilibrium: a contact of radius one, its scale and its depth.

    Attributes:
        contact: the discrete answer.
        contact_radius: a [m].
        depth: delta / a.
        contact_modulus: E* [Pa].
        other: that of the neighbouring degree on the same mesh.
        error: relative error of depth, force, radius and stiffness, the largest of them.
        of_depth: relative error of the depth.
        unshown: the part of the depth's relative error that a higher degree does not show.
        missed: share of the radius by which the solved contact misses that of the state, edge cell included.
    """

    contact: PrescribedContact
    contact_radius: float
    depth: float
    contact_modulus: float
    other: PrescribedContact
    error: float
    of_depth: float
    unshown: float
    missed: float


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
        """k_N / (E* a) at the corrected radius, by its power of the radius here: one where h >> a, two to four else."""
        answer = self.contact.answer
        power = answer.stiffness_slope * answer.radius / answer.stiffness
        return float(answer.stiffness * (self.radius_factor / answer.radius) ** power)

    def at_surface(self, modulus: float) -> SurfaceState:
        """What fields of this state are computed from; ``modulus`` is E* [Pa]."""
        contact, order = self.contact, self.contact.settings.order
        return SurfaceState(
            contact=contact.answer,
            contact_radius=contact.indenter.contact_radius,
            depth=self.depth,
            contact_modulus=modulus,
            other=contact.levels[order - 1 if order - 1 in contact.levels else order + 1],
            error=max(self.error[name] for name in ContactPath.ARRAYS),
            of_depth=self.error["indentation_depth"],
            unshown=_unshown_error(self),
            missed=missed_radius(self),
        )


def smooth_equilibrium(contact: ContactWithErrors) -> FemEquilibrium:
    """The state in which the pressure vanishes at the contact edge."""
    answer, error = contact.answer, contact.error
    reported = {
        "contact_radius": 0.0,
        "indentation_depth": error["smooth_depth"],
        "normal_force": error["smooth_force"],
        "contact_stiffness": error["stiffness"],
        "pressure": contact.pressure_error,
        "surface_displacement": contact.coarse_edge_error["smooth_depth"]
        + moved_beside(contact, lambda level: level.smooth_depth),
    }
    return FemEquilibrium(
        contact=contact,
        depth=answer.smooth_depth,
        force=answer.smooth_force,
        error=reported,
        radius_factor=answer.radius,
    )


def flat_punch_equilibrium(contact: ContactWithErrors, depth: float) -> FemEquilibrium:
    """A flat punch at depth / a; its pressure error is measured with the weight (1 - r^2/a^2), which its edge needs."""
    reported = {
        "contact_radius": 0.0,
        "indentation_depth": 0.0,
        "normal_force": contact.error["stiffness"],
        "contact_stiffness": contact.error["stiffness"],
        "pressure": contact.pressure_error,
        "surface_displacement": pressed_punch_error(contact),
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


def _unshown_error(state: FemEquilibrium) -> float:
    """The part of the depth's relative error that a higher degree does not show; with adhesion all of it."""
    contact, smooth = state.contact, state.contact.answer.smooth_depth
    if smooth == 0.0:
        return max(contact.coarse_edge_error["stiffness"], state.error["indentation_depth"])
    pulled = abs(state.depth / smooth - 1.0)
    if state.radius_factor == contact.answer.radius and pulled > 0.0:
        return max(state.error[name] for name in ContactPath.ARRAYS)
    return contact.coarse_edge_error["smooth_depth"] + pulled * root_at_edge(contact, missed_radius(state))


def missed_radius(state: FemEquilibrium) -> float:
    """Share of the radius by which the solved contact may miss the true one: known, uncertain, and by its edge cell."""
    return abs(state.radius_factor - 1) + max(state.error["contact_radius"], state.contact.edge_shift)

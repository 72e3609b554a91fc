"""States of an elastic frictionless contact at prescribed radius, or of a flat punch at prescribed depth or force."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from contact import IndentationDepths, InvalidInput, NormalForces, Scene
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.material import contact_modulus
from fem_reference.elastic.prescribed_radius import PrescribedContact

# Solves the contact of a given radius [m].
ContactSolver = Callable[[float], PrescribedContact]


@dataclass(frozen=True, kw_only=True)
class FemEquilibrium:
    """One state of a path at one resolution, in units of the mesh's contact radius and of E*.

    Attributes:
        contact: the solved contact.
        depth: delta / a.
        force: F / (E* a^2).
        radius_factor: contact radius over that of the mesh, one up to a last correction.
    """

    contact: PrescribedContact
    depth: float
    force: float
    radius_factor: float = 1.0

    @property
    def contact_radius(self) -> float:
        """Contact radius [m]."""
        return self.radius_factor * self.contact.contact_radius

    @property
    def stiffness(self) -> float:
        """k_N / (E* a) at the corrected radius, by its power of the radius here: one where h >> a, two to four else."""
        contact = self.contact
        power = contact.stiffness_slope * contact.radius / contact.stiffness
        return float(contact.stiffness * (self.radius_factor / contact.radius) ** power)

    def pressure(self, radius: FloatArray) -> FloatArray:
        """p / E* at radii [m]."""
        return self.contact.pressure(radius / self.contact.contact_radius, self.depth)

    def surface_displacement(self, radius: FloatArray) -> FloatArray:
        """u_z [m] on the top at radii [m]; zero beyond the mesh."""
        a = self.contact.contact_radius
        return a * self.contact.surface_displacement(radius / a, self.depth)


def smooth_equilibrium(contact: PrescribedContact) -> FemEquilibrium:
    """The state in which the pressure vanishes at the contact edge."""
    return FemEquilibrium(
        contact=contact, depth=contact.smooth_depth, force=contact.smooth_force, radius_factor=contact.radius
    )


def flat_punch_equilibria(scene: Scene, radius: float, solve: ContactSolver) -> list[FemEquilibrium]:
    """A flat punch of a radius [m] at prescribed depths or forces: one solution, scaled."""
    contact, loading = solve(radius), scene.loading
    if isinstance(loading, IndentationDepths):
        depths = loading.values / radius
    elif isinstance(loading, NormalForces):
        depths = loading.values / (contact_modulus(scene.layer) * radius**2 * contact.stiffness)
    else:
        raise InvalidInput(f"loading = {type(loading).__name__}: a flat punch takes depths or forces")
    return [FemEquilibrium(contact=contact, depth=depth, force=contact.force(depth)) for depth in map(float, depths)]

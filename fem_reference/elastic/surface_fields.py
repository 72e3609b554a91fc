"""Pressure and displacement of the surface at every step of a path, in SI units."""

from __future__ import annotations

from dataclasses import dataclass

from contact.records.validation import FloatArray
from fem_reference.elastic.interior import Section
from fem_reference.elastic.prescribed_radius import PrescribedContact


@dataclass(frozen=True)
class SurfaceState:
    """One equilibrium: a contact of radius one, its scale and its depth.

    Attributes:
        contact: the discrete answer.
        contact_radius: a [m].
        depth: delta / a.
        contact_modulus: E* [Pa].
    """

    contact: PrescribedContact
    contact_radius: float
    depth: float
    contact_modulus: float


@dataclass(frozen=True)
class FemFields:
    """Surface fields of a path; satisfies `contact.Fields`."""

    states: tuple[SurfaceState, ...]

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa]."""
        state = self.states[step]
        return state.contact_modulus * state.contact.pressure(radius / state.contact_radius, state.depth)

    def section(self, step: int = 0) -> Section:
        """Displacement and stress inside the layer."""
        state = self.states[step]
        return Section(state.contact, state.contact_radius, state.depth, state.contact_modulus)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m], positive into the layer; zero beyond the mesh, where it is below the truncation error."""
        state = self.states[step]
        return state.contact_radius * state.contact.surface_displacement(radius / state.contact_radius, state.depth)

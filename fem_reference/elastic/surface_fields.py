"""Pressure and displacement of the surface at every step of a path, in SI units."""

from __future__ import annotations

from dataclasses import dataclass

from contact.answer.inside import KnownContact
from contact.records.validation import FloatArray
from fem_reference.elastic.inside.interior import FemInterior
from fem_reference.elastic.inside.section import MeridianSection
from fem_reference.elastic.path import SurfaceState


@dataclass(frozen=True)
class FemFields:
    """Surface fields of a path; satisfies `contact.Fields`."""

    states: tuple[SurfaceState, ...]

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa]."""
        state = self.states[step]
        return state.contact_modulus * state.contact.pressure(radius / state.contact_radius, state.depth)

    def inside(self, step: int, known: KnownContact) -> FemInterior:
        """The layer under one step; the error of the pressure is measured anew inside."""
        state = self.states[step]
        moved = state.other.smooth_depth - state.contact.smooth_depth
        return FemInterior(
            section=MeridianSection(state.contact, state.depth),
            other=MeridianSection(state.other, state.depth + moved),
            contact_radius=state.contact_radius,
            contact_modulus=state.contact_modulus,
            own_error=state.error,
            depth_error=state.of_depth,
            unshown_error=state.unshown,
            missed=state.missed,
        )

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m], positive into the layer; zero beyond the mesh, where it is below the truncation error."""
        state = self.states[step]
        return state.contact_radius * state.contact.surface_displacement(radius / state.contact_radius, state.depth)

"""Pressure and displacement of the surface at every step of a path, in SI units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from contact.answer.inside import KnownContact
from contact.records.validation import FloatArray
from fem_reference.elastic.inside.interior import FemInterior
from fem_reference.elastic.inside.section import MeridianSection
from fem_reference.elastic.path import FemEquilibrium


@dataclass(frozen=True)
class FemFields:
    """Surface fields of a path; satisfies `contact.Fields`.

    Attributes:
        states: the equilibria.
        modulus: E* [Pa].
        coarser: the equilibria of the companion, which tell the errors of fields inside.
    """

    states: Sequence[FemEquilibrium]
    modulus: float
    coarser: Sequence[FemEquilibrium] = ()

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa]."""
        return self.modulus * self.states[step].pressure(radius)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m], positive into the layer; zero beyond the mesh, where it is below the truncation error."""
        return self.states[step].surface_displacement(radius)

    def inside(self, step: int, known: KnownContact) -> FemInterior:
        """The layer under one step; the error of the pressure is measured anew inside."""
        fine, coarse = (MeridianSection(path[step].contact, path[step].depth) for path in (self.states, self.coarser))
        return FemInterior(fine, coarse, self.modulus)

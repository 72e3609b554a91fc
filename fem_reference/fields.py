"""Pressure, traction and displacement of the surface at every step of a path, in SI units."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from contact.answer.inside import KnownContact
from contact.records.validation import FloatArray
from fem_reference.equilibria import FemEquilibrium
from fem_reference.inside import FemInterior, MeridianSection


@dataclass(frozen=True)
class FemFields:
    """Surface fields of a path; satisfies `contact.Fields`.

    Attributes:
        states: the equilibria.
        modulus: E* [Pa].
        coarser: the equilibria of the companion, for the errors of fields inside.
    """

    states: Sequence[FemEquilibrium]
    modulus: float
    coarser: Sequence[FemEquilibrium] = ()

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """Pressure p(r) [Pa]."""
        return self.modulus * self.states[step].pressure(radius)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """Displacement w(r) [m], positive into the layer; zero beyond the mesh, where it is below its error."""
        return self.states[step].surface_displacement(radius)

    def inside(self, step: int, known: KnownContact) -> FemInterior:
        """Fields inside the layer at one step; their errors are estimated there."""
        fine, coarse = (MeridianSection(path[step].contact, path[step].depth) for path in (self.states, self.coarser))
        return FemInterior(fine, coarse, self.modulus)

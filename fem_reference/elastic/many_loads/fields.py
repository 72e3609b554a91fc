"""Surface fields of interpolated states: a step's contact is solved when somebody asks for it."""

from __future__ import annotations

from dataclasses import dataclass, field

from contact.answer.inside import KnownContact
from contact.answer.one_thread import one_thread
from contact.records.validation import FloatArray
from fem_reference.elastic.inside.interior import FemInterior
from fem_reference.elastic.loaded_contact import LoadedContact
from fem_reference.elastic.path import ContactSolver
from fem_reference.elastic.surface_fields import FemFields


@dataclass(frozen=True)
class FieldsOnDemand:
    """Surface fields of a path; a step's contact is solved when it is asked for, at the radius found for it.

    Attributes:
        solve: contact of a given radius [m].
        radii: of the steps [m].
        loads: depths [m] or forces / E* [m^2].
        by_depth: which of them.
        modulus: E* [Pa].
    """

    solve: ContactSolver
    radii: tuple[float, ...]
    loads: tuple[float, ...]
    by_depth: bool
    modulus: float
    _last: dict[int, FemFields] = field(default_factory=dict, repr=False)

    @one_thread
    def of_step(self, step: int) -> FemFields:
        """Those of one step; the last that was asked for is kept."""
        if step not in self._last:
            contact = self.solve(self.radii[step])
            load = self.loads[step] / contact.indenter.contact_radius ** (1 if self.by_depth else 2)
            state = LoadedContact(
                contact=contact, load=load, by_depth=self.by_depth, radius_factor=contact.answer.radius
            ).equilibrium
            self._last.clear()
            self._last[step] = FemFields((state.at_surface(self.modulus),))
        return self._last[step]

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa]."""
        return self.of_step(step).pressure(radius, 0)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m], positive into the layer; zero beyond the mesh."""
        return self.of_step(step).surface_displacement(radius, 0)

    def inside(self, step: int, known: KnownContact) -> FemInterior:
        """The layer under one step."""
        return self.of_step(step).inside(0, known)

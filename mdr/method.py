"""The method record: which scenes the method of dimensionality reduction models, and the call that solves them."""

from __future__ import annotations

import dataclasses
from typing import Annotated, ClassVar, Self, overload

from pydantic import Field

from bem.flat_punch import FlatPunchSource, IntegralEquation
from contact import (
    ContactPath,
    Detachment,
    DetachmentPath,
    EquilibriumLoading,
    HistoryLoading,
    HistoryPath,
    Impact,
    ImpactHistory,
    Scene,
    Solution,
    Supported,
    Unsupported,
    UnsupportedSceneError,
)
from contact.answer.no_contact import without_contact
from contact.answer.one_thread import one_thread
from contact.answer.small_strains import within_small_strains
from contact.answer.solution import Setting
from contact.records.record import Record, record
from contact.records.validation import in_range
from mdr.dispatch import DEFAULT_ACCURACY, solver_of

# The coarsest accuracy that time steps are chosen for: what coarser steps would save is too little to be measured.
COARSEST = 1e-4


@record
class Mdr(Record):
    """Method of dimensionality reduction, section 2 of Forsbach (2023).

    Attributes:
        flat_punch: Where the flat punch's stiffness and pressure come from.
        accuracy: Wanted relative accuracy of what is integrated in time (impacts, histories). Coarser ones than
            `COARSEST` are answered by it; what does not move is more accurate whatever is asked.
    """

    name: ClassVar[str] = "mdr"

    flat_punch: FlatPunchSource = Field(default_factory=IntegralEquation)
    accuracy: Annotated[float, *in_range(1e-13, 0.1, "1e-9 costs twice as much as 1e-6")] = DEFAULT_ACCURACY

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Contact of any profile with layers and half-spaces: elastic, adhesive, or incompressible and viscoelastic."""
        solver = solver_of(scene)
        return solver if isinstance(solver, Unsupported) else Supported()

    @overload
    def solve(self, scene: Scene[EquilibriumLoading]) -> ContactPath: ...
    @overload
    def solve(self, scene: Scene[Detachment]) -> DetachmentPath: ...
    @overload
    def solve(self, scene: Scene[Impact]) -> ImpactHistory: ...
    @overload
    def solve(self, scene: Scene[HistoryLoading]) -> HistoryPath: ...
    @overload
    def solve(self, scene: Scene) -> Solution: ...
    @one_thread
    @within_small_strains
    @without_contact
    def solve(self, scene: Scene) -> Solution:
        """The answer to the scene: a contact path, a detachment path, an impact or a history.

        Raises:
            UnsupportedSceneError: If the scene is not modelled, or the contact would not be one circle.
            InvalidInput: If the loading is out of reach of the indenter or the flat-punch data.
            NotConvergedError: If a motion does not end.
        """
        solver = solver_of(scene)
        if isinstance(solver, Unsupported):
            raise UnsupportedSceneError(solver.reason)
        return solver.load()(scene, self.flat_punch, self._settings())

    def refined(self) -> Self:
        """Flat-punch data with half the discretisation length; one more digit in time, from the default on."""
        accuracy = max(min(0.1 * self.accuracy, DEFAULT_ACCURACY), 1e-13)
        return self.replace(flat_punch=self.flat_punch.refined(), accuracy=accuracy)

    def _settings(self) -> dict[str, Setting]:
        source = self.flat_punch
        settings: dict[str, Setting] = {"accuracy": min(self.accuracy, COARSEST), "flat_punch": type(source).__name__}
        if dataclasses.is_dataclass(source):
            values = {f.name: getattr(source, f.name) for f in dataclasses.fields(source)}
            settings |= {name: v for name, v in values.items() if isinstance(v, bool | int | float | str | None)}
        return settings

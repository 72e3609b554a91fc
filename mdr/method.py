"""The method record: which scenes the method of dimensionality reduction models, and the call that solves them."""

from __future__ import annotations

import dataclasses
from typing import ClassVar, Self

from pydantic import Field

from bem.flat_punch import FlatPunchSource
from bem.integral_equation import IntegralEquation
from contact import (
    ContactPath,
    ContactRadii,
    IndentationDepths,
    NormalForces,
    Scene,
    Supported,
    Unsupported,
    UnsupportedSceneError,
)
from contact.record import Record, record
from contact.solution import Setting
from mdr.elastic import solve_elastic


@record
class Mdr(Record):
    """Method of dimensionality reduction, section 2 of Forsbach (2023).

    Attributes:
        flat_punch: Where the flat punch's stiffness and pressure come from.
    """

    name: ClassVar[str] = "mdr"

    flat_punch: FlatPunchSource = Field(default_factory=IntegralEquation)

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Elastic contact of any profile with layers and half-spaces."""
        if scene.effects:
            names = ", ".join(type(effect).__name__ for effect in scene.effects)
            return Unsupported(f"mdr does not model {names}")
        if not isinstance(scene.loading, ContactRadii | IndentationDepths | NormalForces):
            return Unsupported(f"mdr does not model the loading {type(scene.loading).__name__} without effects")
        return Supported()

    def solve(self, scene: Scene) -> ContactPath:
        """Equilibria of the scene.

        Raises:
            UnsupportedSceneError: If the scene is not modelled, or the contact would not be one circle.
            InvalidInput: If the loading is out of reach of the indenter or the flat-punch data.
        """
        support = self.supports(scene)
        if isinstance(support, Unsupported):
            raise UnsupportedSceneError(support.reason)
        return solve_elastic(scene, self.flat_punch, self._settings())

    def refined(self) -> Self:
        """Flat-punch data with half the discretisation length."""
        return self.replace(flat_punch=self.flat_punch.refined())

    def _settings(self) -> dict[str, Setting]:
        source = self.flat_punch
        settings: dict[str, Setting] = {"flat_punch": type(source).__name__}
        if dataclasses.is_dataclass(source):
            values = {f.name: getattr(source, f.name) for f in dataclasses.fields(source)}
            settings |= {name: v for name, v in values.items() if isinstance(v, bool | int | float | str | None)}
        return settings

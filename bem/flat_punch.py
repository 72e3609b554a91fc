"""Sources of flat-punch data of a layer: settings of the integral equation, and the interface of tables."""

from __future__ import annotations

from typing import Annotated, Final, Protocol, Self, runtime_checkable

from pydantic import Field

from bem.equation import USUAL, Sizes
from contact.records.record import Record
from contact.records.validation import positive

# Default and largest number of nodes, and its increase in refined settings.
USUAL_NODES: Final = 24
MOST_NODES: Final = 64
MORE_NODES: Final = 4


class IntegralEquation(Record):
    """Resolution of the integral equation of the layer.

    Attributes:
        nodes: Number of nodes per panel.
        panel_width: Width of a panel over the thickness of the layer. nodes/panel_width scales `bem.equation.Sizes`.
    """

    nodes: int = Field(default=USUAL_NODES, ge=4, le=MOST_NODES)
    panel_width: Annotated[float, *positive("panels about as wide as the layer is thick")] = 1.0

    @property
    def sizes(self) -> Sizes:
        """All sizes of the discretisation."""
        return USUAL.scaled(self.nodes / USUAL_NODES / self.panel_width)

    def refined(self) -> Self:
        """Settings with about twice the resolution."""
        return self.replace(panel_width=self.panel_width / 2, nodes=min(self.nodes + MORE_NODES, MOST_NODES))


@runtime_checkable
class FlatPunchSource(Protocol):
    """Source of the flat-punch data of MDR: `IntegralEquation`, or a table (`bem.tables`)."""

    @property
    def sizes(self) -> Sizes:
        """Sizes of the discretisation of the integral equation that springs use."""

    def refined(self) -> Self:
        """Settings with half the discretisation length."""

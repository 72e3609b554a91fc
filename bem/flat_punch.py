"""Where the flat punches of a layer come from: settings of the integral equation, and what tables have to offer."""

from __future__ import annotations

from typing import Annotated, Final, Protocol, Self, runtime_checkable

from pydantic import Field

from bem.equation import USUAL, Sizes
from contact.records.record import Record
from contact.records.validation import positive

# Nodes by default, and the most; a refined setting has so many more.
USUAL_NODES: Final = 24
MOST_NODES: Final = 64
MORE_NODES: Final = 4


class IntegralEquation(Record):
    """Resolution of the layer's equation.

    Attributes:
        nodes: Resolution per panel.
        panel_width: Width of a panel over the layer's thickness; with nodes it scales all sizes of the discretisation.
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
    """Settings of where the flat punches of MDR come from: `IntegralEquation`, or a table (`bem.tables`)."""

    @property
    def sizes(self) -> Sizes:
        """Sizes of the discretisation of springs."""

    def refined(self) -> Self:
        """A copy with half the discretisation length."""

"""A kind of figure made of panels in rows, each panel drawn from one record or group of records."""

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Generic, TypeVar

from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from reports.figures.axes_grid import axes_of, numbered_parts
from reports.figures.figure import Cell, ReportFigure

P = TypeVar("P")


def nothing_shared(drawing: Drawing, axes: list[Axes], drawn: list[Any]) -> None:
    """Add nothing; a function of the module, because charts are sent to processes that draw them."""


@dataclass(frozen=True, kw_only=True)
class PanelChart(Generic[P]):
    """What all figures of one kind share.

    Attributes:
        title: one line.
        caption: what is shown, symbols and uncertainties explained.
        columns: heads of the data, with units.
        rows: the data of one panel.
        panel: draws one panel.
        size: width and height of a panel [inches].
        across: panels in a row.
        a_figure: panels that fit on one figure: one page.
        finish: adds what all panels share, from the axes and what `panel` returned of each.
    """

    title: str
    caption: str
    columns: tuple[str, ...]
    rows: Callable[[P], Iterable[tuple[Cell, ...]]]
    panel: Callable[[Axes, P], Any]
    size: tuple[float, float]
    across: int = 2
    a_figure: int = 6
    finish: Callable[[Drawing, list[Axes], list[Any]], None] = nothing_shared

    def figure(self, name: str, panels: Sequence[P]) -> ReportFigure:
        """One figure of these panels."""
        return ReportFigure(
            name=name,
            title=self.title,
            caption=self.caption,
            paint=partial(self.draw, panels),
            columns=self.columns,
            rows=tuple(row for panel in panels for row in self.rows(panel)),
        )

    def figures(self, name: str, panels: Sequence[P]) -> list[ReportFigure]:
        """As many figures as the panels fill, numbered from one."""
        return [self.figure(f"{name}-{number}", part) for number, part in numbered_parts(panels, self.a_figure)]

    def draw(self, panels: Sequence[P]) -> Drawing:
        """The picture: panels in rows."""
        columns = min(self.across, len(panels))
        width, height = self.size
        size = width * columns, height * math.ceil(len(panels) / columns)
        drawing = Drawing(figsize=size, layout="constrained")
        all_axes = axes_of(drawing, len(panels), columns)
        self.finish(drawing, all_axes, [self.panel(axes, panel) for axes, panel in zip(all_axes, panels, strict=True)])
        return drawing

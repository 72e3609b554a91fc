"""A figure of the report with what belongs to it: picture, data and caption, and the files it is written to."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure as Drawing

from cases.results.csv_table import csv_text
from cases.results.files import write_whole
from reports.style import figure_bytes, figure_style, svg_text

Cell = str | float | int | bool | None


@dataclass(frozen=True, kw_only=True)
class ReportFigure:
    """A figure of the report.

    Attributes:
        name: file name without ending, unique in the run: "truncated_cone-work-precision-a_h-2".
        title: one line.
        caption: what is shown, symbols and uncertainties explained.
        paint: makes the picture; called inside the common figure style, maybe in another process.
        columns: heads of the data, with units.
        rows: the data drawn, digit for digit those of results.json.
    """

    name: str
    title: str
    caption: str
    paint: Callable[[], Drawing]
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]

    def csv_text(self) -> str:
        """The data as CSV; floats keep all digits that tell them apart, a missing number is an empty cell."""
        return csv_text(self.columns, self.rows)


def write_figure(figure: ReportFigure, directory: Path) -> str:
    """Write NAME.svg, NAME.png and NAME.csv into `directory` and return the SVG for the page."""
    with figure_style():
        drawing = figure.paint()
        _lay_out(drawing)
        svg = svg_text(drawing, key=figure.name)
        write_whole(directory / f"{figure.name}.png", figure_bytes(drawing, ".png", key=figure.name))
    write_whole(directory / f"{figure.name}.svg", svg)
    write_whole(directory / f"{figure.name}.csv", figure.csv_text())
    return svg


def _lay_out(drawing: Drawing) -> None:
    """Lay out once, so that both files show the same picture, and nothing is drawn a third time for it."""
    engine = drawing.get_layout_engine()
    if engine is not None:
        engine.execute(drawing)
        drawing.set_layout_engine("none")

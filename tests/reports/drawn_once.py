"""Equal figures are drawn once a session: most tests of pages read words, and drawing took most of their time."""

import pickle
from pathlib import Path

from cases.results.files import write_whole
from reports.figures.figure import ReportFigure, write_figure

_DRAWN: dict[bytes, tuple[str, bytes]] = {}


def write_figure_once(figure: ReportFigure, directory: Path) -> str:
    """Write the files of `write_figure` and return its SVG; an equal figure of earlier gives its picture."""
    key = pickle.dumps(figure)
    if key not in _DRAWN:
        svg = write_figure(figure, directory)
        _DRAWN[key] = svg, (directory / f"{figure.name}.png").read_bytes()
    svg, png = _DRAWN[key]
    write_whole(directory / f"{figure.name}.png", png)
    write_whole(directory / f"{figure.name}.svg", svg)
    write_whole(directory / f"{figure.name}.csv", figure.csv_text())
    return svg

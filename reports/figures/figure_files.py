"""The figures of a page: each written as SVG, PNG and CSV, and shown on the page while there is room."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from markupsafe import Markup

from cases.run.executors import process_pool, serial
from reports.figures.figure import ReportFigure, write_figure

FOLDER = "figures"
# Bytes of SVG on one page; what comes later lies in the folder only, and the page says so.
ROOM = 3_000_000
EMPTY = Markup("")
# So many pictures are drawn by one process: nine took 1.7 s alone and 2.3 s with a second one, which has to start
# first (2026-11-22). Where the two are level was not measured.
FEW = 16


@dataclass(kw_only=True)
class PlacedFigure:
    """A figure's place on the page.

    Attributes:
        figure: what is shown.
        command: one shell line that makes the numbers and the figure again.
        svg: empty until it is drawn, and if there was no room.
        folder: where its files lie.
    """

    figure: ReportFigure
    command: str
    svg: Markup = EMPTY
    folder: str = FOLDER


class FigureFolder:
    """Draws figures into DIRECTORY/figures.

    Args:
        directory: where the page stands.
        room: bytes of SVG that fit on the page.
    """

    def __init__(self, directory: Path, *, room: int = ROOM) -> None:
        self._folder = directory / FOLDER
        self._folder.mkdir(parents=True, exist_ok=True)
        self._room = room
        self._placed: dict[str, PlacedFigure] = {}

    def place(self, figures: Iterable[ReportFigure], command: str) -> tuple[PlacedFigure, ...]:
        """Return the places of the figures on the page, in its order; `draw` fills them.

        Raises:
            ValueError: if a name comes twice; the files of one would overwrite those of the other.
        """
        return tuple(self._place(PlacedFigure(figure=figure, command=command)) for figure in figures)

    def _place(self, placed: PlacedFigure) -> PlacedFigure:
        name = placed.figure.name
        if name in self._placed:
            raise ValueError(f"two figures are called {name!r}; rename one")
        return self._placed.setdefault(name, placed)

    def draw(self, jobs: int = 1) -> None:
        """Draw all that is placed, in `jobs` processes if it is much; the pictures are the same."""
        factory = process_pool if jobs > 1 and len(self._placed) > FEW else serial
        places = list(self._placed.values())
        with factory(jobs) as pool:
            drawn = pool.map(partial(write_figure, directory=self._folder), [place.figure for place in places])
            for place, svg in zip(places, drawn, strict=True):
                self._room -= len(svg)
                place.svg = Markup(svg if self._room >= 0 else "")

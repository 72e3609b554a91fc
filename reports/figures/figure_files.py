"""The pictures of a page: each written as SVG, PNG and CSV, and hung on the page while there is room."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from markupsafe import Markup

from cases.run.executors import process_pool, serial
from reports.figures.figure import Plate, write_plate

FOLDER = "figures"
ROOM = 3_000_000
"""Bytes of SVG on one page; what comes later lies in the folder only, and the page says so."""
EMPTY = Markup("")
FEW = 8
"""So many pictures are drawn sooner than a second process has started."""


@dataclass(kw_only=True)
class Hung:
    """A plate's place on the page; `svg` is empty until it is drawn, and if there was no room.

    `folder` is where its files lie.
    """

    plate: Plate
    svg: Markup = EMPTY
    folder: str = FOLDER


class Gallery:
    """Draws plates into DIRECTORY/figures.

    Args:
        directory: where the page stands.
        room: bytes of SVG that fit on the page.
    """

    def __init__(self, directory: Path, *, room: int = ROOM) -> None:
        self._folder = directory / FOLDER
        self._folder.mkdir(parents=True, exist_ok=True)
        self._room = room
        self._hung: dict[str, Hung] = {}

    def hang(self, plates: Iterable[Plate]) -> tuple[Hung, ...]:
        """Return the places of the plates on the page, in its order; `draw` fills them.

        Raises:
            ValueError: if a name comes twice; the files of one would overwrite those of the other.
        """
        return tuple(self._place(plate) for plate in plates)

    def _place(self, plate: Plate) -> Hung:
        if plate.name in self._hung:
            raise ValueError(f"two figures are called {plate.name!r}; rename one")
        return self._hung.setdefault(plate.name, Hung(plate=plate))

    def draw(self, jobs: int = 1) -> None:
        """Draw all that hangs, in `jobs` processes if it is much; the pictures are the same."""
        factory = process_pool if jobs > 1 and len(self._hung) > FEW else serial
        places = list(self._hung.values())
        with factory(jobs) as pool:
            drawn = pool.map(partial(write_plate, directory=self._folder), [place.plate for place in places])
            for place, svg in zip(places, drawn, strict=True):
                self._room -= len(svg)
                place.svg = Markup(svg if self._room >= 0 else "")

"""The pictures of a page: each written as SVG, PNG and CSV, and hung on the page while there is room."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from markupsafe import Markup

from reports.plates import Plate, write_plate

FOLDER = "figures"
ROOM = 3_000_000
"""Bytes of SVG on one page; what comes later lies in the folder only, and the page says so."""


@dataclass(frozen=True, kw_only=True)
class Hung:
    """A plate on the page; `svg` is empty when there was no room. `folder` is where its files lie."""

    plate: Plate
    svg: Markup
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
        self._names: set[str] = set()

    def hang(self, plates: Iterable[Plate]) -> tuple[Hung, ...]:
        """Draw the plates and return them for the page.

        Raises:
            ValueError: if a name comes twice; the files of one would overwrite those of the other.
        """
        return tuple(self._hung(plate) for plate in plates)

    def _hung(self, plate: Plate) -> Hung:
        if plate.name in self._names:
            raise ValueError(f"two figures are called {plate.name!r}; rename one")
        self._names.add(plate.name)
        svg = write_plate(plate, self._folder)
        self._room -= len(svg)
        return Hung(plate=plate, svg=Markup(svg if self._room >= 0 else ""))

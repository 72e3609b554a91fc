"""Finished scenes of a campaign in one file, a line each, so that a campaign that was stopped goes on."""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, Final

from cases.measurements.measurement import Measurement
from cases.results.status import Status
from contact import InvalidInput

NAME: Final = "scenes.jsonl"


class KeptScenes:
    """The file of a folder: a first line that says what campaign it is, then the rows of one scene a line.

    Args:
        folder: Where the file lies or is made.
        key: Of everything that the rows depend on.
        resume: Whether scenes of an earlier campaign with this key stay; a new file is begun if not.

    Raises:
        InvalidInput: If the scenes that lie there are of another campaign or of other code.
    """

    def __init__(self, folder: Path, key: str, *, resume: bool) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._path = folder / NAME
        if resume and self._path.exists():
            self._without_torn_line()
            self._check(key)
        else:
            self._path.write_text(json.dumps({"key": key}) + "\n", encoding="utf-8")

    def read(self) -> Iterator[tuple[int, list[Measurement]]]:
        """Numbers of the finished scenes with their rows.

        Raises:
            InvalidInput: If a line is none of this program.
        """
        with self._path.open(encoding="utf-8") as file:
            next(file)
            for place, line in enumerate(file, 2):
                try:
                    number, whole, quantities = json.loads(line)
                    yield int(number), _read(whole, quantities)
                except (ValueError, TypeError) as error:
                    words = f"{self._path}, line {place}, holds no scene ({type(error).__name__})"
                    raise InvalidInput(f"{words}; delete that line") from None

    def add(self, lines: str) -> None:
        """Keep finished scenes, as `as_line` writes them."""
        with self._path.open("a", encoding="utf-8") as file:
            file.write(lines)

    def _without_torn_line(self) -> None:
        """Cut off the line that was being written when the program was killed."""
        with self._path.open("r+b") as file:
            file.truncate(file.read().rfind(b"\n") + 1)

    def _check(self, key: str) -> None:
        with self._path.open(encoding="utf-8") as file:
            if file.readline() != json.dumps({"key": key}) + "\n":
                raise InvalidInput(f"{self._path} is of another campaign or other code; leave out --resume")


def as_line(number: int, rows: Sequence[Measurement]) -> str:
    """A finished scene as one line of the file."""
    whole, *quantities = rows
    trees = _differences(whole, Measurement(method="")), [_differences(row, whole) for row in quantities]
    return json.dumps([number, *trees], separators=(",", ":"), default=float) + "\n"


def _differences(row: Measurement, other: Measurement) -> dict[str, Any]:
    """The fields that are not the other's."""
    values = ((one.name, getattr(row, one.name)) for one in fields(row))
    return {name: value for name, value in values if value != getattr(other, name)}


def _read(tree: Mapping[str, Any], quantities: Sequence[Mapping[str, Any]]) -> list[Measurement]:
    whole = Measurement(**{**tree, "status": Status(tree.get("status", Status.PASS))})
    return [whole, *(replace(whole, **row) for row in quantities)]

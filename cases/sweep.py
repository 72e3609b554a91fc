"""A scene solved over a range of one of its numbers: a table of answers, one row per state."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from cases.declare.quantities import single_numbers
from cases.declare.uncertain_inputs import part_of, place_of, range_ends, with_part
from cases.files import csv_text
from contact import UNITS, ContactError, InvalidInput, Method, Scene, Solution
from contact.records.errors import shown
from contact.records.record import unit_of
from contact.records.validation import FloatArray, range_of

if TYPE_CHECKING:
    import pandas

_EXAMPLE: Final = 'write "thickness=1um..10um:20", with ":log" behind it for equal factors'
_FORM: Final = re.compile(r"\s*([\w.]+)\s*=\s*(.+?)\s*\.\.\s*(.+?)\s*:\s*(\d{1,6})(:log)?\s*")


@dataclass(frozen=True, kw_only=True)
class Swept:
    """Range of a varied number of a scene.

    Attributes:
        name: Name of the varied field; of two equal names with the part of the scene before a dot.
        values: Values of the number in SI units, shape (n,).
        unit: SI unit, empty for a pure number.
    """

    name: str
    values: FloatArray
    unit: str


@dataclass(frozen=True, kw_only=True)
class Sweep:
    """The answers along a range.

    Attributes:
        swept: Varied number and its range.
        answers: Values with an answer, each with it.
        refused: Values without an answer, each with the reason.
    """

    swept: Swept
    answers: tuple[tuple[float, Solution], ...]
    refused: tuple[tuple[float, str], ...]

    @property
    def columns(self) -> dict[str, FloatArray]:
        """The table by its heads: the varied number, quantities with their units, and their stated uncertainties."""
        rows = [row for value, answer in self.answers for row in _rows(self.swept, value, answer)]
        return {head: np.array([row[head] for row in rows]) for head in (rows[0] if rows else {})}

    def to_csv(self) -> str:
        """The table as CSV text in SI units."""
        rows = zip(*(values.tolist() for values in self.columns.values()), strict=True)
        return csv_text(self.columns, rows)

    def to_frame(self) -> pandas.DataFrame:
        """The table as a data frame.

        Raises:
            InvalidInput: If pandas is not installed.
        """
        try:
            import pandas as pd  # noqa: PLC0415 - an optional package
        except ImportError:
            raise InvalidInput("a frame needs pandas; install it, or read the CSV file") from None
        return pd.DataFrame(self.columns)


def read_range(text: str, scene: Scene, *, with_units: bool = False) -> Swept:
    """Read "thickness=1um..10um:20"; with `with_units` the ends need units, as the other values have.

    Raises:
        InvalidInput: For what is no such text, or no single number of the scene.
    """
    match = _FORM.fullmatch(text)
    if match is None:
        raise InvalidInput(f"over {shown(text)}: {_EXAMPLE}")
    name, start, stop, count, log = match.groups()
    part, field = place_of(scene, name, "over")
    record = part_of(scene, part)
    if isinstance(getattr(record, field), np.ndarray):
        raise InvalidInput(f"over {shown(name)}: it is a list of numbers; vary a single one")
    unit = unit_of(type(record), field)
    start, stop = range_ends(f"over {name}", (start, stop), unit, with_units)
    span = {"start": _end(start), "stop": _end(stop), "count": int(count), "spacing": "log" if log else "linear"}
    try:
        return Swept(name=name, values=range_of(span, unit), unit=unit or "")
    except ValueError as error:
        raise InvalidInput(f"over {name}: {error}") from None


def sweep(scene: Scene, over: str | Swept, method: Method, progress: Callable[[int, int], None] | None = None) -> Sweep:
    """Solve the scene for every value of a range; a value that is refused is kept with its reason.

    Args:
        scene: Scene with any value of the varied number.
        over: Range as text, or as returned by `read_range`.
        method: Method that solves the scenes.
        progress: Function called with the numbers of finished and of all values.

    Raises:
        InvalidInput: For a wrong range.
    """
    swept = read_range(over, scene) if isinstance(over, str) else over
    answers: list[tuple[float, Solution]] = []
    refused: list[tuple[float, str]] = []
    for number, value in enumerate(swept.values.tolist(), 1):
        try:
            answers.append((value, method.solve(_changed(scene, swept.name, value))))
        except ContactError as error:
            refused.append((value, str(error)))
        if progress is not None:
            progress(number, swept.values.size)
    return Sweep(swept=swept, answers=tuple(answers), refused=tuple(refused))


def _end(text: str) -> object:
    """An end of a range: a number if it has no unit, else the text."""
    try:
        return float(text)
    except ValueError:
        return text


def _changed(scene: Scene, name: str, value: float) -> Scene:
    part, field = place_of(scene, name, "over")
    return with_part(scene, part, part_of(scene, part).replace(**{field: value}))


def _rows(swept: Swept, value: float, answer: Solution) -> Iterator[dict[str, float]]:
    """Rows of an answer: one of its single numbers, or else one per state."""
    names = list(single_numbers(answer)) or list(answer.ARRAYS)
    states = {name: np.atleast_1d(getattr(answer, name)) for name in names}
    for step in range(len(states[names[0]])):
        row = {_head(swept.name, swept.unit): value}
        for name, values in states.items():
            row[_head(name, UNITS[name])] = float(values[step])
            stated = name in answer.error_estimate
            uncertain = np.broadcast_to(answer.uncertainty(name), values.shape)[step] if stated else np.nan
            row[_head(f"{name}_uncertainty", UNITS[name])] = float(uncertain)
        yield row


def _head(name: str, unit: str) -> str:
    return name if unit in ("", "1") else f"{name} [{unit}]"

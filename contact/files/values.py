"""Lists of numbers in scene files: written out, with a unit, as a range, or as the column of a CSV file."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from contact.files.scene_text import MAX_BYTES
from contact.files.units import factor_of, in_si
from contact.records.errors import InvalidInput, printable
from contact.records.record import shown
from contact.records.validation import LARGEST, MAX_ENTRIES, FloatArray

RANGE: Final = frozenset({"start", "stop", "count", "spacing"})
_COLUMN: Final = frozenset({"file", "column", "unit"})
# Tables of a scene file stand at most so deep below its top.
_DEEPEST: Final = 4
_HEAD: Final = re.compile(r"(?P<name>[^\[(]*?)\s*(?:[\[(](?P<unit>[^\])]*)[\])])?")


@dataclass(frozen=True)
class Column:
    """Numbers of a CSV file.

    Attributes:
        name: Of the column, empty without a header.
        unit: As the header says it in brackets, or empty.
        values: Shape (n,).
    """

    name: str
    unit: str
    values: FloatArray


def vector(value: object, unit: str | None, place: str) -> Any:
    """A list of numbers in SI; what is no list, range or column is returned as it came.

    Raises:
        InvalidInput: If a range, a column or a unit is not right.
    """
    if isinstance(value, Column):
        return in_si_units(value, unit, place)
    if isinstance(value, Mapping) and value and value.keys() <= RANGE:
        return _range(value, unit, place)
    if unit is None or isinstance(value, str | bytes) or not isinstance(value, Sequence):
        return value
    if any(isinstance(entry, str) for entry in value):
        return [in_si(entry, unit, f"{place}[{i}]") for i, entry in enumerate(value)]
    return value


def with_columns(mapping: Mapping[str, Any], folder: Path | None, depth: int = 0) -> dict[str, Any]:
    """The mapping with every table that names a file, as in `values = {file = "a.csv", column = "depth"}`, read.

    Args:
        mapping: Of a scene, or a table of one.
        folder: That files are named relative to; None where no file may be named.
        depth: Of the table in the scene.

    Raises:
        InvalidInput: If a file cannot be read or has no such column.
    """
    return {key: _read(value, folder, depth) for key, value in mapping.items()}


def _read(value: object, folder: Path | None, depth: int) -> object:
    if not isinstance(value, Mapping) or depth >= _DEEPEST:
        return value
    if "file" in value and value.keys() <= _COLUMN:
        return column(value, folder)
    return with_columns(value, folder, depth + 1)


def column(table: Mapping[str, Any], folder: Path | None) -> Column:
    """The column that a table {file, column, unit} names; without a name or number, the first.

    Raises:
        InvalidInput: If the file cannot be read or has no such column.
    """
    if folder is None:
        raise InvalidInput(f"file = {shown(table['file'])}: only scene files name other files; give the numbers")
    if not isinstance(table["file"], str):
        raise InvalidInput(f"file = {shown(table['file'])}: must be the name of a CSV file")
    wanted, unit = table.get("column", 0), table.get("unit", "")
    columns = read_columns(folder / table["file"])
    names = [one.name for one in columns]
    number = names.index(wanted) if isinstance(wanted, str) and wanted in names else wanted
    if isinstance(number, bool) or not isinstance(number, int) or not 0 <= number < len(columns):
        known = ", ".join(filter(None, names)) or f"columns 0 to {len(columns) - 1}"
        raise InvalidInput(f"column = {shown(wanted)}: {table['file']} has no such column; it has {known}")
    if not isinstance(unit, str):
        raise InvalidInput(f"unit = {shown(unit)}: must be a text, such as um")
    return Column(columns[number].name, unit or columns[number].unit, columns[number].values)


def read_columns(file: Path) -> list[Column]:
    """All columns of a CSV file: comma, semicolon, tab or blank between, "#" before comments, a header or none.

    Raises:
        InvalidInput: If the file cannot be read, is too large, or holds something that is no number.
    """
    try:
        with file.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        raise InvalidInput(f"{file}: cannot be read ({getattr(error, 'strerror', None) or error})") from None
    if len(content) > MAX_BYTES:
        raise InvalidInput(f"{file}: more than {MAX_BYTES} bytes; keep fewer points")
    lines = content.decode("utf-8-sig", errors="replace").splitlines()
    kept = [(i, line) for i, line in enumerate(lines, 1) if line.strip() and not line.lstrip().startswith("#")]
    rows = [(i, _cells(line)) for i, line in kept[: MAX_ENTRIES + 1]]
    if not rows:
        raise InvalidInput(f"{file}: holds no numbers")
    head = rows[0][1] if any(_number(cell) is None for cell in rows[0][1]) else None
    return _columns(file, head or [""] * len(rows[0][1]), rows if head is None else rows[1:])


def _cells(line: str) -> list[str]:
    separator = next((s for s in (";", "\t", ",") if s in line), None)
    cells = line.split() if separator is None else next(csv.reader([line], delimiter=separator))
    return [cell.strip() for cell in cells]


def _columns(file: Path, head: list[str], rows: list[tuple[int, list[str]]]) -> list[Column]:
    if not rows:
        raise InvalidInput(f"{file}: a header, but no numbers below it")
    values = np.empty((len(rows), len(head)))
    for i, (line, cells) in enumerate(rows):
        numbers = [_number(cell) for cell in cells]
        if len(numbers) != len(head) or None in numbers:
            cells_shown = printable(", ".join(cells)[:80])
            raise InvalidInput(f"{file}, line {line}: {cells_shown!r} is not {len(head)} finite numbers")
        values[i] = [math.nan if number is None else number for number in numbers]
    parts = [_HEAD.fullmatch(name) for name in head]
    names = [
        (part["name"] or "", part["unit"] or "") if part else (name, "") for part, name in zip(parts, head, strict=True)
    ]
    return [Column(name, unit, values[:, i]) for i, (name, unit) in enumerate(names)]


def _number(cell: str) -> float | None:
    try:
        number = float(cell)
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def in_si_units(one: Column, unit: str | None, place: str) -> FloatArray:
    """The numbers of a column in the SI unit given; a column without a unit of its own is taken to have it.

    Raises:
        InvalidInput: If its unit is unknown or of another kind.
    """
    if not one.unit or unit is None:
        return one.values
    factor = factor_of(one.unit, unit, f"{place}, column {shown(one.name)}")
    # Division by a power of ten rounds once, and gives the double closest to the number in SI.
    return one.values / float(1 / factor) if factor < 1 else one.values * float(factor)


def _range(table: Mapping[str, Any], unit: str | None, place: str) -> FloatArray:
    """Values from start to stop, both included, evenly spaced or by equal factors."""
    missing = [name for name in ("start", "stop", "count") if name not in table]
    if missing:
        raise InvalidInput(
            f"{place}.{missing[0]} is missing; a range is written {{start = 0, stop = 1e-6, count = 20}}"
        )
    count, spacing = table["count"], table.get("spacing", "linear")
    if isinstance(count, bool) or not isinstance(count, int) or not 2 <= count <= MAX_ENTRIES:
        raise InvalidInput(f"{place}.count = {shown(count)}: must be a whole number from 2 to {MAX_ENTRIES}")
    if spacing not in ("linear", "log"):
        raise InvalidInput(f'{place}.spacing = {shown(spacing)}: must be "linear" or "log"')
    start, stop = (_end(table[name], unit, f"{place}.{name}") for name in ("start", "stop"))
    if spacing == "log" and min(start, stop) <= 0.0:
        raise InvalidInput(f"{place}: equal factors need ends above 0, got {start:g} and {stop:g}")
    return np.linspace(start, stop, count) if spacing == "linear" else np.geomspace(start, stop, count)


def _end(value: object, unit: str | None, place: str) -> float:
    number = value if unit is None else in_si(value, unit, place)
    # Whole numbers of any length compare with a float; not all of them convert to one.
    if isinstance(number, bool) or not isinstance(number, int | float) or not abs(number) <= LARGEST:
        raise InvalidInput(f"{place} = {shown(value)}: must be a number up to {LARGEST:g}, or a text with its unit")
    return float(number)

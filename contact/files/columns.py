"""Columns of CSV files that a scene names, as in `values = {file = "curve.csv", column = "depth"}`."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from contact.records.errors import InvalidInput, printable, shown
from contact.records.units import factor_of
from contact.records.validation import MAX_ENTRIES, FloatArray

# A file beyond this number of bytes is refused: it is no scene and no table, or a device without an end.
MAX_BYTES: Final = 32_000_000
_HEAD: Final = re.compile(r"(?P<name>[^\[(]*?)\s*(?:[\[(](?P<unit>[^\])]*)[\])])?")


class Column(NamedTuple):
    """Numbers of a CSV file.

    Attributes:
        name: Of the column, empty without a header.
        unit: As the header says it in brackets, or empty.
        values: Shape (n,).
    """

    name: str
    unit: str
    values: FloatArray


def column_in_si(table: Mapping[str, Any], unit: str | None, folder: Path | None) -> FloatArray:
    """The column that a table {file, column, unit} names, in the SI unit of its field; a bare column is in SI already.

    Raises:
        InvalidInput: If the file cannot be read, has no such column, or one in a unit of another kind.
    """
    one = column(table, folder)
    if not one.unit or unit is None:
        return one.values
    factor = factor_of(one.unit, unit)
    # Division by a power of ten rounds once, and gives the double closest to the number in SI.
    return one.values / float(1 / factor) if factor < 1 else one.values * float(factor)


def column(table: Mapping[str, Any], folder: Path | None) -> Column:
    """The column that a table {file, column, unit} names; without a name or number, the first.

    Raises:
        InvalidInput: If the file cannot be read or has no such column.
    """
    file, wanted, unit = table["file"], table.get("column", 0), table.get("unit", "")
    if folder is None:
        raise InvalidInput(f"file = {shown(file)}: only scene files name other files; give the numbers")
    if not isinstance(file, str) or not isinstance(unit, str):
        raise InvalidInput(f"file = {shown(file)}, unit = {shown(unit)}: must be texts, a CSV file and as in um")
    columns = _columns(folder / file)
    names = [one.name for one in columns]
    number = names.index(wanted) if isinstance(wanted, str) and wanted in names else wanted
    if isinstance(number, bool) or not isinstance(number, int) or not 0 <= number < len(columns):
        known = ", ".join(filter(None, names)) or f"columns 0 to {len(columns) - 1}"
        raise InvalidInput(f"column = {shown(wanted)}: {file} has no such column; it has {known}")
    found = columns[number]
    return found._replace(unit=unit or found.unit)


def read_text(file: Path, what: str) -> str:
    """The text of a file in UTF-8, without a byte-order mark.

    Raises:
        InvalidInput: If the file cannot be read, is too large, or is no UTF-8.
    """
    try:
        with file.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        # A path with a zero byte raises a ValueError.
        reason = getattr(error, "strerror", None) or error
        raise InvalidInput(f"{file}: cannot be read ({reason}); check the path") from None
    if len(content) > MAX_BYTES:
        raise InvalidInput(f"{file}: more than {what} can have ({MAX_BYTES} bytes)")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InvalidInput(f"{file}: not a text file in UTF-8 (byte {error.start}); save it in UTF-8") from None


def _columns(file: Path) -> list[Column]:
    """All columns: comma, semicolon, tab or blank between, "#" before comments, a header or none."""
    lines = read_text(file, "a table").splitlines()
    kept = [(i, line) for i, line in enumerate(lines, 1) if line.strip() and not line.lstrip().startswith("#")]
    rows = [(i, _cells(line)) for i, line in kept[: MAX_ENTRIES + 1]]
    if not rows:
        raise InvalidInput(f"{file}: holds no numbers")
    count = len(rows[0][1])
    has_head = None in [_number(cell) for cell in rows[0][1]]
    head, rows = (rows[0][1], rows[1:]) if has_head else ([""] * count, rows)
    if not rows:
        raise InvalidInput(f"{file}: a header, but no numbers below it")
    values = [_numbers(f"{file}, line {line}", cells, count) for line, cells in rows]
    parts = [_HEAD.fullmatch(name) for name in head]
    names = [(p["name"] or "", p["unit"] or "") if p else (name, "") for p, name in zip(parts, head, strict=True)]
    return [Column(*name, np.array(numbers)) for name, numbers in zip(names, zip(*values, strict=True), strict=True)]


def _cells(line: str) -> list[str]:
    separator = next((s for s in (";", "\t", ",") if s in line), None)
    cells = line.split() if separator is None else next(csv.reader([line], delimiter=separator))
    return [cell.strip() for cell in cells]


def _numbers(place: str, cells: list[str], count: int) -> list[float]:
    numbers = [number for cell in cells if (number := _number(cell)) is not None]
    if len(numbers) != count or len(cells) != count:
        raise InvalidInput(f"{place}: {printable(', '.join(cells)[:80])!r} is not {count} finite numbers")
    return numbers


def _number(cell: str) -> float | None:
    try:
        number = float(cell)
    except ValueError:
        return None
    return number if math.isfinite(number) else None

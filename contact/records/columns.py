"""Text files, and columns of CSV files that a scene names, as in `values = {file = "curve.csv", column = "depth"}`."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from contact.records.errors import InvalidInput, printable, shown
from contact.records.units import factor_of

# Larger files are refused: they are no scene and no table, or a device without an end.
MAX_BYTES: Final = 32_000_000
# Longer lists are refused: they are mistakes, never measurements.
MAX_ENTRIES: Final = 1_000_000
_HEAD: Final = re.compile(r"([^\[(]*?)\s*(?:[\[(]([^\])]*)[\])])?")


def column_in_si(table: Mapping[str, Any], unit: str | None, folder: Path | None) -> tuple[NDArray[np.float64], str]:
    """Numbers of the column that a table {file, column, unit} names, in SI, and the unit that they were written in.

    Args:
        table: Without a column, the first is meant; without a unit, that of the header in brackets, or SI.
        unit: SI unit of the numbers; None for pure numbers.
        folder: The file is named relative to it; None where no file may be named.

    Returns:
        Numbers, shape (n,), and their unit, empty for numbers that were in SI.

    Raises:
        InvalidInput: If the file cannot be read, has no such column, or one in a unit of another kind.
    """
    file, wanted, given = table["file"], table.get("column", 0), table.get("unit", "")
    if folder is None:
        raise InvalidInput(f"file = {shown(file)}: only scene files name other files; give the numbers")
    if not isinstance(file, str) or not isinstance(given, str):
        raise InvalidInput(f"file = {shown(file)}, unit = {shown(given)}: must be texts, a CSV file and as in um")
    heads, numbers = _columns(folder / file)
    names = [name for name, _ in heads]
    place = names.index(wanted) if isinstance(wanted, str) and wanted in names else wanted
    if isinstance(place, bool) or not isinstance(place, int) or not 0 <= place < len(heads):
        known = ", ".join(filter(None, names)) or f"columns 0 to {len(heads) - 1}"
        raise InvalidInput(f"column = {shown(wanted)}: {file} has no such column; it has {known}")
    values, written = numbers[:, place], given or heads[place][1]
    if not written or unit is None:
        return values, ""
    factor = factor_of(written, unit)
    # Division by a power of ten rounds once, and gives the double closest to the number in SI.
    return values / float(1 / factor) if factor < 1 else values * float(factor), written


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


def _columns(file: Path) -> tuple[list[tuple[str, str]], NDArray[np.float64]]:
    """Name and unit of each column, and all numbers: comma, semicolon, tab or blank between, "#" before comments."""
    lines = enumerate(read_text(file, "a table").splitlines(), 1)
    rows = [(number, _cells(line)) for number, line in lines if line.strip() and not line.lstrip().startswith("#")]
    if not rows:
        raise InvalidInput(f"{file}: holds no numbers")
    first = rows[0][1]
    has_head = not _are_numbers(first)
    if not (body := rows[has_head : MAX_ENTRIES + 1]):
        raise InvalidInput(f"{file}: a header, but no numbers below it")
    for number, cells in body:
        if len(cells) != len(first) or not _are_numbers(cells):
            told = printable(", ".join(cells)[:80])
            raise InvalidInput(f"{file}, line {number}: {told!r} is not {len(first)} finite numbers")
    parts = [(cell, _HEAD.fullmatch(cell)) for cell in first]
    heads = [(found[1], found[2] or "") if found else (cell, "") for cell, found in parts]
    return heads if has_head else [("", "")] * len(first), np.array([cells for _, cells in body], dtype=np.float64)


def _cells(line: str) -> list[str]:
    separator = next((s for s in (";", "\t", ",") if s in line), None)
    cells = line.split() if separator is None else next(csv.reader([line], delimiter=separator))
    return [cell.strip() for cell in cells]


def _are_numbers(cells: list[str]) -> bool:
    try:
        return bool(np.all(np.isfinite([float(cell) for cell in cells])))
    except ValueError:
        return False

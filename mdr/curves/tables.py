"""Tables of numbers as programs and people write them: heads with units, a row of units, decimal commas, gaps."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from contact import InvalidInput
from contact.records.columns import MAX_BYTES
from contact.records.errors import printable
from contact.records.validation import FloatArray, IntArray

_UNIT = r"(?:[fpnumkM]?[mNVs]|kgf|Pa|%|[nu]n|[NU][MN])"
_HEAD: Final = re.compile(rf"(?P<name>.*?)[\s_/:,]*[\[(<]?\s*(?<![A-Za-z0-9])(?P<unit>{_UNIT})\s*[\])>]?")
_NAMED: Final = re.compile(r"(?P<name>[^\[(]*?)\s*[\[(](?P<unit>[^\])]*)[\])].*")
# Comments of tables that JPK writes: names and units of the columns in two lines.
_COLUMNS: Final = re.compile(r"#\s*columns:\s*(.*)")
_UNITS: Final = re.compile(r"#\s*units:\s*(.*)")
_SPRING_CONSTANT: Final = re.compile(r"#\s*springConstant:\s*([-+.\deE]+)")
_GAPS: Final = frozenset({"", "nan", "na", "n/a", "-", "--", "null", "none"})
_NUMBER: Final = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_DECIMAL_COMMA: Final = re.compile(r"[-+]?\d+,\d+(?:[eE][-+]?\d+)?")


@dataclass(frozen=True)
class Column:
    """Numbers of a table.

    Attributes:
        name: Of the column, empty without a head.
        unit: As written, with "u" for micro.
        values: Shape (n,), not a number in gaps.
    """

    name: str
    unit: str
    values: FloatArray


@dataclass(frozen=True)
class Table:
    """Columns with units.

    Attributes:
        columns: All of them.
        notes: What was recognised, in words.
        spring_constant: Of the cantilever [N/m], where the head says it.
    """

    columns: tuple[Column, ...]
    notes: tuple[str, ...] = ()
    spring_constant: float | None = None

    def at_rows(self, rows: IntArray) -> Table:
        """The table with some of its rows."""
        return replace(self, columns=tuple(replace(one, values=one.values[rows]) for one in self.columns))


def read_table(file: Path, units: str = "") -> Table:
    """All columns of a table in text.

    Args:
        file: UTF-8 or UTF-16; tab, semicolon, comma or blanks between columns; "#" before comments.
        units: "nm,nN" in place of those in the heads, one for each column, or for the first and all others.

    Raises:
        InvalidInput: With the line, for cells that are no numbers, commas of two meanings, and columns without units.
    """
    lines = [(i, line.strip("\ufeff \r\n")) for i, line in enumerate(text_of(file).splitlines(), 1)]
    kept = [(i, line) for i, line in lines if line.strip()]
    first = next((k for k, (_, line) in enumerate(kept) if not line.startswith("#") and _is_data(line)), None)
    if first is None:
        raise InvalidInput(f"{file}: holds no numbers")
    separator = _separator(file, kept[first:])
    rows = [(i, _cells(line, separator)) for i, line in kept[first:] if not line.startswith("#")]
    width = len(rows[0][1])
    heads, head_units = _heads(kept[:first], separator, width)
    _check_commas(file, rows[0], separator, heads)
    values, gaps = _values(file, rows, width)
    found = _units(file, units, head_units, heads, kept[0][0])
    notes = (f"{len(gaps)} rows with gaps are left out (first: line {gaps[0]})",) if gaps else ()
    columns = (Column(name, unit, column) for name, unit, column in zip(heads, found, values.T, strict=True))
    return Table(tuple(columns), notes, _spring_constant(kept[:first]))


def _spring_constant(before: Sequence[tuple[int, str]]) -> float | None:
    """The spring constant [N/m] of the comments of JPK."""
    found = [_SPRING_CONSTANT.fullmatch(line) for _, line in before]
    return next((float(one[1]) for one in found if one), None)


def text_of(file: Path) -> str:
    """The text of a file in UTF-8, UTF-16 or Latin-1.

    Raises:
        InvalidInput: If it cannot be read, or is too long.
    """
    try:
        with file.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        raise InvalidInput(f"{file}: cannot be read ({getattr(error, 'strerror', None) or error})") from None
    if len(content) > MAX_BYTES:
        raise InvalidInput(f"{file}: more than {MAX_BYTES} bytes; keep fewer points")
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return content.decode("utf-16", errors="replace")
    if b"\x00" in content[:200]:
        return content.decode("utf-16-le" if content[1:2] == b"\x00" else "utf-16-be", errors="replace")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _cells(line: str, separator: str) -> list[str]:
    cells = line.split() if separator == " " else line.split(separator)
    return [cell.strip().strip('"') for cell in cells]


def _number(cell: str) -> float | None:
    """A finite number with a decimal point or comma, not a number for a gap, None for anything else."""
    if cell.lower() in _GAPS:
        return math.nan
    cell = cell.replace(",", ".") if _DECIMAL_COMMA.fullmatch(cell) else cell
    number = float(cell) if _NUMBER.fullmatch(cell) else None
    return number if number is not None and math.isfinite(number) else None


def _numbers(line: str, separator: str) -> list[float] | None:
    """The numbers of a line, None if it has another cell or none but gaps."""
    numbers = [_number(cell) for cell in _cells(line, separator)]
    found = [number for number in numbers if number is not None]
    return found if len(found) == len(numbers) and not all(map(math.isnan, found)) else None


def _is_data(line: str) -> bool:
    return any(_numbers(line, separator) is not None for separator in "\t;, ")


def _separator(file: Path, rows: Sequence[tuple[int, str]]) -> str:
    """The first of tab, semicolon, comma and blank that is in the first row and makes its cells numbers."""
    number, line = rows[0]
    for separator in "\t;, ":
        if separator in line.strip() and _numbers(line, separator) is not None:
            return separator
    if _numbers(line, " ") is not None:
        return " "
    raise InvalidInput(f"{file}, line {number}: {printable(line[:80])!r} is no row of numbers")


def _heads(before: Sequence[tuple[int, str]], separator: str, width: int) -> tuple[list[str], list[str]]:
    """Names and units from the lines before the numbers: the last ones with as many cells."""
    names, units = [""] * width, [""] * width
    of_jpk = [next((m[1].split() for _, line in before if (m := p.fullmatch(line))), []) for p in (_COLUMNS, _UNITS)]
    if all(len(words) == width for words in of_jpk):
        return of_jpk[0], [_plain(unit) for unit in of_jpk[1]]
    for _, line in reversed(before[-3:]):
        text = line.lstrip("# ").strip()
        cells = next((c for s in (separator, "\t", ";", ",") for c in [_cells(text, s)] if len(c) == width), None)
        cells = cells if cells is not None else _cells(text, " ")
        if len(cells) != width:
            continue
        bare = [_bare_unit(cell) for cell in cells]
        if all(bare) and not any(units):
            units = bare
            continue
        split = [name_and_unit(cell) for cell in cells]
        return [name for name, _ in split], [unit or old for (_, unit), old in zip(split, units, strict=True)]
    return names, units


def _plain(unit: str) -> str:
    unit = unit.strip().replace("\u00b5", "u").replace("\u03bc", "u")
    return {"nn": "nN", "un": "uN", "NM": "nm", "UM": "um", "NN": "nN", "UN": "uN", "\u00c5": "angstrom"}.get(
        unit, unit
    )


def _bare_unit(cell: str) -> str:
    cell = _plain(cell.strip("[]()<> "))
    return cell if re.fullmatch(_UNIT, cell) else ""


def name_and_unit(cell: str) -> tuple[str, str]:
    """Name and unit of a head, the unit empty where there is none."""
    cell = _plain(cell)
    if found := _NAMED.fullmatch(cell):
        return found["name"].strip(), _plain(found["unit"])
    found = _HEAD.fullmatch(cell)
    return (found["name"].strip(), _plain(found["unit"])) if found and found["name"] else (cell, "")


def _check_commas(file: Path, row: tuple[int, list[str]], separator: str, heads: Sequence[str]) -> None:
    """Refuse rows in which a comma may be a decimal one or stand between columns."""
    line, cells = row
    whole = all(re.fullmatch(r"[-+]?\d+", cell) for cell in cells)
    if separator == "," and whole and len(cells) > 2 and not all(heads):
        raise InvalidInput(
            f"{file}, line {line}: commas may be decimal ones or stand between columns; save it with decimal points, "
            "or with semicolons or tabs between columns"
        )


def _values(file: Path, rows: Sequence[tuple[int, list[str]]], width: int) -> tuple[FloatArray, list[int]]:
    """Numbers, shape (n, width), without rows that have gaps, and the lines of those."""
    values, gaps = [], []
    for line, cells in rows:
        numbers = [_number(cell) for cell in cells]
        if len(numbers) == width + 1 and cells[-1] == "":
            numbers = numbers[:-1]
        if len(numbers) != width or None in numbers:
            shown = printable(", ".join(cells)[:80])
            raise InvalidInput(f"{file}, line {line}: {shown!r} is not {width} finite numbers")
        found = [math.nan if number is None else number for number in numbers]
        if any(map(math.isnan, found)):
            gaps.append(line)
        else:
            values.append(found)
    return np.array(values).reshape(-1, width), gaps


def _units(file: Path, given: str, found: Sequence[str], heads: Sequence[str], line: int) -> list[str]:
    """Units of the columns: those given, else those of the heads."""
    if given:
        parts = [_plain(part) for part in given.split(",")]
        parts += [parts[-1]] * (len(heads) - len(parts))
        return parts[: len(heads)]
    if not any(found):
        names = f" ({', '.join(heads)})" if any(heads) else ""
        raise InvalidInput(
            f"{file}, line {line}: columns without units{names}; write them in the heads, as in depth [nm], or give "
            "--units nm,nN"
        )
    return list(found)

"""Tables of numbers in text: vectors of a scene, and measured curves.

Heads with units, a row of units, decimal commas, gaps and comments, in UTF-8, UTF-16 or Latin-1. A scene names a column
of a table as in `values = {file = "curve.csv", column = "depth"}`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from contact.records.errors import InvalidInput, printable, shown
from contact.records.units import factor_of

# Largest size of a file; larger ones are no scenes or tables, or a device without an end.
MAX_BYTES: Final = 32_000_000
# Largest number of entries of a list; longer ones are mistakes, not measurements.
MAX_ENTRIES: Final = 1_000_000
_UNIT = r"(?:[fpnumkM]?[mNVs]|kgf|Pa|%|[nu]n|[NU][MN])"
_HEAD: Final = re.compile(rf"(?P<name>.*?)[\s_/:,]*[\[(<]?\s*(?<![A-Za-z0-9])(?P<unit>{_UNIT})\s*[\])>]?")
_NAMED: Final = re.compile(r"(?P<name>[^\[(]*?)\s*[\[(](?P<unit>[^\])]*)[\])].*")
# Comments in tables of JPK instruments: names and units of the columns, and the spring constant [N/m].
_COMMENT: Final = re.compile(r"#\s*(columns|units|springConstant):\s*(.*)")
_SPELLINGS: Final = {"nn": "nN", "un": "uN", "NM": "nm", "UM": "um", "NN": "nN", "UN": "uN", "\u00c5": "angstrom"}
_GAPS: Final = frozenset({"", "nan", "na", "n/a", "-", "--", "null", "none"})
_NUMBER: Final = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_DECIMAL_COMMA: Final = re.compile(r"[-+]?\d+,\d+(?:[eE][-+]?\d+)?")


@dataclass(frozen=True)
class Column:
    """Numbers of a table.

    Attributes:
        name: Head without its unit, empty without a head.
        unit: Unit as written, with "u" for micro; empty without a unit.
        values: Numbers, shape (n,).
    """

    name: str
    unit: str
    values: NDArray[np.float64]


@dataclass(frozen=True)
class Table:
    """Columns of equal lengths.

    Attributes:
        columns: Columns in the order of the file.
        line: Number of the first line that is not empty.
        gaps: Numbers of the lines that are omitted because a number is missing.
        spring_constant: Spring constant of the cantilever [N/m], if a comment of the file has it.
    """

    columns: tuple[Column, ...]
    line: int
    gaps: tuple[int, ...] = ()
    spring_constant: float | None = None

    def at_rows(self, rows: NDArray[np.int64]) -> Table:
        """The table with some of its rows."""
        return replace(self, columns=tuple(replace(column, values=column.values[rows]) for column in self.columns))


def column_in_si(table: Mapping[str, Any], unit: str | None, folder: Path | None) -> tuple[NDArray[np.float64], str]:
    """Numbers in SI of the column that {file, column, unit} names, and their unit in the file.

    Args:
        table: Entries file, column (the first by default) and unit (that of the head, or SI, by default).
        unit: SI unit of the numbers; None for pure numbers.
        folder: Folder of the file; None if the scene may name no file.

    Returns:
        Numbers, shape (n,), and their unit, empty for numbers that were in SI.

    Raises:
        InvalidInput: If the file cannot be read, has gaps or no such column, or its unit is of another kind.
    """
    file, column, unit_name = table["file"], table.get("column", 0), table.get("unit", "")
    if folder is None:
        raise InvalidInput(f"file = {shown(file)}: only scene files name other files; give the numbers")
    if not isinstance(file, str) or not isinstance(unit_name, str):
        raise InvalidInput(f"file = {shown(file)}, unit = {shown(unit_name)}: must be texts, a CSV file and as in um")
    whole = read_table(folder / file)
    if whole.gaps:
        raise InvalidInput(f"{folder / file}, line {whole.gaps[0]}: a number is missing; leave the line out")
    names = [column.name for column in whole.columns]
    place = names.index(column) if isinstance(column, str) and column in names else column
    if isinstance(place, bool) or not isinstance(place, int) or not 0 <= place < len(names):
        known = ", ".join(filter(None, names)) or f"columns 0 to {len(names) - 1}"
        raise InvalidInput(f"column = {shown(column)}: {file} has no such column; it has {known}")
    written = unit_name or whole.columns[place].unit
    return in_unit(whole.columns[place].values, written, unit), written if unit else ""


def in_unit(values: NDArray[np.float64], written: str, unit: str | None) -> NDArray[np.float64]:
    """Numbers in the SI unit from numbers in a written unit, which is empty for SI."""
    if not written or unit is None:
        return values
    factor = factor_of(written, unit)
    # Division by a power of ten rounds once, and gives the double closest to the number in SI.
    return values / float(1 / factor) if factor < 1 else values * float(factor)


def read_table(file: Path) -> Table:
    """All columns of a table: tab, semicolon, comma or blanks between them, "#" before comments.

    Raises:
        InvalidInput: A cell is no number, or commas are ambiguous; the message has the line.
    """
    texts = enumerate(table_text(file).splitlines(), 1)
    lines = [(number, line) for number, text in texts if (line := text.strip("\ufeff \r\n")).strip()]
    first = next((k for k, (_, line) in enumerate(lines) if not line.startswith("#") and _separator(line)), None)
    if first is None:
        raise InvalidInput(f"{file}: holds no numbers")
    separator = _separator(lines[first][1])
    rows = [(number, _cells(line, separator)) for number, line in lines[first:] if not line.startswith("#")]
    before, width = [line for _, line in lines[:first]], len(rows[0][1])
    comments = {match[1]: match[2] for line in reversed(before) if (match := _COMMENT.fullmatch(line))}
    names, units = _heads(before, comments, separator, width)
    _check_commas(file, rows[0], separator, names)
    values, gaps = _values(file, rows, width)
    columns = tuple(map(Column, names, map(plain_unit, units), values.T))
    stiffness = comments.get("springConstant", "")
    return Table(columns, lines[0][0], gaps, float(stiffness) if _NUMBER.fullmatch(stiffness) else None)


def read_bytes(file: Path, what: str) -> bytes:
    """The content of a file.

    Raises:
        InvalidInput: If the file cannot be read, or is too large for ``what``, such as "a scene".
    """
    try:
        with file.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:
        # A path with a zero byte raises a ValueError.
        raise InvalidInput(
            f"{file}: cannot be read ({getattr(error, 'strerror', None) or error}); check the path"
        ) from None
    if len(content) > MAX_BYTES:
        raise InvalidInput(f"{file}: more than {what} can have ({MAX_BYTES} bytes)")
    return content


def table_text(file: Path) -> str:
    """The text of a file in UTF-8, UTF-16 or Latin-1."""
    content = read_bytes(file, "a table")
    if content[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return content.decode("utf-16", errors="replace")
    if b"\x00" in content[:200]:
        return content.decode("utf-16-le" if content[1:2] == b"\x00" else "utf-16-be", errors="replace")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _cells(line: str, separator: str) -> list[str]:
    """Texts of the cells of a line, without blanks and quotes."""
    cells = line.split() if separator == " " else line.split(separator)
    return [cell.strip().strip('"') for cell in cells]


def _number(cell: str) -> float | None:
    """Finite number with a decimal point or comma; NaN for a gap, None for any other text."""
    if cell.lower() in _GAPS:
        return math.nan
    cell = cell.replace(",", ".") if _DECIMAL_COMMA.fullmatch(cell) else cell
    number = float(cell) if _NUMBER.fullmatch(cell) else math.inf
    return number if math.isfinite(number) else None


def _are_numbers(line: str, separator: str) -> bool:
    """Whether all cells of a line are numbers or gaps, and not all gaps."""
    numbers = [_number(cell) for cell in _cells(line, separator)]
    return None not in numbers and not np.isnan(np.array(numbers, dtype=np.float64)).all()


def _separator(line: str) -> str:
    """First of tab, semicolon, comma and blank that divides a line into numbers; empty if none does."""
    separators = [separator for separator in "\t;," if separator in line.strip()]
    return next((separator for separator in (*separators, " ") if _are_numbers(line, separator)), "")


def _heads(
    before: Sequence[str], comments: Mapping[str, str], separator: str, width: int
) -> tuple[list[str], list[str]]:
    """Names and units of ``width`` columns from the last lines before the numbers with as many cells."""
    of_jpk = [comments.get(key, "").split() for key in ("columns", "units")]
    if all(len(words) == width for words in of_jpk):
        return of_jpk[0], of_jpk[1]
    units = [""] * width
    for line in reversed(before[-3:]):
        text = line.lstrip("# ").strip()
        cells = next((c for s in (separator, "\t", ";", ",", " ") if len(c := _cells(text, s)) == width), None)
        if cells is None:
            continue
        bare = [_bare_unit(cell) for cell in cells]
        if not all(bare) or any(units):
            names, written = zip(*map(name_and_unit, cells), strict=True)
            return list(names), [unit or old for unit, old in zip(written, units, strict=True)]
        units = bare
    return [""] * width, units


def plain_unit(unit: str) -> str:
    """Unit in ASCII spelling, with "u" for micro."""
    unit = unit.strip().replace("\u00b5", "u").replace("\u03bc", "u")
    return _SPELLINGS.get(unit, unit)


def _bare_unit(cell: str) -> str:
    """Unit of a cell that has nothing else; empty for other cells."""
    cell = plain_unit(cell.strip("[]()<> "))
    return cell if re.fullmatch(_UNIT, cell) else ""


def name_and_unit(cell: str) -> tuple[str, str]:
    """Name and unit of a head, the unit empty where there is none."""
    cell = plain_unit(cell)
    match = _NAMED.fullmatch(cell) or _HEAD.fullmatch(cell)
    if match and (match["name"] or match.re is _NAMED):
        return match["name"].strip(), match["unit"]
    return cell, ""


def _check_commas(file: Path, row: tuple[int, list[str]], separator: str, heads: Sequence[str]) -> None:
    """Refuse rows in which a comma may be a decimal comma or a separator of columns."""
    line, cells = row
    whole = all(re.fullmatch(r"[-+]?\d+", cell) for cell in cells)
    if separator == "," and whole and len(cells) > 2 and not all(heads):
        raise InvalidInput(
            f"{file}, line {line}: commas may be decimal ones or stand between columns; save it with decimal points, "
            "or with semicolons or tabs between columns"
        )


def _values(
    file: Path, rows: Sequence[tuple[int, list[str]]], width: int
) -> tuple[NDArray[np.float64], tuple[int, ...]]:
    """Numbers, shape (n, width), of the rows without gaps, and the line numbers of rows with gaps."""
    values, gaps = [], []
    for line, cells in rows:
        numbers = [_number(cell) for cell in (cells[:-1] if len(cells) == width + 1 and cells[-1] == "" else cells)]
        if len(numbers) != width or None in numbers:
            text = printable(", ".join(cells)[:80])
            raise InvalidInput(f"{file}, line {line}: {text!r} is not {width} finite numbers")
        if any(math.isnan(number) for number in numbers if number is not None):
            gaps.append(line)
        else:
            values.append(numbers)
    return np.array(values, dtype=np.float64).reshape(-1, width), tuple(gaps)

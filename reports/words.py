"""Words of reports: numbers with units and no digit beyond their uncertainty, names of methods and files, tables.

A number with its uncertainty is written as CODATA does: `1.480210(21)` means 1.480210 with an uncertainty of 0.000021.
"""

import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TypeVar

from contact.records.units import prefix_for

R = TypeVar("R")

NAMES: Mapping[str, str] = {
    "mdr": "MDR",
    "fem": "FEM",
    "bem": "BEM",
    "integral_equation": "integral equation",
    "mdr_table": "MDR (FFT table)",
    "calculix": "CalculiX",
    "contact_mechanics": "ContactMechanics",
    "tamaas": "Tamaas",
}

# Text in place of a number that is not finite; no page shows "nan".
NOT_FINITE = "not finite"

# Magnitudes outside these are written with a power of ten.
LARGEST_PLAIN, SMALLEST_PLAIN = 1e5, 1e-3

# Significant digits of double precision.
DOUBLE_DIGITS = 16


def measured(value: float, uncertainty: float) -> str:
    """A value with its absolute uncertainty in the same unit, two digits of it in brackets.

    An uncertainty of zero means an exact number; "(?)" stands where it is not known.
    """
    if not math.isfinite(value):
        return NOT_FINITE
    if not math.isfinite(uncertainty):
        return f"{value:.3g}(?)"
    if uncertainty == 0.0:
        return f"{value:.12g}"
    exponent = _leading_power(max(abs(value), uncertainty))
    if SMALLEST_PLAIN <= max(abs(value), uncertainty) < LARGEST_PLAIN and uncertainty <= 99.0:
        return _bracketed(value, uncertainty, exponent)
    scale = 10.0**exponent
    return f"{_bracketed(value / scale, uncertainty / scale, 0)}e{exponent}"


def _bracketed(value: float, uncertainty: float, exponent: int) -> str:
    """Both numbers to the second digit of the uncertainty, at most to the digits of double precision."""
    decimals = max(0, min(1 - _leading_power(uncertainty), DOUBLE_DIGITS - 1 - exponent))
    # The uncertainty is rounded up: never less than it is.
    digits = max(1, math.ceil(round(uncertainty * 10.0**decimals, 6)))
    shown = f"{digits}" if uncertainty < 1.0 else f"{digits / 10.0**decimals:.{decimals}f}"
    return f"{value:.{decimals}f}({shown})"


def _leading_power(value: float) -> int:
    """Power of ten of the first digit, 3 for 1234."""
    return math.floor(math.log10(value))


def small(value: float) -> str:
    """An error, a tolerance or a ratio of errors to two digits: 3.2e-6."""
    if not math.isfinite(value):
        return NOT_FINITE
    if value == 0.0:
        return "0"
    if 1e-2 <= abs(value) < 1e3:
        return f"{value:.2g}" if abs(value) < 100.0 else f"{value:.0f}"
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def signed(value: float) -> str:
    """A relative error to two digits with its sign: +3.2e-6."""
    return f"{'+' * (value > 0.0)}{small(value)}"


def short_exponents(text: str) -> str:
    """The text with its powers of ten as `small` writes them: 1e-6 for 1e-06, 1e5 for 1e+05."""
    return re.sub(r"(?<=\d)e(?:\+|(-))0?(\d+)\b", lambda match: f"e{match[1] or ''}{match[2]}", text)


def quantity_words(name: str) -> str:
    """The name of a quantity or parameter as words: pull-off force, Poisson's ratio."""
    return (
        name.replace("_", " ")
        .replace("pull off", "pull-off")
        .replace("poissons", "Poisson's")
        .replace("youngs", "Young's")
    )


def with_article(noun: str) -> str:
    """A noun with its article: a bonded layer, an unbonded layer."""
    return f"{'an' if noun[0] in 'aeiou' else 'a'} {noun}"


def duration(seconds: float) -> str:
    """Seconds in the unit that fits: 4.2 ms, 1.3 s, 2 min 05 s."""
    if not math.isfinite(seconds):
        return NOT_FINITE
    if seconds >= 119.5:
        minutes, rest = divmod(round(seconds), 60)
        return f"{minutes} min {rest:02d} s"
    return with_prefix(seconds, "s")


def memory(size: float) -> str:
    """Bytes as 52 MB."""
    return with_prefix(size, "B")


def with_prefix(value: float, unit: str) -> str:
    """Three digits and a unit with a fitting prefix: 12.3 mN."""
    if not math.isfinite(value):
        return NOT_FINITE
    factor, prefix = prefix_for([value])
    return f"{_three_digits(value / factor)} {prefix}{unit}"


def scaled_unit(value: float, unit: str) -> tuple[float, str]:
    """Factor and unit with a fitting prefix; a ratio has neither."""
    if unit == "1":
        return 1.0, ""
    factor, prefix = prefix_for([value])
    return factor, f"{prefix}{unit}"


def scaled_column(head: str, values: Iterable[float]) -> tuple[float, str]:
    """Factor and head with a fitting prefix of a column "name [unit]"; a ratio has neither."""
    name, _, unit = head.partition(" [")
    factor, prefix = prefix_for(values) if unit and not unit.startswith(("1", "kg")) else (1.0, "")
    return factor, quantity_words(name) + (f" [{prefix}{unit}" if unit and unit != "1]" else "")


def _three_digits(value: float) -> str:
    """Three significant digits without a power of ten, for values in [0, 1000)."""
    if value == 0.0:
        return "0"
    rounded = float(f"{value:.2e}")  # 0.9999 becomes 1.00, not 1.000
    return f"{rounded:.{max(0, 2 - _leading_power(abs(rounded)))}f}"


def base_of(method: str) -> str:
    """The method of a label: "mdr" of "mdr", of "mdr fft" and of "mdr[fft]"."""
    return re.split(r"[\s\[(,:]", method, maxsplit=1)[0]


def display_name(method: str) -> str:
    """The label with the display name of its method, "MDR fft"; a method of another package keeps its name."""
    base = base_of(method)
    return NAMES.get(base, base) + method[len(base) :]


def file_name(*parts: str) -> str:
    """The parts in lower case, joined by dashes, without what a file system or an address could misread."""
    words = (re.sub(r"[^\w.]+", "-", part).strip("-") for part in parts)
    return "-".join(words).lower()


@dataclass(frozen=True, kw_only=True)
class Table:
    """A table ready to print; the first `words` columns are words, the others numbers.

    A row of a single cell is a heading over the rows that follow it.
    """

    title: str
    note: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    words: int = 1


def markdown_table(heads: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A table in Markdown, from cells whose text Markdown shows as it stands."""
    names = list(heads)
    lines = (names, ["---"] * len(names), *rows)
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def tabulated(
    records: Iterable[R], columns: Mapping[str, Callable[[R], str]], *, title: str, note: str = "", words: int = 1
) -> Table | None:
    """A table of one row per record; None without records.

    Args:
        records: Records in the order of the rows.
        columns: Text of each column for a record, by its head.
        title: Line above the table.
        note: Text below the table.
        words: Number of the first columns that are words.
    """
    rows = tuple(tuple(cell(record) for cell in columns.values()) for record in records)
    return Table(title=title, note=note, heads=tuple(columns), rows=rows, words=words) if rows else None

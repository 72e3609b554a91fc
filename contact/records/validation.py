"""Types of fields. An error of a validator has the requirement and the remedy; `Record` adds value and place.

Numbers of fields with a unit may be texts with one. Vectors may be single numbers, lists, ranges and columns of CSV
files as well. Files that mix numbers with and without units are read again with `Reading.units_required`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray
from pydantic import PlainValidator, ValidationInfo, WithJsonSchema

from contact.records.errors import refused, shown
from contact.records.tables import MAX_ENTRIES, column_in_si
from contact.records.units import Unit, in_si

FloatArray: TypeAlias = NDArray[np.float64]
IntArray: TypeAlias = NDArray[np.int64]
BoolArray: TypeAlias = NDArray[np.bool_]
Number: TypeAlias = np.floating[Any] | np.integer[Any]
Numbers: TypeAlias = float | Sequence[float] | Sequence[np.floating[Any]] | np.ndarray[Any, np.dtype[Number]]
"""Values of a vector: a number, a list, tuple or range of numbers, or an array of shape (n,)."""

if TYPE_CHECKING:

    class Vector:
        """A field whose input is `Numbers` and whose value is a read-only float64 array, shape (n,)."""

        def __get__(self, owner: object | None, kind: object) -> FloatArray: ...
        def __set__(self, owner: object, value: Numbers | Sequence[str]) -> None: ...

    class Scalar:
        """A field given as a number, or as a text with a unit, and read as a float in SI."""

        def __get__(self, owner: object | None, kind: object) -> float: ...
        def __set__(self, owner: object, value: float | str) -> None: ...
else:
    # At run time the validators below convert, and the field is the array or the number itself.
    Vector, Scalar = FloatArray, float

# Range of magnitudes in any unit: products of four of them fit into double precision.
SMALLEST, LARGEST = 1e-75, 1e75
RANGE = frozenset({"start", "stop", "count", "spacing"})
COLUMN = frozenset({"file", "column", "unit"})

# Metadata in the annotation of a field.
Checked: TypeAlias = tuple[Any, ...]


class Derived(float):
    """A number derived from others of the scene, which needs no unit."""


@dataclass
class Reading:
    """Settings for reading the numbers of one scene, and a record of whether they have units.

    Attributes:
        folder: Folder of CSV files; None if the scene may name no file.
        units_required: Whether numbers without a unit are refused.
        example: First number with a unit; empty before one is read.
        bare: Whether a dimensional number, neither zero nor infinite, had no unit.
    """

    folder: Path | None = None
    units_required: bool = False
    example: str = ""
    bare: bool = False

    def note(self, value: object, unit: str) -> None:
        """Record whether a dimensional number has a unit, which is empty if not.

        Raises:
            ValueError: If the number has no unit although other numbers of the scene have one.
        """
        if unit:
            self.example = self.example or shown(value)
        elif _is_number(value) and not isinstance(value, Derived) and value not in (0, math.inf):
            self.bare = True
            if self.units_required:
                raise ValueError(
                    f"no unit, but other numbers of this scene have one ({self.example}); write every length, time, "
                    'force, .. with its unit, as in "5 um", or none of them (SI)'
                )


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool | np.bool_)


def read_number(value: object, remedy: str, unit: str | None, reading: Reading | None) -> float:
    """Number in SI from a number, or from a text with a number and its unit.

    Raises:
        ValueError: If the value is neither, or too large for double precision.
    """
    number = value if unit is None else in_si(value, unit)
    if unit is not None and reading is not None:
        reading.note(value, "" if number is value else unit)
    if not _is_number(number):
        raise ValueError(f"must be a number; {remedy}")
    try:
        return float(number)  # type: ignore[arg-type]  # every Real has __float__
    except OverflowError:
        raise ValueError(f"must fit into double precision; {remedy}") from None


def _in_bounds(number: float, remedy: str) -> float:
    """The number, if it is zero, infinite, or of a magnitude between `SMALLEST` and `LARGEST`; else a ValueError."""
    if number != 0.0 and math.isfinite(number) and not SMALLEST <= abs(number) <= LARGEST:
        raise ValueError(f"must have a magnitude between {SMALLEST:g} and {LARGEST:g}; use other units, and {remedy}")
    return number


def _written(unit: str | None, *, infinite: bool = False) -> dict[str, Any]:
    """JSON schema of a number, which may be a text if it has a unit or may be infinite."""
    if unit is None and not infinite:
        return {"type": "number"}
    return {"type": ["number", "string"], "pattern": r"^\s*[-+.\d]|^inf$" if infinite else r"^\s*[-+.\d]"}


def number(
    remedy: str,
    unit: str | None = None,
    *,
    low: float = 0.0,
    high: float = math.inf,
    above: bool = False,
    infinite: bool = False,
) -> Checked:
    """Validator and schema of a number in [low, high], or above ``low``; infinity may be the text "inf"."""
    if math.isfinite(high):
        required = f"lie in [{low:g}, {high:g}]"
    elif above:
        required = "be positive" if infinite else "be positive and finite"
    else:
        required = f"be at least {low:g}" if infinite else f"be finite and at least {low:g}"

    def validate(value: object, info: ValidationInfo) -> float:
        """The number in SI; an error has the requirement and the remedy."""
        si_value = math.inf if infinite and value == "inf" else read_number(value, remedy, unit, info.context)
        if not (low <= si_value <= high and (infinite or math.isfinite(si_value)) and (si_value > low or not above)):
            raise ValueError(f"must {required}; {remedy}")
        return si_value if math.isfinite(high) else _in_bounds(si_value, remedy)

    limits = {"exclusiveMinimum" if above else "minimum": low} | ({"maximum": high} if math.isfinite(high) else {})
    schema = WithJsonSchema({**_written(unit, infinite=infinite), **limits})
    return PlainValidator(validate), schema, *([Unit(unit)] if unit else [])


def positive(remedy: str, unit: str | None = None) -> Checked:
    """Validator and schema of a finite number above zero."""
    return number(remedy, unit, above=True)


def in_range(low: float, high: float, remedy: str, unit: str | None = None) -> Checked:
    """Validator and schema of a finite number in [low, high]; without an upper end it is at most `LARGEST`."""
    return number(remedy, unit, low=low, high=high)


PositiveLength = Annotated[Scalar, *positive("give the length in metres", "m")]
Modulus = Annotated[Scalar, *positive("give the modulus in pascals", "Pa")]
PoissonsRatio = Annotated[float, *in_range(0.0, 0.5, "Poisson's ratio is 0.5 for incompressible materials")]


def as_vector(value: object, remedy: str, unit: str | None, reading: Reading | None) -> FloatArray:
    """A read-only vector of finite numbers from a number, a list, a range or a column, shape (n,).

    Raises:
        ValueError: If the value is none of these, empty, too long, or has a number that is not finite.
    """
    value = _written_out(value, unit, reading)
    if _is_number(value) or (isinstance(value, str) and unit is not None and in_si(value, unit) is not value):
        value = [value]
    if isinstance(value, str | bytes) or not isinstance(value, Sequence | np.ndarray):
        raise ValueError(f"must be a list of numbers; {remedy}")  # pydantic collects ValueError only
    if isinstance(value, np.ndarray) and (value.ndim != 1 or value.dtype.kind not in "iuf"):
        raise ValueError(f"must be a one-dimensional array of real numbers; {remedy}")
    if hasattr(value, "mask"):
        raise ValueError(f"must not be masked: what hides under the mask is no number; {remedy}")
    if not 0 < len(value) <= MAX_ENTRIES:
        raise ValueError(f"must hold at least one number and at most {MAX_ENTRIES} numbers, got {len(value)}; {remedy}")
    entries = value if isinstance(value, np.ndarray) else [read_number(entry, remedy, unit, reading) for entry in value]
    vector = np.array(entries, dtype=np.float64)
    bad = np.flatnonzero(~np.isfinite(vector))
    if bad.size:
        raise ValueError(f"must be finite, but entry {bad[0]} is {vector[bad[0]]}; {remedy}")
    magnitudes = np.abs(vector[vector != 0.0])
    for extreme in (magnitudes.min(initial=1.0), magnitudes.max(initial=1.0)):
        _in_bounds(float(extreme), remedy)
    vector.setflags(write=False)
    return vector


def _written_out(value: object, unit: str | None, reading: Reading | None) -> object:
    """Numbers of a range or of a column of a file; other values are returned unchanged."""
    if isinstance(value, Mapping) and value and value.keys() <= RANGE:
        return range_of(value, unit, reading)
    if isinstance(value, Mapping) and "file" in value and value.keys() <= COLUMN:
        numbers, written = column_in_si(value, unit, reading.folder if reading else None)
        if reading and unit:
            reading.note(f"1 {written}" if written else float(np.max(np.abs(numbers))), written)
        return numbers
    return value


def range_of(table: Mapping[str, Any], unit: str | None, reading: Reading | None = None) -> FloatArray:
    """Values from start to stop, both included, with equal differences or equal factors, shape (count,).

    Raises:
        ValueError: If an end or the count is missing or wrong.
    """
    missing = [name for name in ("start", "stop", "count") if name not in table]
    if missing:
        raise refused(f"{missing[0]} is missing; a range is written {{start = 0, stop = 1e-6, count = 20}}")
    count, spacing = table["count"], table.get("spacing", "linear")
    if isinstance(count, bool) or not isinstance(count, int) or not 2 <= count <= MAX_ENTRIES:
        raise refused(f"count = {shown(count)}: must be a whole number from 2 to {MAX_ENTRIES}")
    if spacing not in ("linear", "log"):
        raise refused(f'spacing = {shown(spacing)}: must be "linear" or "log"')
    start, stop = (_end(table[name], unit, name, reading) for name in ("start", "stop"))
    if spacing == "log" and min(start, stop) <= 0.0:
        raise ValueError(f"equal factors need ends above 0, got {start:g} and {stop:g}")
    return np.linspace(start, stop, count) if spacing == "linear" else np.geomspace(start, stop, count)


def _end(value: object, unit: str | None, name: str, reading: Reading | None) -> float:
    """Start or stop of a range in SI; errors begin with its ``name``."""
    try:
        end = read_number(value, f"give one up to {LARGEST:g}, or a text with its unit", unit, reading)
    except ValueError as error:
        raise refused(f"{name} = {shown(value)}: {error}") from None
    if not abs(end) <= LARGEST:
        raise refused(f"{name} = {shown(value)}: must be a number up to {LARGEST:g}")
    return end


def vector(
    remedy: str,
    unit: str | None,
    *,
    least: float = -math.inf,
    above: float = -math.inf,
    increasing: bool = False,
) -> Checked:
    """Validator and schema of finite numbers at least ``least``, above ``above``, and increasing if so required."""

    def validate(value: object, info: ValidationInfo) -> FloatArray:
        """The read-only vector in SI; an error has the first offending entry."""
        values = as_vector(value, remedy, unit, info.context)
        for required, wrong in (
            (f"be at least {least:g}", values < least),
            (f"be above {above:g}", values <= above),
            ("increase strictly", increasing & np.append(False, np.diff(values) <= 0.0)),
        ):
            if wrong.any():
                entry = int(np.flatnonzero(wrong)[0])
                raise ValueError(f"must {required}, but entry {entry} is {values[entry]:g}; {remedy}")
        return values

    entry_schema, end_schema, text = _written(unit), {"type": ["number", "string"]}, {"type": "string"}
    span = {
        "start": end_schema,
        "stop": end_schema,
        "count": {"type": "integer", "minimum": 2},
        "spacing": {"enum": ["linear", "log"]},
    }
    column = {"file": text, "column": {"type": ["string", "integer"]}, "unit": text}
    tables = [
        {"type": "object", "properties": properties, "required": required, "additionalProperties": False}
        for properties, required in ((span, ["start", "stop", "count"]), (column, ["file"]))
    ]
    listed = {"type": "array", "items": entry_schema, "minItems": 1, "maxItems": MAX_ENTRIES}
    schema = WithJsonSchema({"anyOf": [listed, entry_schema, *tables]})
    return PlainValidator(validate), schema, *([Unit(unit)] if unit else [])

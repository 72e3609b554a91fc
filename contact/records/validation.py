"""Field validators: each names what is required and how to mend it; the value and its place are added by `record`.

Numbers of fields with a unit may be texts with one. Vectors may be lists, ranges and columns of CSV files as well.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Mapping, Sequence
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Self, TypeAlias, overload

import numpy as np
from numpy.typing import NDArray
from pydantic import PlainValidator, ValidationInfo, WithJsonSchema

from contact.records.errors import refused, shown
from contact.records.units import Unit, in_si

FloatArray: TypeAlias = NDArray[np.float64]
IntArray: TypeAlias = NDArray[np.int64]
BoolArray: TypeAlias = NDArray[np.bool_]
Number: TypeAlias = np.floating[Any] | np.integer[Any]
Numbers: TypeAlias = float | Sequence[float] | Sequence[np.floating[Any]] | np.ndarray[Any, np.dtype[Number]]
"""What a vector may be given as: a number, a list, tuple or range of numbers, or an array of shape (n,)."""

if TYPE_CHECKING:

    class Vector:
        """A field given as `Numbers` and read as a read-only float64 array, shape (n,)."""

        @overload
        def __get__(self, owner: None, kind: object) -> Self: ...
        @overload
        def __get__(self, owner: object, kind: object) -> FloatArray: ...
        def __get__(self, owner: object | None, kind: object) -> FloatArray | Self: ...
        def __set__(self, owner: object, value: Numbers) -> None: ...
else:
    # At run time the validators below convert, and the field is the array itself.
    Vector = FloatArray

# Magnitudes outside these are refused, whatever their unit: products of four of them still fit into double precision.
SMALLEST, LARGEST = 1e-75, 1e75
# A longer list in a scene is refused: it is a mistake or an attack, never a measurement.
MAX_ENTRIES = 1_000_000
RANGE = frozenset({"start", "stop", "count", "spacing"})
COLUMN = frozenset({"file", "column", "unit"})

# What stands beside the type in the annotation of a field.
Checked: TypeAlias = tuple[Any, ...]


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool | np.bool_)


def _number(value: object, remedy: str, unit: str | None) -> float:
    value = value if unit is None else in_si(value, unit)
    if not _is_number(value):
        raise ValueError(f"must be a number; {remedy}")
    try:
        # Every Real has __float__.
        return float(value)  # type: ignore[arg-type]
    except OverflowError:
        raise ValueError(f"must fit into double precision; {remedy}") from None


def _in_bounds(number: float, remedy: str) -> float:
    """A number that is zero, infinite, or of a magnitude whose products neither overflow nor vanish."""
    if number != 0.0 and math.isfinite(number) and not SMALLEST <= abs(number) <= LARGEST:
        raise ValueError(f"must have a magnitude between {SMALLEST:g} and {LARGEST:g}; use other units, and {remedy}")
    return number


def _schema(numbers: Mapping[str, Any], unit: str | None) -> WithJsonSchema:
    """Of a number with these limits; with a unit, a text may stand for it, to which no limit applies."""
    written = {"type": ["number", "string"], "pattern": r"^\s*[-+.\d]"} if unit else {"type": "number"}
    return WithJsonSchema({**written, **numbers})


def _scalar(
    remedy: str,
    required: str,
    fits: Callable[[float], bool],
    unit: str | None,
    limits: Mapping[str, Any],
    *,
    scaled: bool = True,
    words: Mapping[object, float | None] | None = None,
) -> Checked:
    """A number that fits; where it is scaled, its magnitude lies between `SMALLEST` and `LARGEST`.

    The words are other values that stand for a number or for none.
    """

    def validate(value: object) -> float | None:
        """The number, or one error with what is required and the remedy."""
        known = words or {}
        if (value is None or isinstance(value, str)) and value in known:
            return known[value]
        number = _number(value, remedy, unit)
        if not fits(number):
            raise ValueError(f"must {required}; {remedy}")
        return _in_bounds(number, remedy) if scaled else number

    return PlainValidator(validate), _schema(limits, unit), *([Unit(unit)] if unit else [])


def positive(remedy: str, unit: str | None = None) -> Checked:
    """A finite number above zero."""
    limits = {"exclusiveMinimum": 0}
    return _scalar(remedy, "be positive and finite", lambda number: 0.0 < number < math.inf, unit, limits)


def positive_or_infinite(remedy: str, unit: str | None = None) -> Checked:
    """A number above zero; infinity is allowed."""
    return _scalar(remedy, "be positive", lambda number: number > 0.0, unit, {"exclusiveMinimum": 0})


def not_negative_or_infinite(remedy: str) -> Checked:
    """A number of at least zero; infinity is allowed, in files that have none as the text "inf"."""
    validator, _ = _scalar(remedy, "be at least 0", lambda number: number >= 0.0, None, {}, words={"inf": math.inf})
    return validator, WithJsonSchema({"anyOf": [{"type": "number", "minimum": 0}, {"const": "inf"}]})


def not_negative_or_none(remedy: str, unit: str | None = None) -> Checked:
    """A finite number of at least zero, or None."""
    required = "be finite and at least 0"
    return _scalar(remedy, required, lambda n: 0.0 <= n < math.inf, unit, {"minimum": 0}, words={None: None})


def in_range(low: float, high: float, remedy: str, unit: str | None = None) -> Checked:
    """A finite number in the closed interval [low, high]; where it has no upper end, `LARGEST` is one."""
    has_end = math.isfinite(high)
    required = f"lie in [{low:g}, {high:g}]" if has_end else f"be finite and at least {low:g}"
    limits = {"minimum": low} | ({"maximum": high} if has_end else {})
    return _scalar(remedy, required, lambda n: low <= n <= high and math.isfinite(n), unit, limits, scaled=not has_end)


PositiveLength = Annotated[float, *positive("give the length in metres", "m")]


def _is_masked(value: object) -> bool:
    """Whether an array is masked; where none was ever made, numpy's module of them need not be loaded to tell."""
    masked = sys.modules.get("numpy.ma")
    return masked is not None and isinstance(value, masked.MaskedArray)


def _as_vector(value: object, remedy: str, unit: str | None) -> FloatArray:
    if _is_number(value) or (isinstance(value, str) and unit is not None and in_si(value, unit) is not value):
        value = [value]
    if isinstance(value, str | bytes) or not isinstance(value, Sequence | np.ndarray):
        raise ValueError(f"must be a list of numbers; {remedy}")  # pydantic collects ValueError only
    if isinstance(value, np.ndarray) and (value.ndim != 1 or value.dtype.kind not in "iuf"):
        raise ValueError(f"must be a one-dimensional array of real numbers; {remedy}")
    if _is_masked(value):
        raise ValueError(f"must not be masked: what hides under the mask is no number; {remedy}")
    if len(value) == 0:
        raise ValueError(f"must hold at least one number; {remedy}")
    if len(value) > MAX_ENTRIES:
        raise ValueError(f"must hold at most {MAX_ENTRIES} numbers, got {len(value)}; {remedy}")
    entries = value if isinstance(value, np.ndarray) else [_number(entry, remedy, unit) for entry in value]
    vector = np.array(entries, dtype=np.float64)
    bad = np.flatnonzero(~np.isfinite(vector))
    if bad.size:
        raise ValueError(f"must be finite, but entry {bad[0]} is {vector[bad[0]]}; {remedy}")
    extreme = np.flatnonzero((vector != 0.0) & ((np.abs(vector) < SMALLEST) | (np.abs(vector) > LARGEST)))
    if extreme.size:
        _in_bounds(float(vector[extreme[0]]), remedy)
    vector.setflags(write=False)
    return vector


def _written_out(value: object, unit: str | None, folder: Path | None) -> object:
    """The numbers of a range or of a column; anything else is returned as it came."""
    if isinstance(value, Mapping) and value and value.keys() <= RANGE:
        return range_of(value, unit)
    if isinstance(value, Mapping) and "file" in value and value.keys() <= COLUMN:
        # Only scenes that name a file pay for this import.
        from contact.files.columns import column_in_si  # noqa: PLC0415

        return column_in_si(value, unit, folder)
    return value


def range_of(table: Mapping[str, Any], unit: str | None) -> FloatArray:
    """Values from start to stop, both included, evenly spaced or by equal factors.

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
    start, stop = (_end(table[name], unit, name) for name in ("start", "stop"))
    if spacing == "log" and min(start, stop) <= 0.0:
        raise ValueError(f"equal factors need ends above 0, got {start:g} and {stop:g}")
    return np.linspace(start, stop, count) if spacing == "linear" else np.geomspace(start, stop, count)


def _end(value: object, unit: str | None, name: str) -> float:
    try:
        number = value if unit is None else in_si(value, unit)
    except ValueError as error:
        raise refused(f"{name} = {shown(value)}: {error}") from None
    # Whole numbers of any length compare with a float; not all of them convert to one.
    if not isinstance(number, int | float) or isinstance(number, bool) or not abs(number) <= LARGEST:
        raise refused(f"{name} = {shown(value)}: must be a number up to {LARGEST:g}, or a text with its unit")
    return float(number)


def _vector_validator(
    check: Callable[[FloatArray], tuple[str, BoolArray] | None], remedy: str, unit: str | None
) -> Checked:
    """A validator of finite vectors; `check` returns what is required and where it is violated."""

    def validate(value: object, info: ValidationInfo) -> FloatArray:
        """The vector, read-only, if `check` finds no offending entry; else a ValueError that names the first."""
        vector = _as_vector(_written_out(value, unit, info.context), remedy, unit)
        verdict = check(vector)
        if verdict is not None and verdict[1].any():
            entry = int(np.flatnonzero(verdict[1])[0])
            raise ValueError(f"must {verdict[0]}, but entry {entry} is {vector[entry]:g}; {remedy}")
        return vector

    one = _schema({}, unit).json_schema
    listed = {"type": "array", "items": one, "minItems": 1, "maxItems": MAX_ENTRIES}
    end, text = {"type": ["number", "string"]}, {"type": "string"}
    span = {
        "start": end,
        "stop": end,
        "count": {"type": "integer", "minimum": 2},
        "spacing": {"enum": ["linear", "log"]},
    }
    column = {"file": text, "column": {"type": ["string", "integer"]}, "unit": text}
    tables = [
        {"type": "object", "properties": properties, "required": required, "additionalProperties": False}
        for properties, required in ((span, ["start", "stop", "count"]), (column, ["file"]))
    ]
    schema = WithJsonSchema({"anyOf": [listed, one, *tables]})
    return PlainValidator(validate), schema, *([Unit(unit)] if unit else [])


def finite_vector(remedy: str, unit: str | None = None) -> Checked:
    """Finite numbers in any order."""
    return _vector_validator(lambda _: None, remedy, unit)


def increasing_vector(
    remedy: str, unit: str | None = None, *, least: float | None = None, above: float | None = None
) -> Checked:
    """Strictly increasing finite numbers, the first at `least` or strictly `above` a bound where given."""

    def check(vector: FloatArray) -> tuple[str, BoolArray]:
        """What is required of the first number or of the steps, and where a vector of shape (n,) violates it."""
        if least is not None and vector[0] < least:
            return f"be at least {least:g}", vector < least
        if above is not None and vector[0] <= above:
            return f"be above {above:g}", vector <= above
        return "increase strictly", np.concatenate([[False], np.diff(vector) <= 0.0])

    return _vector_validator(check, remedy, unit)


def bounded_vector(remedy: str, unit: str | None = None, *, least: float, strict: bool = False) -> Checked:
    """Finite numbers, each at least (or, if strict, above) a bound."""
    relation = "be above" if strict else "be at least"

    def check(vector: FloatArray) -> tuple[str, BoolArray]:
        """The bound in words, and where a vector of shape (n,) violates it."""
        return f"{relation} {least:g}", vector <= least if strict else vector < least

    return _vector_validator(check, remedy, unit)

"""Field validators: each names what is required and how to mend it; the value and its place are added by `record`."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from numbers import Real
from typing import TYPE_CHECKING, Annotated, Any, Self, TypeAlias, overload

import numpy as np
from numpy.typing import NDArray
from pydantic import PlainValidator, WithJsonSchema

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


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and not isinstance(value, bool | np.bool_)


def _number(value: object, remedy: str) -> float:
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


Checked: TypeAlias = tuple[PlainValidator, WithJsonSchema]


def _fitting(
    value: object, remedy: str, required: str, fits: Callable[[float], bool], *, is_scaled: bool = True
) -> float:
    """The number if it fits; where it has a unit, its magnitude lies between `SMALLEST` and `LARGEST`.

    Raises:
        ValueError: With what is required, and the remedy.
    """
    number = _number(value, remedy)
    if not fits(number):
        raise ValueError(f"must {required}; {remedy}")
    return _in_bounds(number, remedy) if is_scaled else number


def _checked(remedy: str, required: str, fits: Callable[[float], bool]) -> Checked:
    schema = {"type": "number", "exclusiveMinimum": 0}
    return PlainValidator(lambda value: _fitting(value, remedy, required, fits)), WithJsonSchema(schema)


def positive(remedy: str) -> Checked:
    """A finite number above zero."""
    return _checked(remedy, "be positive and finite", lambda number: 0.0 < number < math.inf)


def positive_or_infinite(remedy: str) -> Checked:
    """A number above zero; infinity is allowed."""
    return _checked(remedy, "be positive", lambda number: number > 0.0)


def not_negative_or_infinite(remedy: str) -> Checked:
    """A number of at least zero; infinity is allowed, in files that have none as the text "inf"."""

    def validate(value: object) -> float:
        """The number, or one error that names it."""
        number = math.inf if isinstance(value, str) and value == "inf" else value
        return _fitting(number, remedy, "be at least 0", lambda number: number >= 0.0)

    return PlainValidator(validate), WithJsonSchema({"anyOf": [{"type": "number", "minimum": 0}, {"const": "inf"}]})


def not_negative_or_none(remedy: str) -> Checked:
    """A finite number of at least zero, or None."""

    def validate(value: object) -> float | None:
        """None, or the number if it is finite and not negative."""
        fits = "be finite and at least 0", lambda number: 0.0 <= number < math.inf
        return None if value is None else _fitting(value, remedy, *fits)

    return PlainValidator(validate), WithJsonSchema({"type": "number", "minimum": 0})


def in_range(low: float, high: float, remedy: str) -> Checked:
    """A finite number in the closed interval [low, high]; where it has no upper end, `LARGEST` is one."""
    has_end = math.isfinite(high)
    required = f"lie in [{low:g}, {high:g}]" if has_end else f"be finite and at least {low:g}"

    def validate(value: object) -> float:
        """The number if it lies in the interval."""
        fits = required, lambda number: low <= number <= high and math.isfinite(number)
        return _fitting(value, remedy, *fits, is_scaled=not has_end)

    schema: dict[str, Any] = {"type": "number", "minimum": low}
    return PlainValidator(validate), WithJsonSchema(schema | ({"maximum": high} if has_end else {}))


def _is_masked(value: object) -> bool:
    """Whether an array is masked; where none was ever made, numpy's module of them need not be loaded to tell."""
    masked = sys.modules.get("numpy.ma")
    return masked is not None and isinstance(value, masked.MaskedArray)


def _as_vector(value: object, remedy: str) -> FloatArray:
    if _is_number(value):
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
    entries = value if isinstance(value, np.ndarray) else [_number(entry, remedy) for entry in value]
    vector = np.array(entries, dtype=np.float64)
    bad = np.flatnonzero(~np.isfinite(vector))
    if bad.size:
        raise ValueError(f"must be finite, but entry {bad[0]} is {vector[bad[0]]}; {remedy}")
    extreme = np.flatnonzero((vector != 0.0) & ((np.abs(vector) < SMALLEST) | (np.abs(vector) > LARGEST)))
    if extreme.size:
        _in_bounds(float(vector[extreme[0]]), remedy)
    vector.setflags(write=False)
    return vector


def _vector_validator(check: Callable[[FloatArray], tuple[str, NDArray[np.bool_]] | None], remedy: str) -> Checked:
    """A validator of finite vectors; `check` returns what is required and where it is violated."""

    def validate(value: object) -> FloatArray:
        """The vector, read-only, if `check` finds no offending entry; else a ValueError that names the first."""
        vector = _as_vector(value, remedy)
        verdict = check(vector)
        if verdict is not None and verdict[1].any():
            entry = int(np.flatnonzero(verdict[1])[0])
            raise ValueError(f"must {verdict[0]}, but entry {entry} is {vector[entry]:g}; {remedy}")
        return vector

    schema = {"type": "array", "items": {"type": "number"}, "minItems": 1, "maxItems": MAX_ENTRIES}
    return PlainValidator(validate), WithJsonSchema(schema)


def finite_vector(remedy: str) -> Checked:
    """Finite numbers in any order."""
    return _vector_validator(lambda _: None, remedy)


def increasing_vector(remedy: str, *, least: float | None = None, above: float | None = None) -> Checked:
    """Strictly increasing finite numbers, the first at `least` or strictly `above` a bound where given."""

    def check(vector: FloatArray) -> tuple[str, NDArray[np.bool_]]:
        """What is required of the first number or of the steps, and where a vector of shape (n,) violates it."""
        if least is not None and vector[0] < least:
            return f"be at least {least:g}", vector < least
        if above is not None and vector[0] <= above:
            return f"be above {above:g}", vector <= above
        return "increase strictly", np.concatenate([[False], np.diff(vector) <= 0.0])

    return _vector_validator(check, remedy)


def bounded_vector(remedy: str, *, least: float, strict: bool = False) -> Checked:
    """Finite numbers, each at least (or, if strict, above) a bound."""
    relation = "be above" if strict else "be at least"

    def check(vector: FloatArray) -> tuple[str, NDArray[np.bool_]]:
        """The bound in words, and where a vector of shape (n,) violates it."""
        return f"{relation} {least:g}", vector <= least if strict else vector < least

    return _vector_validator(check, remedy)


PositiveLength = Annotated[float, *positive("give the length in metres")]

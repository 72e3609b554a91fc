"""The few lines that `repr` of an answer shows: scene, quantities with units and stated errors."""

from __future__ import annotations

import dataclasses

import numpy as np

from contact.records.errors import shown
from contact.records.record import Record, unit_of
from contact.records.units import prefix_for
from contact.records.validation import FloatArray
from contact.scene.scene import Scene

# Characters of the longest name of a quantity, "coefficient_of_restitution", so that values stand below each other.
_NAME_WIDTH = 26
# A line shows so many sublayers of a stack.
_MOST_RECORDS = 3


def scene_line(scene: Scene) -> str:
    """The scene in one line, however long its arrays are."""
    return ", ".join(_call(part) for part in (scene.layer, scene.indenter, scene.loading, *scene.effects))


def quantity_line(name: str, values: FloatArray, unit: str, uncertainty: FloatArray | None) -> str:
    """First and last value with unit and absolute stated errors.

    Args:
        name: Of the quantity.
        values: Shape (n,).
        unit: Of the values; "" or "1" for a number without one.
        uncertainty: In the same unit, shape (n,) or (1,); None if the method states none.
    """
    numbers, errors = quantity_cells(values, unit, uncertainty)
    return f"{name:<{_NAME_WIDTH}} {numbers:<36} {errors}"


def quantity_cells(values: FloatArray, unit: str, uncertainty: FloatArray | None) -> tuple[str, str]:
    """First and last value with their unit, and first and last stated error, of arrays as in `quantity_line`."""
    numbers = _ends(values, "{:.7g}") + (f" {unit}" if unit not in ("", "1") else "")
    return numbers, "no error stated" if uncertainty is None else f"+- {_ends(uncertainty, '{:.1g}')}"


def _ends(values: FloatArray, form: str) -> str:
    first, last = form.format(values[0]), form.format(values[-1])
    return first if first == last else f"{first} ... {last}"


def _call(item: Record) -> str:
    fields = dataclasses.fields(item)
    parts = ((field.name, getattr(item, field.name)) for field in fields)
    shown_fields = (f"{name}={_value(value, unit_of(type(item), name))}" for name, value in parts if value is not None)
    return f"{type(item).__name__}({', '.join(shown_fields)})"


def _value(value: object, unit: str | None) -> str:
    """A field's value: numbers with their unit and a prefix, at most three records of a list."""
    if isinstance(value, Record):
        return _call(value)
    if isinstance(value, tuple) and all(isinstance(entry, Record) for entry in value):
        more = f", {len(value) - _MOST_RECORDS} more" if len(value) > _MOST_RECORDS else ""
        return f"({', '.join(_value(entry, None) for entry in value[:_MOST_RECORDS])}{more})"
    if not isinstance(value, np.ndarray | float):
        return shown(value)
    numbers = np.atleast_1d(np.asarray(value, dtype=np.float64))
    factor, prefix = prefix_for(numbers.tolist()) if unit else (1.0, "")
    text = _ends(numbers / factor, "{:.6g}")
    text = f"[{text}]" if isinstance(value, np.ndarray) else text
    count = f" ({numbers.size} values)" if numbers.size > 2 else ""
    return f"{text} {prefix}{unit}{count}" if unit else f"{text}{count}"

"""The few lines that `repr` of an answer shows: scene, quantities with units and stated errors."""

from __future__ import annotations

import dataclasses

import numpy as np

from contact.records.record import Record, shown
from contact.records.validation import FloatArray
from contact.scene.scene import Scene

# Characters of the longest name of a quantity, "coefficient_of_restitution", so that values stand below each other.
_NAME_WIDTH = 26


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
    numbers = _ends(values, "{:.7g}") + (f" {unit}" if unit not in ("", "1") else "")
    errors = "no error stated" if uncertainty is None else f"+- {_ends(uncertainty, '{:.1g}')}"
    return f"{name:<{_NAME_WIDTH}} {numbers:<36} {errors}"


def _ends(values: FloatArray, form: str) -> str:
    first, last = form.format(values[0]), form.format(values[-1])
    return first if first == last else f"{first} ... {last}"


def _call(item: Record) -> str:
    fields = dataclasses.fields(item)  # type: ignore[arg-type]  # every record is a dataclass
    parts = ((field.name, getattr(item, field.name)) for field in fields)
    return (
        f"{type(item).__name__}({', '.join(f'{name}={_value(value)}' for name, value in parts if value is not None)})"
    )


def _value(value: object) -> str:
    if isinstance(value, np.ndarray):
        return f"[{_ends(value, '{:g}')}]" + (f" ({value.size} values)" if value.size > 2 else "")
    return f"{value:g}" if isinstance(value, float) else shown(value)

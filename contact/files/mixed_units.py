"""Which dimensional numbers of a scene file have a unit, and which are bare."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

import numpy as np

from contact.files.units import EXAMPLE_OF_UNIT, UNIT_OF_FIELD
from contact.files.values import RANGE, Column
from contact.records.errors import InvalidInput
from contact.records.record import shown

# A message names so many bare fields.
_MOST_NAMED: Final = 8
# Fields with a unit that depends on their record, or that no record has.
_FURTHER: Final = frozenset({"values", "noise"})


def refuse_mixed_units(mapping: Mapping[str, object]) -> None:
    """Refuse a scene in which some dimensional numbers have units and others are bare; 0 and inf need none.

    Args:
        mapping: Tables of the scene, columns of files read.

    Raises:
        InvalidInput: With the bare fields, their values and the remedy.
    """
    numbers = list(_dimensional(mapping, "", ""))
    bare = {place: value for place, value in numbers if not _has_unit(value)}
    example = next((value for _, value in numbers if _has_unit(value)), None)
    if bare and example is not None:
        named = ", ".join(f"{place} = {_written(value)}" for place, value in list(bare.items())[:_MOST_NAMED])
        raise InvalidInput(
            f"{named}: no unit, but other numbers of this scene have one ({_written(example)}); write every length, "
            f'time, force, .. with its unit, as in "{EXAMPLE_OF_UNIT["m"]}", or none of them (SI)'
        )


def has_units(mapping: Mapping[str, object]) -> bool:
    """Whether some dimensional number of a scene is a text with a unit."""
    return any(_has_unit(value) for _, value in _dimensional(mapping, "", ""))


def _has_unit(value: object) -> bool:
    """Whether a dimensional entry is a text with a unit, or a column of a file with one."""
    return bool(value.unit) if isinstance(value, Column) else isinstance(value, str)


def _dimensional(value: object, field: str, place: str) -> Iterator[tuple[str, object]]:
    """Place (without the number in a list) and value of each dimensional number that is neither zero nor infinite."""
    if isinstance(value, Mapping):
        span = bool(value) and value.keys() <= RANGE
        for key, entry in value.items():
            yield from _dimensional(entry, field if span else str(key), f"{place}.{key}" if place else str(key))
    elif isinstance(value, Sequence) and not isinstance(value, str | bytes):
        for number, entry in enumerate(value):
            is_table = isinstance(entry, Mapping)
            yield from _dimensional(entry, field, f"{place}[{number}]" if is_table else place)
    elif _has_dimension(field, place) and not _needs_no_unit(value):
        yield place, value


def _has_dimension(field: str, place: str) -> bool:
    pure = place.endswith((".count", ".spacing")) or (field == "values" and "poissons_ratio" in place)
    return (field in UNIT_OF_FIELD or field in _FURTHER) and not pure


def _needs_no_unit(value: object) -> bool:
    if isinstance(value, Column):
        return not np.any(value.values)
    if isinstance(value, str):
        return value == "inf"
    return isinstance(value, bool) or not isinstance(value, int | float) or value in (0, math.inf)


def _written(value: object) -> str:
    return f"column {shown(value.name)}" if isinstance(value, Column) else shown(value)

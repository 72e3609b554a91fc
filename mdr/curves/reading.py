"""Force curves from tables and from files of microscopes, as depth [m] and force [N] of one direction.

A quantity is read from the head of its column: depth, or height, and force, or deflection. Height and deflection become
depth and force by the spring constant and the sensitivity of the cantilever.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, Literal

import numpy as np

from contact import InvalidInput
from contact.records.units import read_quantity
from contact.records.validation import FloatArray
from mdr.curves.microscopes import ENDINGS, read_measured
from mdr.curves.tables import Column, Table, read_table

Direction = Literal["loading", "withdrawal"]

# Beginnings of the heads of columns, in lower case. Depths and separations hold no bending of the cantilever.
_NAMES: Final = {
    "depth": ("depth", "indentation", "delta", "penetration"),
    "separation": ("tip", "separation", "distance", "tss"),
    "height": ("height", "z", "piezo", "displacement", "measured height", "sensor"),
    "force": ("force", "load", "f", "p ", "normal force"),
    "deflection": ("deflection", "vertical deflection", "defl", "vdefl", "d "),
}
# Share of the travel by which a depth goes back before it is another direction. Noise of a tenth of it turns nothing.
_TURN: Final = 0.2


@dataclass(frozen=True)
class Cantilever:
    """Numbers given by hand.

    Attributes:
        spring_constant: [N/m], or None.
        sensitivity: Deflection over signal [m/V], or None.
    """

    spring_constant: float | None = None
    sensitivity: float | None = None


@dataclass(frozen=True)
class Measured:
    """One force curve.

    Attributes:
        depth: [m] from any zero, shape (n,).
        force: [N], shape (n,).
        notes: What was recognised and converted, in words.
    """

    depth: FloatArray
    force: FloatArray
    notes: tuple[str, ...] = ()


def read_curve(
    file: str | Path,
    number: int = 0,
    *,
    units: str = "",
    cantilever: Cantilever | None = None,
    direction: Direction = "loading",
) -> tuple[FloatArray, FloatArray]:
    """Depth [m] and force [N] of one curve, each of shape (n,); as `load_curves` reads it.

    Raises:
        InvalidInput: As `load_curves` does, and if there is no curve of that number.
    """
    curves = load_curves(file, units=units, cantilever=cantilever, direction=direction)
    if not 0 <= number < len(curves):
        raise InvalidInput(f"{file}: has no curve {number}; it has {len(curves)}, counted from 0")
    return curves[number].depth, curves[number].force


def read_map(file: str | Path, *, units: str = "", direction: Direction = "loading") -> list[Measured]:
    """The curves of a map: depths in the first column and forces of a curve in each other one, or a microscope's file.

    Raises:
        InvalidInput: As `load_curves` does, or if a table has a single column.
    """
    if Path(file).suffix in ENDINGS:
        return load_curves(file, direction=direction)
    table = read_table(Path(file), units)
    if len(table.columns) < 2:
        raise InvalidInput(f"{file}: a map has depths in its first column, and forces of a curve in each other one")
    first, *others = table.columns
    if not units and others[0].unit:
        others = [one if one.unit else replace(one, unit=others[0].unit) for one in others]
    depth = _si(first, "m", file)
    return [_one_direction(depth, _si(one, "N", file), (), direction, f"{file}, {one.name}") for one in others]


def load_curves(
    file: str | Path, *, units: str = "", cantilever: Cantilever | None = None, direction: Direction = "loading"
) -> list[Measured]:
    """The curves of a file in one direction, with what was recognised.

    Args:
        file: Table, or what a microscope has written (`mdr.curves.microscopes`).
        units: Of the columns of a table, "nm,nN", where their heads have none.
        cantilever: Spring constant and sensitivity for columns of height and deflection.
        direction: Which part of a curve with loading and withdrawal.

    Raises:
        InvalidInput: If the file cannot be read, has no such columns, no units, or more than two directions.
    """
    if Path(file).suffix in ENDINGS:
        constant = None if cantilever is None else cantilever.spring_constant
        return [Measured(d, f) for d, f in read_measured(Path(file), constant, direction)]
    table = read_table(Path(file), units)
    depth, force, notes = _converted(table, cantilever or Cantilever(), file)
    return [_one_direction(depth, force, (*table.notes, *notes), direction, str(file))]


def _converted(
    table: Table, cantilever: Cantilever, file: str | Path
) -> tuple[FloatArray, FloatArray, tuple[str, ...]]:
    """Depth [m] and force [N] from the columns that the table has."""
    found = {kind: _named(table.columns, names) for kind, names in _NAMES.items()}
    notes = []
    place = next((found[kind] for kind in ("depth", "separation", "height") if found[kind] is not None), None)
    signal = found["force"] or found["deflection"]
    if place is None or signal is None:
        if len(table.columns) != 2 or any(column is not None for column in found.values()):
            heads = ", ".join(column.name or "?" for column in table.columns)
            raise InvalidInput(f"{file}: needs a column of depth or height and one of force or deflection; has {heads}")
        place, signal = table.columns
        found["depth"] = place
    bending: FloatArray | None
    if found["force"] is None and found["deflection"] is not None:
        force, bending = _bent(signal, cantilever, file)
        notes.append("force and depth from the deflection, by the spring constant")
    else:
        force = _si(signal, "N", file)
        bending = force / cantilever.spring_constant if cantilever.spring_constant else None
    depth = _si(place, "m", file)
    if _falls(depth, force):
        notes.append(f"{place.name or 'the first column'} falls into the contact: its sign is changed")
        depth = -depth
    if place is found["height"] and found["depth"] is None:
        if bending is None:
            raise InvalidInput(
                f"{file}: {place.name} is a height, which holds the bending of the cantilever; give its spring "
                'constant (--spring-constant "0.05 N/m"), or a column of depth'
            )
        notes.append("depth = height less bending of the cantilever")
        depth = depth - bending
    return depth, force, tuple(notes)


def _bent(signal: Column, cantilever: Cantilever, file: str | Path) -> tuple[FloatArray, FloatArray]:
    """Force [N] and deflection [m] from a column of deflection in metres or volts."""
    if cantilever.spring_constant is None:
        raise InvalidInput(f'{file}: {signal.name} is a deflection; give --spring-constant "0.05 N/m"')
    if signal.unit.endswith("V"):
        if cantilever.sensitivity is None:
            raise InvalidInput(f'{file}: {signal.name} is in {signal.unit}; give --sensitivity "50 nm/V"')
        bending = signal.values * _factor(signal.unit[:-1]) * cantilever.sensitivity
    else:
        bending = _si(signal, "m", file)
    return cantilever.spring_constant * bending, bending


def _factor(prefix: str) -> float:
    return {"": 1.0, "m": 1e-3, "u": 1e-6, "k": 1e3}[prefix]


def _named(columns: Sequence[Column], names: Sequence[str]) -> Column | None:
    """The column whose head is, or begins with, one of the names; short names have to be the whole head."""
    for name in names:
        for one in columns:
            head = one.name.lower().replace("_", " ").strip()
            if head == name.strip() or (len(name.strip()) > 2 and head.startswith(name)):
                return one
    return None


def _si(one: Column, unit: str, file: str | Path) -> FloatArray:
    factor = read_quantity(f"1 {one.unit}", unit, f"{file}, column {one.name!r}")
    return np.asarray(one.values / round(1 / factor) if factor < 1 else one.values * factor)


def _falls(depth: FloatArray, force: FloatArray) -> bool:
    """Whether the largest forces are at the least depths."""
    high = force > force.min() + 0.7 * np.ptp(force)
    return bool(np.mean(depth[high]) < 0.5 * (depth.min() + depth.max()))


def _one_direction(
    depth: FloatArray, force: FloatArray, notes: tuple[str, ...], direction: Direction, place: str
) -> Measured:
    """The part of a curve in one direction; a curve of one direction as it is.

    Raises:
        InvalidInput: If the depth turns more than once.
    """
    kept = np.isfinite(depth) & np.isfinite(force)
    depth, force = depth[kept], force[kept]
    if depth.size < 3:
        raise InvalidInput(f"{place}: fewer than three points")
    turns = _turning_points(depth)
    if len(turns) > 1:
        raise InvalidInput(
            f"{place}: the depth turns {len(turns)} times (first at point {turns[0] + 1}); keep one loading or "
            "withdrawal"
        )
    if not turns:
        return Measured(depth, force, notes)
    parts = slice(0, turns[0] + 1), slice(turns[0] + 1, None)
    rises = [depth[part][-1] > depth[part][0] for part in parts]
    part = parts[rises.index(direction == "loading")]
    notes = (*notes, f"loading and withdrawal in one curve: the {direction} is used ({depth[part].size} points)")
    return Measured(depth[part], force[part], notes)


def _turning_points(depth: FloatArray) -> list[int]:
    """Numbers of the points at which the depth turns back by more than noise."""
    turns, extreme, sign, least = list[int](), 0, 0, _TURN * float(np.ptp(depth))
    for i, d in enumerate(depth.tolist()):
        moved = d - float(depth[extreme])
        if sign == 0 and abs(moved) > least:
            sign, extreme = (1 if moved > 0 else -1), i
        elif sign * moved > 0.0:
            extreme = i
        elif sign and -sign * moved > least:
            turns.append(extreme)
            sign, extreme = -sign, i
    return turns

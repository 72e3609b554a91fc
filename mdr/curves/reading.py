"""Force curves from tables and from files of microscopes, as depth [m] and force [N], and time [s] where it is there.

A quantity is read from the head of its column: depth, or height, and force, or deflection. Height and deflection become
depth and force by the spring constant and the sensitivity of the cantilever. Binary files are read by afmformats.
"""

from __future__ import annotations

import logging
import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final, Literal, TypeAlias

import numpy as np

from contact import InvalidInput
from contact.records.tables import Column, Table, in_unit, name_and_unit, plain_unit, read_table, table_text
from contact.records.validation import FloatArray

Direction: TypeAlias = Literal["loading", "withdrawal", "history"]

# Endings that afmformats reads; .csv and .txt are tables unless they begin as those of AFM Workshop do.
ENDINGS: Final = (".h5", ".ibw", ".jpk-force", ".jpk-force-map", ".jpk-qi-data", ".jpk-qi-series", ".tab", ".zip")
_WORKSHOP: Final = "Force-Distance Curve"
# Beginnings of the heads of columns, in lower case. Depths and separations hold no bending of the cantilever.
_NAMES: Final = {
    "depth": ("depth", "indentation", "delta", "penetration", "h ", "extension"),
    "separation": ("verticaltipposition", "tip", "separation", "distance", "tss"),
    "height": ("height", "z", "piezo", "displacement", "measured height", "sensor", "calc ramp", "ramp"),
    "force": ("force", "load", "f", "p ", "normal force"),
    "deflection": ("deflection", "vertical deflection", "defl", "vdefl", "d ", "t-b"),
    "time": ("time", "t "),
    "curve": ("curve", "id ", "pixel"),
    "x": ("x ", "position x", "x position", "xposition"),
    "y": ("y ", "position y", "y position", "yposition"),
}
# Words by which columns of loading and of withdrawal are told apart in one head.
_SIDES: Final = {
    "loading": r"extend|approach|loading|ex|trace",
    "withdrawal": r"retract|withdraw(?:al)?|unloading|rt|retrace",
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
        time: [s], shape (n,), or empty.
        position: x and y in the map [m], not a number where unknown.
    """

    depth: FloatArray
    force: FloatArray
    notes: tuple[str, ...] = ()
    time: FloatArray = field(default_factory=lambda: np.empty(0))
    position: tuple[float, float] = (np.nan, np.nan)


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


def read_map(
    file: str | Path, *, units: str = "", cantilever: Cantilever | None = None, direction: Direction = "loading"
) -> list[Measured]:
    """The curves of a map.

    Args:
        file: A microscope's file; or a table with a column that numbers the curves, and x and y where they are known;
            or one with depths in its first column and forces of a curve in each other one.
        units: As for `load_curves`.
        cantilever: As for `load_curves`.
        direction: As for `load_curves`.

    Raises:
        InvalidInput: As `load_curves` does, or if a table has a single column.
    """
    if _is_of_microscope(Path(file)):
        return load_curves(file, cantilever=cantilever, direction=direction)
    table = _with_units(Path(file), units)
    if _named(table.columns, "curve") is not None:
        return load_curves(file, units=units, cantilever=cantilever, direction=direction)
    if len(table.columns) < 2:
        raise InvalidInput(f"{file}: a map has depths in its first column, and forces of a curve in each other one")
    first, *others = table.columns
    if not units and others[0].unit:
        others = [one if one.unit else replace(one, unit=others[0].unit) for one in others]
    depth = _si(first, "m", file)
    return [_one_direction(Measured(depth, _si(one, "N", file)), direction, f"{file}, {one.name}") for one in others]


def load_curves(
    file: str | Path, *, units: str = "", cantilever: Cantilever | None = None, direction: Direction = "loading"
) -> list[Measured]:
    """The curves of a file in one direction, with what was recognised.

    Args:
        file: Table, or what a microscope has written.
        units: Of the columns of a table, "nm,nN", where their heads have none.
        cantilever: Spring constant and sensitivity for columns of height and deflection.
        direction: Which part of a curve with loading and withdrawal; "history" is all of it.

    Raises:
        InvalidInput: If the file cannot be read, has no such columns, no units, or more than two directions.
    """
    path, known = Path(file), cantilever or Cantilever()
    if _is_of_microscope(path) or (known.sensitivity and known.spring_constant and _is_of_nova(path)):
        return _read_measured(path, known, direction)
    table = _with_units(path, units)
    numbers = _named(table.columns, "curve")
    rows = [np.arange(table.columns[0].values.size)]
    if numbers is not None:
        rows = [np.flatnonzero(numbers.values == number) for number in np.unique(numbers.values)]
    return [_one_curve(table.at_rows(index), known, direction, str(file)) for index in rows]


def _with_units(file: Path, given: str) -> Table:
    """The table in units that are given, "nm,nN", the last one for all further columns, or else in those of its heads.

    Raises:
        InvalidInput: If there are none.
    """
    table = read_table(file)
    if given:
        units = [plain_unit(part) for part in given.split(",")]
        units += [units[-1]] * (len(table.columns) - len(units))
        return replace(table, columns=tuple(replace(one, unit=u) for one, u in zip(table.columns, units, strict=False)))
    if not any(column.unit for column in table.columns):
        names = ", ".join(column.name for column in table.columns if column.name)
        raise InvalidInput(
            f"{file}, line {table.line}: columns without units{f' ({names})' if names else ''}; write them in the "
            "heads, as in depth [nm], or give --units nm,nN in the order of the columns"
        )
    return table


def _one_curve(table: Table, cantilever: Cantilever, direction: Direction, place: str) -> Measured:
    """The curve of all rows of a table."""
    table, side = _one_side(table, direction)
    gaps = [f"{len(table.gaps)} rows with gaps are left out (first: line {table.gaps[0]})"] if table.gaps else []
    if cantilever.spring_constant is None and table.spring_constant:
        cantilever = replace(cantilever, spring_constant=table.spring_constant)
    time, x, y = (_named(table.columns, name) for name in ("time", "x", "y"))
    found = _converted(table, cantilever, place)
    whole = replace(
        found,
        notes=(*gaps, *side, *found.notes),
        time=_si(time, "s", place) if time is not None and time.unit else np.empty(0),
        position=(_place(x, place), _place(y, place)),
    )
    return _one_direction(whole, direction, place)


def _place(column: Column | None, place: str) -> float:
    return float(_si(column, "m", place)[0]) if column is not None and column.unit else np.nan


def _one_side(table: Table, direction: Direction) -> tuple[Table, list[str]]:
    """The table with the columns of one direction, and a note, where heads say which those are."""
    sides = {
        side: [
            (c, pattern)
            for c in table.columns
            for pattern in [rf"(?i)(?:^|[\s_(-])({words})(?=$|[\s_).-])"]
            if re.search(pattern, c.name)
        ]
        for side, words in _SIDES.items()
    }
    if not (len(sides["loading"]) >= 2 and len(sides["withdrawal"]) >= 2):
        return table, []
    columns = []
    for column, pattern in sides["withdrawal" if direction == "withdrawal" else "loading"]:
        name, unit = name_and_unit(re.sub(pattern, "", column.name).strip(" _-"))
        columns.append(replace(column, name=name, unit=column.unit or unit))
    return replace(table, columns=tuple(columns)), [f"columns of {direction} are used"]


def _converted(table: Table, cantilever: Cantilever, file: str | Path) -> Measured:
    """Depth and force from the columns that the table has."""
    found = {kind: _named(table.columns, kind) for kind in ("depth", "separation", "height", "force", "deflection")}
    notes = []
    if found["deflection"] is not None and found["force"] is None and found["deflection"].unit.endswith("N"):
        found["force"] = found["deflection"]
    height = found["height"]
    if height is not None and found["force"] is not None and _is_indenter(height.name, found["force"].name):
        found["depth"] = found["depth"] or height
    place = next((found[kind] for kind in ("depth", "separation", "height") if found[kind] is not None), None)
    signal = found["force"] or found["deflection"]
    if place is None or signal is None:
        if len(table.columns) != 2 or any(column is not None for column in found.values()):
            heads = ", ".join(column.name or "?" for column in table.columns)
            raise InvalidInput(
                f"{file}: needs a column of depth or height and one of force or deflection; rename the heads ({heads})"
            )
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
    if place is height and found["depth"] is None:
        if bending is None:
            raise InvalidInput(
                f"{file}: {place.name} is a height, which holds the bending of the cantilever; give its spring "
                'constant (--spring-constant "0.05 N/m"), or a column of depth'
            )
        notes.append("depth = height less bending of the cantilever")
        depth = depth - bending
    return Measured(depth, force, tuple(notes))


def _is_indenter(height: str, force: str) -> bool:
    """Whether the heads are those of an indenter, whose displacement is the depth."""
    return height.lower().startswith("displacement") and force.lower().startswith("load")


def _bent(signal: Column, cantilever: Cantilever, file: str | Path) -> tuple[FloatArray, FloatArray]:
    """Force [N] and deflection [m] from a column of deflection in metres or volts."""
    if cantilever.spring_constant is None:
        raise InvalidInput(f'{file}: {signal.name} is a deflection; give --spring-constant "0.05 N/m"')
    if signal.unit.endswith("V"):
        if cantilever.sensitivity is None:
            raise InvalidInput(f'{file}: {signal.name} is in {signal.unit}; give --sensitivity "50 nm/V"')
        factor = {"": 1.0, "m": 1e-3, "u": 1e-6, "k": 1e3}[signal.unit[:-1]]
        bending = signal.values * factor * cantilever.sensitivity
    else:
        bending = _si(signal, "m", file)
    return cantilever.spring_constant * bending, bending


def _named(columns: Sequence[Column], kind: str) -> Column | None:
    """The column whose head is, or begins with, a name of that kind; short names have to be the whole head."""
    for name in _NAMES[kind]:
        for one in columns:
            head = one.name.lower().replace("_", " ").strip()
            if head == name.strip() or (len(name.strip()) > 2 and head.startswith(name)):
                return one
    return None


def _si(one: Column, unit: str, file: str | Path) -> FloatArray:
    if not one.unit:
        raise InvalidInput(f"{file}, column {one.name!r}: has no unit; write it in the head, as in depth [nm]")
    try:
        return in_unit(one.values, one.unit, unit)
    except InvalidInput as error:
        raise InvalidInput(f"{file}, column {one.name!r}, unit {one.unit!r}: {error}") from None


def _falls(depth: FloatArray, force: FloatArray) -> bool:
    """Whether the largest forces are at the least depths."""
    high = force >= force.min() + 0.7 * np.ptp(force)
    return bool(np.mean(depth[high]) < 0.5 * (depth.min() + depth.max()))


def _one_direction(curve: Measured, direction: Direction, place: str) -> Measured:
    """The part of a curve in one direction; a curve of one direction, and a history, as it is.

    Raises:
        InvalidInput: If the depth turns more than once.
    """
    kept = np.isfinite(curve.depth) & np.isfinite(curve.force)
    if int(kept.sum()) < 3:
        raise InvalidInput(f"{place}: fewer than three points")
    whole = _at_rows(curve, kept)
    if direction == "history":
        if not whole.time.size:
            raise InvalidInput(f"{place}: needs a column of time with its unit, for the scene relaxes over time")
        return whole
    turns = _turning_points(whole.depth)
    if len(turns) > 1:
        raise InvalidInput(
            f"{place}: the depth turns {len(turns)} times (first at point {turns[0] + 1}); keep one loading or "
            "withdrawal"
        )
    if not turns:
        return whole
    parts = slice(0, turns[0] + 1), slice(turns[0] + 1, None)
    rises = [whole.depth[part][-1] > whole.depth[part][0] for part in parts]
    found = _at_rows(whole, parts[rises.index(direction == "loading")])
    note = f"loading and withdrawal in one curve: the {direction} is used ({found.depth.size} points)"
    return replace(found, notes=(*found.notes, note))


def _at_rows(curve: Measured, rows: Any) -> Measured:
    time = curve.time[rows] if curve.time.size else curve.time
    return replace(curve, depth=curve.depth[rows], force=curve.force[rows], time=time)


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


def _is_of_microscope(file: Path) -> bool:
    """Whether afmformats reads the file: by its ending, and tables of AFM Workshop by their first line."""
    if file.suffix in ENDINGS:
        return True
    return file.suffix == ".csv" and file.is_file() and table_text(file)[: len(_WORKSHOP)] == _WORKSHOP


def _is_of_nova(file: Path) -> bool:
    """Whether the file has the three columns without heads that NT-MDT's Nova writes: height and both deflections."""
    columns = read_table(file).columns
    return file.suffix == ".txt" and len(columns) == 3 and not any(column.name for column in columns)


def _read_measured(file: Path, cantilever: Cantilever, direction: Direction) -> list[Measured]:
    """Curves of a microscope's file; the depth is the piezo's way less the bending of the cantilever.

    Raises:
        InvalidInput: If afmformats is missing or cannot read the file, or it has no curve.
    """
    try:
        import afmformats  # noqa: PLC0415  # an optional package
    except ImportError:
        raise InvalidInput(
            f"{file}: files of microscopes are read by afmformats; pip install 'contact-verification[fit]', or export "
            "depth and force to CSV"
        ) from None
    if not file.is_file():
        raise InvalidInput(f"{file}: no such file")
    given = {"spring constant": cantilever.spring_constant, "sensitivity": cantilever.sensitivity}
    override = {name: value for name, value in given.items() if value is not None}
    try:
        # It would print a traceback of what is refused here in one line.
        logging.getLogger("afmformats.formats").disabled = True
        measured: Sequence[Any] = afmformats.load_data(file, meta_override=override)
        curves = [_segment(one, direction) for one in measured if one.modality != "unknown"]
    except InvalidInput as error:
        raise InvalidInput(f"{file}: {error}") from None
    except afmformats.errors.MissingMetaDataError:
        raise InvalidInput(
            f'{file}: holds no calibration; give --spring-constant "0.05 N/m" and --sensitivity "50 nm/V"'
        ) from None
    except (Exception, afmformats.errors.AFMFileFormatError, afmformats.meta.MetaDataMissingError) as error:
        # Each format fails in its own way, and some by what is no Exception.
        raise InvalidInput(f"{file}: afmformats cannot read it ({type(error).__name__}: {error!s:.120})") from None
    if not curves:
        raise InvalidInput(f"{file}: has no force-distance curve")
    return curves


def _segment(measured: Any, direction: Direction) -> Measured:
    """Depth from any zero and force of the approach, the withdrawal, or all of a curve."""
    parts = {"loading": "appr", "withdrawal": "retr"}
    segment = getattr(measured, parts.get(direction, ""), measured)
    force = np.asarray(segment["force"], dtype=np.float64)
    place = tuple(float(measured.metadata.get(f"position {axis}", np.nan)) for axis in "xy")
    time = np.asarray(segment["time"], dtype=np.float64) if "time" in measured.columns else np.empty(0)
    if "tip position" in measured.columns:
        depth = -np.asarray(segment["tip position"], dtype=np.float64)
    else:
        height = "height (measured)" if "height (measured)" in measured.columns else "height (piezo)"
        stiffness = float(measured.metadata.get("spring constant", np.nan))
        if not stiffness > 0.0:
            raise InvalidInput('has no spring constant of the cantilever; give it (--spring-constant "0.05 N/m")')
        depth = -np.asarray(segment[height], dtype=np.float64) - force / stiffness
    kept = np.isfinite(depth) & np.isfinite(force)
    return _at_rows(Measured(depth, force, (), time, (place[0], place[1])), kept)

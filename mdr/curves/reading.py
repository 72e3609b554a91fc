"""Force curves from tables and from files of microscopes, as depth [m], force [N], and time [s] where the file has it.

A quantity is read from the head of its column: depth, or height, and force, or deflection. Height and deflection become
depth and force by the spring constant and the sensitivity of the cantilever. Binary files are read by afmformats.
"""

from __future__ import annotations

import logging
import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final, Literal, TypeAlias, TypedDict, Unpack

import numpy as np
from scipy.signal import find_peaks

from contact import InvalidInput
from contact.records.tables import Column, Table, in_unit, name_and_unit, plain_unit, read_table, table_text
from contact.records.validation import FloatArray

Direction: TypeAlias = Literal["loading", "withdrawal", "history"]

# Endings that afmformats reads; .csv and .txt are tables unless they begin as those of AFM Workshop do.
ENDINGS: Final = (".h5", ".ibw", ".jpk-force", ".jpk-force-map", ".jpk-qi-data", ".jpk-qi-series", ".tab", ".zip")
_WORKSHOP: Final = "Force-Distance Curve"
# Beginnings of the heads of columns, in lower case. Depths and separations exclude the bending of the cantilever.
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
# Words in heads by which columns of loading and of withdrawal differ.
_SIDES: Final = {
    "loading": re.compile(r"(?i)(?:^|[\s_(-])(extend|approach|loading|ex|trace)(?=$|[\s_).-])"),
    "withdrawal": re.compile(r"(?i)(?:^|[\s_(-])(retract|withdraw(?:al)?|unloading|rt|retrace)(?=$|[\s_).-])"),
}
# Least reversal of the depth over the travel that is a turning point. Noise of a tenth of it makes none.
_TURN: Final = 0.2


@dataclass(frozen=True)
class Cantilever:
    """Calibration of a cantilever, given by hand.

    Attributes:
        spring_constant: Spring constant [N/m], or None.
        sensitivity: Deflection over signal [m/V], or None.
    """

    spring_constant: float | None = None
    sensitivity: float | None = None


@dataclass(frozen=True)
class Measured:
    """One force curve.

    Attributes:
        depth: Depths [m] from any zero, shape (n,).
        force: Forces [N], shape (n,).
        notes: Sentences on recognised columns and conversions.
        time: Instants [s], shape (n,), or empty.
        position: Position x and y in the map [m], not a number where unknown.
    """

    depth: FloatArray
    force: FloatArray
    notes: tuple[str, ...] = ()
    time: FloatArray = field(default_factory=lambda: np.empty(0))
    position: tuple[float, float] = (np.nan, np.nan)

    def at_rows(self, rows: Any) -> Measured:
        """The curve reduced to some of its points."""
        time = self.time[rows] if self.time.size else self.time
        return replace(self, depth=self.depth[rows], force=self.force[rows], time=time)


class Source(TypedDict, total=False):
    """Options of reading a file.

    Attributes:
        units: Units of the columns of a table, "nm,nN", where their heads have none.
        cantilever: Spring constant and sensitivity for columns of height and deflection.
        direction: The part of a curve with loading and withdrawal that is returned; "history" returns all of it.
    """

    units: str
    cantilever: Cantilever
    direction: Direction


def read_curve(file: str | Path, number: int = 0, **source: Unpack[Source]) -> tuple[FloatArray, FloatArray]:
    """Depth [m] and force [N] of one curve, each of shape (n,); as `load_curves` reads it.

    Raises:
        InvalidInput: As `load_curves` does, and if there is no curve of that number.
    """
    curve = numbered(load_curves(file, **source), number, file)
    return curve.depth, curve.force


def numbered(curves: Sequence[Measured], number: int, file: str | Path) -> Measured:
    """The curve of that number, counted from 0.

    Raises:
        InvalidInput: If the file has no such curve.
    """
    if not 0 <= number < len(curves):
        raise InvalidInput(f"{file}: has no curve {number}; it has {len(curves)}, counted from 0")
    return curves[number]


def read_map(file: str | Path, **source: Unpack[Source]) -> list[Measured]:
    """The curves of a map: as `load_curves` reads them, or each column after the first as forces of a curve.

    Raises:
        InvalidInput: As `load_curves` does, or if a table has a single column.
    """
    return load_curves(file, is_map=True, **source)


def load_curves(
    file: str | Path,
    *,
    units: str = "",
    cantilever: Cantilever | None = None,
    direction: Direction = "loading",
    is_map: bool = False,
) -> list[Measured]:
    """The curves of a file in one direction, with notes on recognised columns.

    Args:
        file: Table, perhaps with a column that numbers the curves, and columns x and y; or a microscope's file.
        units: Units of the columns of a table, "nm,nN", where their heads have none.
        cantilever: Spring constant and sensitivity for columns of height and deflection.
        direction: The part of a curve with loading and withdrawal that is returned; "history" returns all of it.
        is_map: Whether a table without numbers of curves has depths in its first column, and the forces of one curve in
            each further column.

    Raises:
        InvalidInput: If the file cannot be read, has no such columns, no units, or more than two directions.
    """
    path, calibration = Path(file), cantilever or Cantilever()
    if _is_of_microscope(path) or (calibration.sensitivity and calibration.spring_constant and _is_of_nova(path)):
        return _read_measured(path, calibration, direction)
    table = _with_units(path, units)
    numbers = _named(table.columns, "curve")
    if numbers is not None:
        rows = [np.flatnonzero(numbers.values == number) for number in np.unique(numbers.values)]
        return [_one_curve(table.at_rows(index), calibration, direction, str(file)) for index in rows]
    if not is_map:
        return [_one_curve(table, calibration, direction, str(file))]
    if len(table.columns) < 2:
        raise InvalidInput(f"{file}: a map has depths in its first column, and forces of a curve in each other one")
    depth, forces = _si(table.columns[0], "m", file), table.columns[1:]
    forces = tuple(replace(force, unit=force.unit or forces[0].unit) for force in forces)
    return [
        _one_direction(Measured(depth, _si(force, "N", file)), direction, f"{file}, {force.name}") for force in forces
    ]


def _with_units(file: Path, given: str) -> Table:
    """The table with given units, "nm,nN", the last one for all further columns, or else with those of its heads.

    Raises:
        InvalidInput: If there are no units.
    """
    table = read_table(file)
    if given:
        units = [plain_unit(part) for part in given.split(",")]
        units += [units[-1]] * len(table.columns)
        columns = (replace(column, unit=unit) for column, unit in zip(table.columns, units, strict=False))
        return replace(table, columns=tuple(columns))
    if not any(column.unit for column in table.columns):
        names = ", ".join(column.name for column in table.columns if column.name)
        raise InvalidInput(
            f"{file}, line {table.line}: columns without units{f' ({names})' if names else ''}; write them in the "
            "heads, as in depth [nm], or give --units nm,nN in the order of the columns"
        )
    return table


def _one_curve(table: Table, cantilever: Cantilever, direction: Direction, place: str) -> Measured:
    """The curve of a table that contains one curve only."""
    notes = [f"{len(table.gaps)} rows with gaps are left out (first: line {table.gaps[0]})"] if table.gaps else []
    columns = _columns_of("withdrawal" if direction == "withdrawal" else "loading", table)
    if columns:
        table, notes = replace(table, columns=columns), [*notes, f"columns of {direction} are used"]
    cantilever = replace(cantilever, spring_constant=cantilever.spring_constant or table.spring_constant)
    depth, force, conversions = _converted(table, cantilever, place)
    further = [_named(table.columns, name) for name in ("time", "x", "y")]
    time, x, y = (
        _si(column, unit, place) if column and column.unit else np.empty(0)
        for column, unit in zip(further, ("s", "m", "m"), strict=True)
    )
    position = float(x[0]) if x.size else np.nan, float(y[0]) if y.size else np.nan
    return _one_direction(Measured(depth, force, (*notes, *conversions), time, position), direction, place)


def _columns_of(side: str, table: Table) -> tuple[Column, ...]:
    """Columns of one direction, the word for it removed from their heads; none if heads do not name both directions."""
    named = {word: [column for column in table.columns if _SIDES[word].search(column.name)] for word in _SIDES}
    if min(map(len, named.values())) < 2:
        return ()
    heads = [name_and_unit(_SIDES[side].sub("", column.name).strip(" _-")) for column in named[side]]
    pairs = zip(named[side], heads, strict=True)
    return tuple(replace(column, name=name, unit=column.unit or unit) for column, (name, unit) in pairs)


def _converted(table: Table, cantilever: Cantilever, file: str) -> tuple[FloatArray, FloatArray, list[str]]:
    """Depth [m] and force [N] from the columns that the table has, and notes on the conversion."""
    kinds = ("depth", "separation", "height", "force", "deflection")
    depth, separation, height, force, deflection = (_named(table.columns, kind) for kind in kinds)
    if deflection and not force and deflection.unit.endswith("N"):
        force = deflection
    if height and force and height.name.lower().startswith("displacement") and force.name.lower().startswith("load"):
        depth = depth or height  # these are the heads of an indenter, whose displacement is the depth
    place, signal = depth or separation or height, force or deflection
    if not place and not signal and len(table.columns) == 2:
        depth, force = place, signal = table.columns
    if not place or not signal:
        heads = ", ".join(column.name or "?" for column in table.columns)
        raise InvalidInput(
            f"{file}: needs a column of depth or height and one of force or deflection; rename the heads ({heads})"
        )
    is_height, stiffness, notes = place is height and not depth, cantilever.spring_constant, []
    if (is_height or not force) and not stiffness:
        name, meaning = (signal.name, "a deflection") if not force else (place.name, "a height, with the bending")
        raise InvalidInput(
            f'{file}: {name} is {meaning} of the cantilever; give its spring constant (--spring-constant "0.05 N/m"), '
            "or columns of depth and force"
        )
    if force:
        forces = _si(force, "N", file)
    else:
        forces = (stiffness or 0.0) * _deflection(signal, cantilever, file)
        notes.append("force and depth from the deflection, by the spring constant")
    depths = _si(place, "m", file)
    high = forces >= forces.min() + 0.7 * np.ptp(forces)
    if np.mean(depths[high]) < 0.5 * (depths.min() + depths.max()):
        notes.append(f"{place.name or 'the first column'} falls into the contact: its sign is changed")
        depths = -depths
    if is_height and stiffness:
        notes.append("depth = height less bending of the cantilever")
        depths = depths - forces / stiffness
    return depths, forces, notes


def _deflection(signal: Column, cantilever: Cantilever, file: str) -> FloatArray:
    """Deflection [m] from a column in metres or volts."""
    if not signal.unit.endswith("V"):
        return _si(signal, "m", file)
    if cantilever.sensitivity is None:
        raise InvalidInput(f'{file}: {signal.name} is in {signal.unit}; give --sensitivity "50 nm/V"')
    return cantilever.sensitivity * {"": 1.0, "m": 1e-3, "u": 1e-6, "k": 1e3}[signal.unit[:-1]] * signal.values


def _named(columns: Sequence[Column], kind: str) -> Column | None:
    """The column whose head is, or begins with, a name of that kind; names of two letters have to be the whole head."""
    for name in _NAMES[kind]:
        for column in columns:
            head = column.name.lower().replace("_", " ").strip()
            if head == name.strip() or (len(name.strip()) > 2 and head.startswith(name)):
                return column
    return None


def _si(column: Column, unit: str, file: str | Path) -> FloatArray:
    """Values of a column in an SI unit; errors name file and column."""
    if not column.unit:
        raise InvalidInput(f"{file}, column {column.name!r}: has no unit; write it in the head, as in depth [nm]")
    try:
        return in_unit(column.values, column.unit, unit)
    except InvalidInput as error:
        raise InvalidInput(f"{file}, column {column.name!r}, unit {column.unit!r}: {error}") from None


def _one_direction(curve: Measured, direction: Direction, place: str) -> Measured:
    """The part of a curve in one direction; curves of one direction, and histories, are returned unchanged.

    Raises:
        InvalidInput: If the depth turns more than once.
    """
    curve = curve.at_rows(np.isfinite(curve.depth) & np.isfinite(curve.force))
    if curve.depth.size < 3:
        raise InvalidInput(f"{place}: fewer than three points")
    if direction == "history":
        if not curve.time.size:
            raise InvalidInput(f"{place}: needs a column of time with its unit, for the scene relaxes over time")
        return curve
    turns = _turning_points(curve.depth)
    if not turns:
        return curve
    if len(turns) > 1:
        raise InvalidInput(
            f"{place}: the depth turns {len(turns)} times (first at point {turns[0] + 1}); keep one loading or "
            "withdrawal"
        )
    first, second = curve.at_rows(slice(0, turns[0] + 1)), curve.at_rows(slice(turns[0] + 1, None))
    part = first if (first.depth[-1] > first.depth[0]) == (direction == "loading") else second
    note = f"loading and withdrawal in one curve: the {direction} is used ({part.depth.size} points)"
    return replace(part, notes=(*part.notes, note))


def _turning_points(depth: FloatArray) -> list[int]:
    """Numbers of the points at which the depth turns back by more than noise."""
    least = _TURN * float(np.ptp(depth))
    peaks, dips = (find_peaks(values, prominence=least, plateau_size=1)[1] for values in (depth, -depth))
    return sorted([*peaks["left_edges"].tolist(), *dips["left_edges"].tolist()])


def _is_of_microscope(file: Path) -> bool:
    """Whether afmformats reads the file: by its ending, and tables of AFM Workshop by their first line."""
    if file.suffix in ENDINGS:
        return True
    return file.suffix == ".csv" and file.is_file() and table_text(file).startswith(_WORKSHOP)


def _is_of_nova(file: Path) -> bool:
    """Whether the file has the three columns without heads that NT-MDT's Nova writes: height and both deflections."""
    columns = read_table(file).columns
    return file.suffix == ".txt" and len(columns) == 3 and not any(column.name for column in columns)


def _read_measured(file: Path, cantilever: Cantilever, direction: Direction) -> list[Measured]:
    """Curves of a microscope's file; the depth is the displacement of the piezo minus the bending of the cantilever.

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
        # Its log would print a traceback of errors that are reported here in one line.
        logging.getLogger("afmformats.formats").disabled = True
        measured: Sequence[Any] = afmformats.load_data(file, meta_override=override)
        curves = [_segment(curve, direction) for curve in measured if curve.modality != "unknown"]
    except InvalidInput as error:
        raise InvalidInput(f"{file}: {error}") from None
    except afmformats.errors.MissingMetaDataError:
        raise InvalidInput(
            f'{file}: holds no calibration; give --spring-constant "0.05 N/m" and --sensitivity "50 nm/V"'
        ) from None
    except (Exception, afmformats.errors.AFMFileFormatError, afmformats.meta.MetaDataMissingError) as error:
        # Each format raises other errors, and some raise errors that are not derived from Exception.
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
    return Measured(depth, force, (), time, (place[0], place[1])).at_rows(np.isfinite(depth) & np.isfinite(force))

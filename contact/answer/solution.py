"""Base of every answer, with output as text, curve, tables, HTML and file.

matplotlib, pandas, xarray and h5py are imported at first use.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping
from dataclasses import dataclass
from html import escape
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self, get_args

import numpy as np

from contact.answer.evidence import SYMBOLS, UNITS, Quantity, Setting, StatedErrors, finite
from contact.answer.inside import Inside
from contact.answer.stages import Cost, StageRecord
from contact.files.scene_file import scene_from_mapping, scene_to_mapping
from contact.records.errors import InvalidInput, shown
from contact.records.extras import missing_extra
from contact.records.record import Record, unit_of
from contact.records.units import prefix_for
from contact.records.validation import FloatArray
from contact.scene.scene import Scene

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

__all__ = ["Setting", "Solution", "StatedErrors", "scene_line"]

# Largest number of sublayers of a stack in one line.
_MOST_RECORDS: Final = 3
# Module that draws answers; it imports matplotlib.
_DRAWING: Final = "reports.answer_plot"
_EVERYWHERE: Final = ("uncertainty(quantity)", "error_estimate", "settings", "stages", "cost")
_SCHEMA: Final = "contact-verification/solution/2"
# Files of layout 1 differ in one entry, which only detachments have.
_READABLE: Final = (_SCHEMA, "contact-verification/solution/1")


@dataclass(frozen=True)
class SampledFields:
    """Surface fields at stored radii; other radii are refused, since interpolation would have an unknown error.

    Attributes:
        radius: Stored radii r [m], shape (m,) or (n, m): m radii for each of n steps, increasing.
        pressures: Pressure p [Pa], shape (n, m).
        displacements: Surface displacement w [m], shape (n, m).
    """

    radius: FloatArray
    pressures: FloatArray
    displacements: FloatArray

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """Pressure p [Pa] at stored radii [m]."""
        return self._at(self.pressures, radius, step)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """Surface displacement w [m] at stored radii [m]."""
        return self._at(self.displacements, radius, step)

    def _at(self, values: FloatArray, radius: FloatArray, step: int) -> FloatArray:
        """Entries of ``values`` (n, m) of one step at stored radii."""
        stored = np.broadcast_to(self.radius, values.shape)[step]
        places = np.minimum(np.searchsorted(stored, radius), stored.size - 1)
        missing = radius[stored[places] != radius]
        if missing.size:
            reason = f"not among the {stored.size} stored radii; solve the scene again"
            raise InvalidInput(f"radius = {missing[0]:.17g}: {reason}")
        return np.asarray(values[step, places])


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Solution:
    """Base of every answer. Subclasses annotate their arrays and numbers with a `Quantity`.

    Attributes:
        scene: The problem that was solved.
        method: Name of the method.
        settings: Numerical settings of the method.
        error_estimate: Stated error of each quantity, relative to its `scale`, shape (n,) or scalar.
        cost: Seconds, memory, unknowns, counters.
        stages: Names, calls and times of the computations.
        notes: Limits of validity and accuracy, one sentence each.
    """

    ARRAYS: ClassVar[tuple[str, ...]] = ()
    """Fields with one value per state, shape (n,)."""
    SCALARS: ClassVar[tuple[str, ...]] = ()
    """Fields with one value per answer."""
    RECORDS: ClassVar[Mapping[str, type[Any]]] = {}
    """Fields with any number of records, by name with the class of the records."""
    CURVE_ALONE: ClassVar[bool] = False
    """Whether the method chooses the states: they are drawn as a line without points."""
    OFFERS: ClassVar[tuple[str, ...]] = ()
    """Further methods and fields of the answer in its `repr`."""
    ACCURACY_OF: ClassVar[tuple[str, ...]] = ()
    """Quantities to which a required accuracy applies; by default all arrays and numbers of a kind of answer."""

    scene: Scene
    method: str
    settings: Mapping[str, Setting]
    error_estimate: Mapping[str, FloatArray]
    cost: Cost
    stages: tuple[StageRecord, ...] = ()
    notes: tuple[str, ...] = ()

    def __init_subclass__(cls) -> None:
        """Register the annotated arrays and numbers of the subclass with their symbols and units."""
        for name, hint in cls.__annotations__.items():
            if isinstance(quantity := (*getattr(hint, "__metadata__", ()), None)[0], Quantity):
                UNITS[name] = quantity.unit
                if get_args(hint)[0] is float:
                    cls.SCALARS += (name,)
                else:
                    cls.ARRAYS += (name,)
                    SYMBOLS[name] = quantity.symbol
        cls.ACCURACY_OF = cls.ACCURACY_OF or (*cls.ARRAYS, *cls.SCALARS)

    def __post_init__(self) -> None:
        """Freeze the arrays; refuse non-finite numbers and unequal lengths."""
        for name in self.ARRAYS:
            object.__setattr__(self, name, finite(name, getattr(self, name), self.method))
        lengths = {name: len(getattr(self, name)) for name in self.ARRAYS}
        if len(set(lengths.values())) > 1:
            raise InvalidInput(f"{type(self).__name__}: all arrays need one length, got {lengths}")
        for name in self.SCALARS:
            finite(name, getattr(self, name), self.method)
        object.__setattr__(self, "error_estimate", StatedErrors(self.error_estimate, self.method))

    def __len__(self) -> int:
        """Number of states."""
        return len(getattr(self, self.ARRAYS[0]))

    def scale(self, quantity: str) -> FloatArray:
        """Magnitude to which a relative error of this quantity refers, shape (n,): the largest |q| along the path.

        The scale of a residual in `error_estimate`, which is no quantity of the answer, is one.
        """
        values = self._magnitude(quantity)
        return np.full(values.shape, values.max(initial=0.0))

    def _magnitude(self, quantity: str) -> FloatArray:
        """|q|, shape (n,); one, shape (1,), if the answer has no quantity of this name."""
        return np.abs(np.atleast_1d(np.asarray(getattr(self, quantity, 1.0), dtype=np.float64)))

    def uncertainty(self, quantity: str) -> FloatArray:
        """Absolute stated error of a quantity in its SI unit, shape (n,).

        Raises:
            InvalidInput: If the method states no error for this quantity.
        """
        if quantity not in self.error_estimate:
            known = ", ".join(sorted(self.error_estimate)) or "none"
            raise InvalidInput(f"{self.method} states no error of {quantity!r}; it does for: {known}")
        return self.error_estimate[quantity] * self.scale(quantity)

    def refuse_step(self, step: int) -> None:
        """Refuse an index of a state that the answer does not have.

        Raises:
            InvalidInput: If the index is no whole number, or outside the states.
        """
        is_whole = isinstance(step, int | np.integer) and not isinstance(step, bool)
        if not (is_whole and -len(self) <= step < len(self)):
            raise InvalidInput(f"step = {step}: this path has steps 0 to {len(self) - 1}")

    def inside(self, step: int = 0) -> Inside:
        """Fields inside the layer at one step; answers with such fields override it.

        Raises:
            InvalidInput: Always in this base class.
        """
        raise InvalidInput(
            f"{type(self).__name__}: fields inside are those of equilibria; prescribe radii, depths or forces without "
            "relaxation, with the modulus of that instant"
        )

    def stated_error(self, name: str) -> FloatArray | None:
        """Absolute stated error of a quantity in its SI unit, shape (n,); None if the method states none."""
        if name not in self.error_estimate:
            return None
        return np.broadcast_to(self.uncertainty(name), np.shape(np.atleast_1d(getattr(self, name))))

    # -- text ----------------------------------------------------------------------------------------------------------

    def __repr__(self) -> str:
        """Lines with method, scene, first and last values, units, stated errors, and further methods and fields."""
        derived = [name for name in self.error_estimate if isinstance(getattr(self, name, None), float)]
        names = dict.fromkeys([*self.ARRAYS, *self.SCALARS, *derived])
        lines = [f"{type(self).__name__} by {self.method}, {self._states()}", f"  scene: {scene_line(self.scene)}"]
        lines += ["  {:<26} {:<36} {}".format(name, *self._cells(name)) for name in names]
        lines += [f"  note: {note}" for note in self.notes]
        offers = ("plot()", "to_dataframe()", "save(path)", *self.OFFERS, *_EVERYWHERE)
        return "\n".join([*lines, f"  next: {', '.join(f'.{offer}' for offer in offers)}"])

    def _states(self) -> str:
        """Number of states as text."""
        return f"{len(self)} {'state' if len(self) == 1 else 'states'}"

    def _cells(self, name: str) -> tuple[str, str]:
        """First and last value with their unit, and first and last absolute stated error."""
        stated, unit = self.stated_error(name), UNITS.get(name, "1").replace("1", "")
        numbers = f"{_ends(np.atleast_1d(getattr(self, name)), '{:.7g}')} {unit}".rstrip()
        return numbers, "no error stated" if stated is None else f"+- {_ends(stated, '{:.1g}')}"

    def _repr_html_(self) -> str:
        """HTML with first and last values, units and stated errors, and the curve if matplotlib is installed."""
        rows = [(name.replace("_", " "), *self._cells(name)) for name in (*self.ARRAYS, *self.SCALARS)]
        table = "<tr><th>quantity</th><th>first ... last</th><th>stated error</th></tr>"
        table += "".join(f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in row)}</tr>" for row in rows)
        head = f"<b>{type(self).__name__}</b> by {escape(self.method)}, {self._states()}"
        scene = escape(scene_line(self.scene))
        notes = "".join(f"<p>{escape(note)}</p>" for note in self.notes)
        return f"<div>{head}<br>{scene}<table>{table}</table>{notes}{self._svg() if len(self) > 1 else ''}</div>"

    # -- curve ---------------------------------------------------------------------------------------------------------

    def plot(self, y: str | None = None, x: str | None = None, axes: Any = None) -> Any:
        """Draw one array of the answer over another, with units, and the stated error as a band.

        Args:
            y: Name of the array on the vertical axis; by default the force, or the depth if the force is prescribed.
            x: Name of the array on the horizontal axis; by default the time, or the depth if there is no time.
            axes: Axes of matplotlib to draw on; new axes by default.

        Returns:
            The axes of matplotlib.

        Raises:
            ImportError: If matplotlib is not installed.
            ValueError: If the answer has no such array.
        """
        return _imported(_DRAWING).plot(self, y, x, axes)

    def _svg(self) -> str:
        """The curve of `plot` as inline SVG; empty if matplotlib is not installed."""
        try:
            return str(_imported(_DRAWING).inline_svg(self))
        except ImportError:
            return ""

    # -- tables --------------------------------------------------------------------------------------------------------

    def to_dataframe(self) -> pd.DataFrame:
        """One row per state in SI, stated errors as columns `.._uncertainty`; units and scalars are in `attrs`.

        Raises:
            ImportError: If pandas is not installed.
        """
        frame = _imported("pandas").DataFrame(self._columns()).rename_axis(index="step")
        units = {name: UNITS[name] for name in (*self.ARRAYS, *self.SCALARS)}
        frame.attrs = {**self._head(), "units": units, **{name: getattr(self, name) for name in self.SCALARS}}
        return frame

    def to_xarray(self) -> xr.Dataset:
        """Dataset of the arrays along the dimension `step` and of the scalars, each with its unit in `attrs`.

        Raises:
            ImportError: If xarray is not installed.
        """
        variables = {name: ("step", values) for name, values in self._columns().items()}
        arrays = _imported("xarray").Dataset(variables | {name: getattr(self, name) for name in self.SCALARS})
        for name in arrays.data_vars:
            unit = UNITS.get(str(name).removesuffix("_uncertainty"))
            arrays[name].attrs = {"units": unit} if unit else {}
        arrays.attrs = self._head()
        return arrays

    def _head(self) -> dict[str, Any]:
        """Method and scene, for the attributes of tables."""
        return {"method": self.method, "scene": scene_line(self.scene)}

    def _columns(self) -> dict[str, Any]:
        """Arrays (n,) with their stated errors, in SI, and flags of stability."""
        columns = {name: values for name, values in vars(self).items() if isinstance(values, np.ndarray)}
        stated = {f"{name}_uncertainty": self.stated_error(name) for name in self.ARRAYS}
        return columns | {name: values for name, values in stated.items() if values is not None}

    # -- files ---------------------------------------------------------------------------------------------------------

    def save(self, path: str | Path) -> None:
        """Write the answer to an HDF5 file, without fields that are computed on demand.

        Raises:
            InvalidInput: If the file cannot be written.
        """
        # h5py takes long to import; only answers that are written or read need it.
        from contact.files.storage import write_tree  # noqa: PLC0415

        write_tree(path, self._tree())

    def _tree(self) -> dict[str, Any]:
        """Entries of the file of the answer."""
        texts = {
            "scene": scene_to_mapping(self.scene),
            "cost": dataclasses.asdict(self.cost),
            "notes": self.notes,
            **{name: [dataclasses.asdict(record) for record in getattr(self, name)] for name in self._records()},
        }
        return {
            "schema": _SCHEMA,
            "kind": type(self).__name__,
            "method": self.method,
            "settings": dict(self.settings),
            "error_estimate": dict(self.error_estimate),
            "arrays": {name: value for name, value in vars(self).items() if isinstance(value, np.ndarray | float)},
            **{name: json.dumps(text) for name, text in texts.items()},
            **({"fields": vars(fields)} if isinstance(fields := getattr(self, "fields", None), SampledFields) else {}),
        }

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Read an answer that `save` wrote, with equal numbers.

        Raises:
            InvalidInput: If the file is damaged, no stored answer, or one of another kind.
        """
        from contact.files.storage import read_tree  # noqa: PLC0415

        try:
            answer: Self = cls._of_tree(read_tree(path))
        except InvalidInput as error:
            raise InvalidInput(str(error) if str(error).startswith(str(path)) else f"{path}: {error}") from None
        except (KeyError, TypeError, AttributeError, json.JSONDecodeError) as error:
            raise InvalidInput(f"{path}: not a stored answer ({error!r}); write it with its save()") from None
        return answer

    @classmethod
    def _of_tree(cls, tree: Mapping[str, Any]) -> Any:
        """The answer from the entries of its file; the inverse of `_tree`."""
        if tree.get("schema") not in _READABLE:
            raise InvalidInput(f"schema = {shown(tree.get('schema'))}: this version reads {' and '.join(_READABLE)}")
        kinds = {kind_of_answer.__name__: kind_of_answer for kind_of_answer in _subclasses(cls)}
        if (kind := kinds.get(tree["kind"])) is None:
            raise InvalidInput(f"a stored {tree['kind']}; read it with Solution.load")
        if missing := [name for name in (*kind.ARRAYS, *kind.SCALARS) if name not in tree["arrays"]]:
            raise InvalidInput(
                f"a stored {kind.__name__} without {', '.join(missing)} (schema {tree['schema']!r}): an older version "
                "wrote it; solve its scene again with this one"
            )
        return kind(
            scene=scene_from_mapping(json.loads(tree["scene"])),
            method=tree["method"],
            settings=tree["settings"],
            error_estimate=tree["error_estimate"],
            cost=Cost(**json.loads(tree["cost"])),
            notes=tuple(json.loads(tree["notes"])),
            **{name: tuple(made(**r) for r in json.loads(tree[name])) for name, made in kind._records().items()},
            **tree["arrays"],
            **({"fields": SampledFields(**tree["fields"])} if "fields" in tree else {}),
        )

    @classmethod
    def _records(cls) -> dict[str, type[Any]]:
        """Fields that hold records, the stages among them, with the classes of the records."""
        return {"stages": StageRecord, **cls.RECORDS}


def _subclasses(cls: type[Any]) -> list[type[Any]]:
    """The class and all classes derived from it."""
    return [cls, *(kind for direct in cls.__subclasses__() for kind in _subclasses(direct))]


def _imported(name: str) -> Any:
    """Import a module that an extra installs.

    Raises:
        ImportError: The module is not installed; the message has the command that installs it.
    """
    try:
        return import_module(name)
    except ModuleNotFoundError as error:
        raise ImportError(missing_extra(error) or str(error)) from None


def scene_line(scene: Scene) -> str:
    """Text of the scene in one line; long arrays are abbreviated."""
    return ", ".join(_call(part) for part in (scene.layer, scene.indenter, scene.loading, *scene.effects))


def _call(item: Record) -> str:
    """Text of a record as a call of its class, with units and without fields that are None."""
    parts = ((field.name, getattr(item, field.name)) for field in dataclasses.fields(item))
    fields = (f"{name}={_value(value, unit_of(type(item), name))}" for name, value in parts if value is not None)
    return f"{type(item).__name__}({', '.join(fields)})"


def _value(value: object, unit: str | None) -> str:
    """Text of a field: numbers with their unit and a prefix, at most `_MOST_RECORDS` records of a list."""
    if isinstance(value, Record):
        return _call(value)
    if isinstance(value, tuple) and all(isinstance(entry, Record) for entry in value):
        more = f", {len(value) - _MOST_RECORDS} more" if len(value) > _MOST_RECORDS else ""
        return f"({', '.join(_value(entry, None) for entry in value[:_MOST_RECORDS])}{more})"
    if not isinstance(value, np.ndarray | float):
        return shown(value)
    numbers = np.atleast_1d(np.asarray(value, dtype=np.float64))
    numbers, unit = (1e3 * numbers, "g") if unit == "kg" else (numbers, unit)
    factor, prefix = prefix_for(numbers.tolist()) if unit else (1.0, "")
    text = _ends(numbers / factor, "{:.6g}")
    text = f"[{text}]" if isinstance(value, np.ndarray) else text
    count = f" ({numbers.size} values)" if numbers.size > 2 else ""
    return f"{text} {prefix}{unit or ''}".rstrip() + count


def _ends(values: FloatArray, form: str) -> str:
    """Text of the first and the last value; only one if their texts are equal."""
    first, last = form.format(values[0]), form.format(values[-1])
    return first if first == last else f"{first} ... {last}"

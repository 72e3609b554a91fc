"""An answer as a curve, a table and HTML. matplotlib, pandas and xarray are imported when they are asked for."""

from __future__ import annotations

from collections.abc import Mapping
from html import escape
from importlib import import_module
from io import StringIO
from typing import TYPE_CHECKING, Any, ClassVar, Final

import numpy as np

from contact.answer.summary import quantity_cells, scene_line
from contact.records.extras import missing_extra
from contact.records.units import prefix_for
from contact.records.validation import FloatArray
from contact.scene.loading import ForceHistory
from contact.scene.scene import Scene

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes

UNITS: Final[Mapping[str, str]] = {
    "time": "s",
    "contact_radius": "m",
    "indentation_depth": "m",
    "velocity": "m/s",
    "normal_force": "N",
    "contact_stiffness": "N/m",
    "pressure": "Pa",
    "surface_displacement": "m",
    "kinetic_energy": "J",
    "stored_energy": "J",
    "dissipated_energy": "J",
    "coefficient_of_restitution": "1",
    "contact_time": "s",
    "stick_radius": "m",
    "peak_force": "N",
    "peak_depth": "m",
    "peak_contact_radius": "m",
    "pull_off_force": "N",
    "pull_off_depth": "m",
    "pull_off_contact_radius": "m",
    "force_at_loss": "N",
}
SYMBOLS: Final[Mapping[str, str]] = {
    "time": "t",
    "contact_radius": "a",
    "indentation_depth": "δ",
    "velocity": "v",
    "normal_force": "F",
    "contact_stiffness": "k_N",
    "kinetic_energy": "E_kin",
    "stored_energy": "E_el",
    "dissipated_energy": "E_diss",
    "stick_radius": "c",
}
# More prescribed states than these are drawn as a line, fewer as symbols.
_MOST_SYMBOLS: Final = 40
# Where contact is lost, by the array that the value lies on.
_AT_LOSS: Final = {
    "indentation_depth": "pull_off_depth",
    "normal_force": "force_at_loss",
    "contact_radius": "pull_off_contact_radius",
}


class Shown:
    """Base of every answer: what notebooks and plots need of its arrays."""

    ARRAYS: ClassVar[tuple[str, ...]] = ()
    SCALARS: ClassVar[tuple[str, ...]] = ()
    CURVE_ALONE: ClassVar[bool] = False
    """Whether the method chose the states, so that they are drawn as a line."""

    if TYPE_CHECKING:

        @property
        def scene(self) -> Scene:
            """The problem that was solved."""

        @property
        def method(self) -> str:
            """Name of the method."""

        @property
        def notes(self) -> tuple[str, ...]:
            """What a reader should know before relying on the numbers."""

        @property
        def error_estimate(self) -> Mapping[str, FloatArray]:
            """Relative error of each quantity."""

        def uncertainty(self, quantity: str) -> FloatArray:
            """Absolute error estimate."""

        def __len__(self) -> int: ...

    def plot(self, y: str | None = None, x: str | None = None, axes: Axes | None = None) -> Axes:
        """Draws one array of the answer over another, with units, and the stated error as a band.

        Args:
            y: Name of the array on the vertical axis; by default the force, or the depth where the force is prescribed.
            x: Name of the array on the horizontal axis; by default the time, or the depth where there is no time.
            axes: Where to draw; by default on new axes.

        Returns:
            The axes of matplotlib.

        Raises:
            ImportError: If matplotlib is not installed.
            ValueError: If the answer has no such array.
        """
        y = y or ("indentation_depth" if isinstance(self.scene.loading, ForceHistory) else "normal_force")
        x = x or ("time" if "time" in self.ARRAYS else "indentation_depth")
        for name in (x, y):
            if name not in self.ARRAYS:
                raise ValueError(f"{type(self).__name__} has no array {name!r}; it has {', '.join(self.ARRAYS)}")
        if axes is None:
            axes = _imported("matplotlib.pyplot").subplots(layout="constrained")[1]
        x_values, y_values = (getattr(self, name) * self.factor(name) for name in (x, y))
        stated = self.stated_error(y)
        if stated is not None:
            band = stated * self.factor(y)
            axes.fill_between(x_values, y_values - band, y_values + band, alpha=0.25, linewidth=0)
            axes.collections[-1].set_label(f"stated error, at most {np.max(stated):.1g} {UNITS[y]}")
        self._draw(axes, (x, y), x_values, y_values)
        axes.set(xlabel=self.label(x), ylabel=self.label(y))
        axes.legend()
        return axes

    def _draw(self, axes: Axes, names: tuple[str, str], x: FloatArray, y: FloatArray) -> None:
        """The curve, or symbols at few prescribed states; of a detachment, what is stable under the scene's control."""
        if not hasattr(self, "stable_force_control"):
            is_curve = self.CURVE_ALONE or len(self) > _MOST_SYMBOLS
            axes.plot(x, y, "-" if is_curve else "o", label=self.method)
            return
        control = getattr(self.scene.loading, "control", "displacement")
        stable = getattr(self, f"stable_{control}_control")
        (line,) = axes.plot(x, np.where(stable, y, np.nan), "-", label=f"{self.method}, stable under {control} control")
        axes.plot(x, y, ":", color=line.get_color(), label="whole branch", zorder=0)
        if set(names) <= _AT_LOSS.keys():
            place = [getattr(self, _AT_LOSS[name]) * self.factor(name) for name in names]
            axes.plot(*place, "o", color=line.get_color(), label="loss of contact")

    def label(self, name: str) -> str:
        """The axis label of an array: name, symbol and unit with a fitting prefix."""
        symbol = f" {SYMBOLS[name]}".replace("k_N", "$k_N$") if name in SYMBOLS else ""
        return f"{name.replace('_', ' ')}{symbol} [{prefix_for(getattr(self, name))[1]}{UNITS[name]}]"

    def factor(self, name: str) -> float:
        """Values of an array in the unit of its axis over values in SI."""
        return 1.0 / prefix_for(getattr(self, name))[0]

    def stated_error(self, name: str) -> FloatArray | None:
        """Absolute stated error of an array, shape (n,); None if the method states none."""
        return np.broadcast_to(self.uncertainty(name), len(self)) if name in self.error_estimate else None

    def _columns(self) -> dict[str, Any]:
        """Arrays (n,) with their stated errors, in SI, and whether states are stable."""
        columns: dict[str, Any] = {}
        for name in self.ARRAYS:
            columns[name] = getattr(self, name)
            stated = self.stated_error(name)
            if stated is not None:
                columns[f"{name}_uncertainty"] = stated
        stable = ("stable_displacement_control", "stable_force_control")
        return columns | {name: getattr(self, name) for name in stable if hasattr(self, name)}

    def to_dataframe(self) -> pd.DataFrame:
        """One row per state in SI, stated errors as columns `.._uncertainty`; units and scalars stand in `attrs`.

        Raises:
            ImportError: If pandas is not installed.
        """
        frame = _imported("pandas").DataFrame(self._columns()).rename_axis(index="step")
        scalars = {name: getattr(self, name) for name in self.SCALARS}
        units = {name: UNITS[name] for name in (*self.ARRAYS, *self.SCALARS)}
        frame.attrs = {"method": self.method, "scene": scene_line(self.scene), "units": units, **scalars}
        return frame

    def to_xarray(self) -> xr.Dataset:
        """The arrays along `step` and the scalars, each with its unit in `attrs`.

        Raises:
            ImportError: If xarray is not installed.
        """
        arrays = _imported("xarray").Dataset({name: ("step", values) for name, values in self._columns().items()})
        arrays = arrays.assign({name: getattr(self, name) for name in self.SCALARS})
        for name in arrays.data_vars:
            unit = UNITS.get(str(name).removesuffix("_uncertainty"))
            arrays[name].attrs = {"units": unit} if unit else {}
        arrays.attrs = {"method": self.method, "scene": scene_line(self.scene)}
        return arrays

    def _repr_html_(self) -> str:
        """First and last values with units and stated errors, and the curve where matplotlib is installed."""
        states = "1 state" if len(self) == 1 else f"{len(self)} states"
        head = f"<b>{type(self).__name__}</b> by {escape(self.method)}, {states}<br>{escape(scene_line(self.scene))}"
        rows = "".join(self._row(name) for name in (*self.ARRAYS, *self.SCALARS))
        notes = "".join(f"<p>{escape(note)}</p>" for note in self.notes)
        cells = f"<tr><th>quantity</th><th>first ... last</th><th>stated error</th></tr>{rows}"
        return f"<div>{head}<table>{cells}</table>{notes}{self._svg() if len(self) > 1 else ''}</div>"

    def _row(self, name: str) -> str:
        stated = self.stated_error(name) if name in self.ARRAYS else None
        if name in self.SCALARS and name in self.error_estimate:
            stated = self.uncertainty(name)
        cells = quantity_cells(np.atleast_1d(getattr(self, name)), UNITS[name], stated)
        return "".join(["<tr>", *(f"<td>{escape(cell)}</td>" for cell in (name.replace("_", " "), *cells)), "</tr>"])

    def _svg(self) -> str:
        """The curve of `plot` as inline SVG; empty where matplotlib is missing."""
        try:
            figure = _imported("matplotlib.figure").Figure(figsize=(5.0, 3.2), layout="constrained")
        except ImportError:
            return ""
        self.plot(axes=figure.subplots())
        text = StringIO()
        figure.savefig(text, format="svg")
        return text.getvalue()[text.getvalue().index("<svg") :]


def _imported(name: str) -> Any:
    """A module of an extra.

    Raises:
        ImportError: With what to install.
    """
    try:
        return import_module(name)
    except ModuleNotFoundError as error:
        raise ImportError(missing_extra(error) or str(error)) from None

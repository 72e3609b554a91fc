"""The figures' common parts: series with an error band, layers, one source of flat-punch data, and the drawing.

Curves are dense, each with its method and an error band. A caption says where the paper's statement is looser than the
numbers. Ranges are those of the paper's text, since its axes are printed as pictures.
"""

import importlib
import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Literal

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from bem.flat_punch import IntegralEquation
from contact import Layer
from contact.records.validation import FloatArray
from docs.gallery._flat_punch import FlatPunchValues

# Its errors of 1e-8 are far below the width of a line, in a third of the time of the default.
SOURCE = IntegralEquation(nodes=16)
MDR, FEM = "mdr", "fem"
# Thickness [m] and Young's modulus [Pa] of the cases.
THICKNESS, YOUNGS_MODULUS = 1e-3, 1e6
# The figures end at this a/h.
LARGEST_RATIO = 100.0


@dataclass(frozen=True, kw_only=True)
class Series:
    """One line or set of symbols: the group chooses the colour, `half_width` is the error of y or empty."""

    label: str
    method: str
    group: str
    x: tuple[float, ...]
    y: tuple[float, ...]
    half_width: tuple[float, ...] = ()
    style: Literal["by method", "solid", "dashed", "dotted", "symbols"] = "by method"


@dataclass(frozen=True, kw_only=True)
class Panel:
    """One pair of axes, with labels in mathtext and the ranges as printed."""

    title: str
    x_label: str
    y_label: str
    x_scale: Literal["linear", "log"] = "linear"
    y_scale: Literal["linear", "log"] = "linear"
    x_range: tuple[float, float] | None = None
    y_range: tuple[float, float] | None = None
    series: tuple[Series, ...]


@dataclass(frozen=True, kw_only=True)
class Figure:
    """A figure of the paper as numbers."""

    name: str
    title: str
    caption: str
    panels: tuple[Panel, ...]


def series(
    label: str,
    method: str,
    group: str,
    x: ArrayLike,
    y: ArrayLike,
    *,
    half_width: ArrayLike = (),
    style: Literal["by method", "dotted", "symbols"] = "by method",
) -> Series:
    """A record of points from arrays."""
    x, y, half_width = (tuple(np.asarray(values, dtype=np.float64).tolist()) for values in (x, y, half_width))
    return Series(label=label, method=method, group=group, x=x, y=y, half_width=half_width, style=style)


def paper_figure(number: int) -> Figure:
    """The numbers of a figure of the paper."""
    return with_errors(importlib.import_module(f"docs.gallery.figure_{number:02d}").figure())


def show(figure: Figure) -> None:
    """Draw a figure, at most two panels per row, and print its caption.

    One colour and one entry of the legend per group: solid lines by MDR, dashed by other formulas, symbols by finite
    elements.
    """
    if any(line.method == MDR for panel in figure.panels for line in panel.series):
        figure = with_errors(figure)
    columns = min(2, len(figure.panels))
    rows = -(-len(figure.panels) // columns)
    size = (4.5 * columns, 3.6 * rows)
    drawn, axes = plt.subplots(rows, columns, figsize=size, layout="constrained", squeeze=False)
    for panel, one in zip(figure.panels, axes.flat, strict=False):
        _draw(panel, one)
    drawn.suptitle(figure.title)
    methods = {line.method for panel in figure.panels for line in panel.series if line.method.startswith(MDR)}
    print(figure.caption, *(f"{method.replace(MDR, 'MDR', 1)} of its largest value." for method in methods))


def _draw(panel: Panel, axes: Axes) -> None:
    groups = list(dict.fromkeys(line.group for line in panel.series))
    for line in panel.series:
        usual = "solid" if line.method.startswith(MDR) else "dashed"
        look = {"marker": "o", "linestyle": "none"} if line.style == "symbols" else {"linestyle": usual}
        if line.style in ("solid", "dashed", "dotted"):
            look = {"linestyle": line.style}
        first = next(other for other in panel.series if other.group == line.group) is line
        names = line.group or ", ".join(other.method for other in panel.series if not other.group)
        label = names if first else f"_{line.label}"
        colour = f"C{groups.index(line.group) % 10}"
        axes.plot(line.x, line.y, color=colour, linewidth=1.2, markersize=4, label=label, **look)
    axes.set(title=panel.title, xlabel=panel.x_label, ylabel=panel.y_label)
    axes.set(xscale=panel.x_scale, yscale=panel.y_scale, xlim=panel.x_range, ylim=panel.y_range)
    axes.legend(fontsize="x-small")


def layer(poissons_ratio: float, *, support: Literal["bonded", "unbonded"] = "bonded") -> Layer:
    """A layer of unit thickness and unit contact modulus E*."""
    modulus = (1.0 - poissons_ratio) * (1.0 + poissons_ratio)
    return Layer(thickness=1.0, youngs_modulus=modulus, poissons_ratio=poissons_ratio, support=support)


HALF_SPACE = Layer.half_space(youngs_modulus=0.75, poissons_ratio=0.5)
UNBONDED = layer(0.5, support="unbonded")


def name_of(one: Layer) -> str:
    """Such as "bonded nu=0.45"; nu does not matter for other layers."""
    if one.is_half_space:
        return "half-space"
    return f"bonded nu={one.poissons_ratio:g}" if one.support == "bonded" else "unbonded"


def punch(one: Layer) -> FlatPunchValues:
    """Flat-punch data of a layer."""
    return FlatPunchValues(one, SOURCE.sizes)


def mdr_line(
    group: str,
    x: ArrayLike,
    y: ArrayLike,
    relative_error: ArrayLike = 0.0,
    *,
    style: Literal["by method", "dotted"] = "by method",
) -> Series:
    """A line computed by MDR, with its band."""
    ordinates = np.asarray(y, dtype=np.float64)
    band = np.abs(ordinates) * np.broadcast_to(np.asarray(relative_error, dtype=np.float64), ordinates.shape)
    return series(f"{group}, {MDR}", MDR, group, x, ordinates, half_width=band, style=style)


def with_errors(figure: Figure) -> Figure:
    """The figure with the largest error of its MDR curves, over each curve's largest ordinate, in their label."""
    curves = [one for panel in figure.panels for one in panel.series if one.method == MDR]
    worst = max(max(one.half_width) / max(map(abs, one.y)) for one in curves)
    name = f"{MDR}, error below {10.0 ** np.ceil(np.log10(worst)):.0e}"
    panels = (
        replace(
            panel,
            series=tuple(
                replace(one, method=name, label=f"{one.group}, {name}") if one.method == MDR else one
                for one in panel.series
            ),
        )
        for panel in figure.panels
    )
    return replace(figure, panels=tuple(panels))


def by_finite_elements(case: str) -> dict[str, dict[str, FloatArray]]:
    """The accepted answers of finite elements in a case: arrays by scene and quantity, in SI units."""
    file = Path(__file__).parents[2] / "baselines" / f"{case}.jsonl"
    answers: list[dict[str, Any]] = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()[1:]]
    return {
        one["scene"]: {name: np.array(found["values"]) for name, found in one["quantities"].items()}
        for one in answers
        if one["method"] == FEM
    }


def over_ratio(case: str, one: Layer, quantity: str, places: tuple[float, ...]) -> tuple[FloatArray, FloatArray]:
    """The ratios a/h that finite elements answered on a layer, and the quantity there."""
    found = by_finite_elements(case)
    ratio = np.array([r for r in places if f"{name_of(one)} a/h={r:g}" in found])
    return ratio, np.array([found[f"{name_of(one)} a/h={r:g}"][quantity][0] for r in ratio])


def case_modulus(one: Layer) -> float:
    """E* [Pa] of the layer of the cases; they have nu = 0.3 on unbonded layers."""
    nu = one.poissons_ratio if one.support == "bonded" else 0.3
    return YOUNGS_MODULUS / (1.0 - nu**2)


def symbols(group: str, x: ArrayLike, y: ArrayLike) -> Series:
    """Answers of finite elements; the group chooses their colour."""
    return series(f"{group}, {FEM}", FEM, group, x, y, style="symbols")


def closed_form(group: str, method: str, x: ArrayLike, y: ArrayLike) -> Series:
    """A closed form or an asymptote; `method` says which, such as "thin layer"."""
    return series(f"{group}, {method}", method, group, x, y)


def percent(value: FloatArray | float) -> str:
    """A ratio's excess over one, for captions."""
    return f"{100.0 * (float(value) - 1.0):.1f} %"

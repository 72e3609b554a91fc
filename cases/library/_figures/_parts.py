"""What the figures share: series with an error band, the layers they are drawn for, one source of flat-punch data."""

from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from bem.layer_equation.flat_punch_source import IntegralEquation
from bem.layer_equation.protocol import FlatPunchSolution
from cases.library._figures._symbols import series
from cases.results.records.figure import Figure, Series
from contact import Layer
from contact.records.validation import FloatArray

# Its errors of 1e-8 are far below the width of a line, in a third of the time of the default.
SOURCE = IntegralEquation(nodes=16)
MDR = "mdr"
# The figures end at this a/h.
LARGEST_RATIO = 100.0


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


def punch(one: Layer, largest: float = LARGEST_RATIO) -> FlatPunchSolution:
    """Flat-punch data up to a ratio a/h."""
    return SOURCE.solution(one, largest)


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


def closed_form(group: str, method: str, x: ArrayLike, y: ArrayLike) -> Series:
    """A closed form or an asymptote; `method` says which, such as "thin layer"."""
    return series(f"{group}, {method}", method, group, x, y)


def percent(value: FloatArray | float) -> str:
    """A ratio's excess over one, for captions."""
    return f"{100.0 * (float(value) - 1.0):.1f} %"

"""One answer as a figure: force over depth with its uncertainty, or the histories of an impact."""

from typing import Literal

import numpy as np

from cases.results.records.figure import Figure, Panel, Series
from contact import (
    ContactRadii,
    DepthHistory,
    ForceHistory,
    FrictionHistory,
    HistoryPath,
    ImpactHistory,
    IndentationDepths,
    NormalForces,
    Scene,
    Solution,
)

# A line has about so many points: half as many show corners in a printed figure.
_POINTS = 240
# Points on each part of a history, at least; half as many show corners.
_FEWEST = 8
# Histories of more instants are drawn as symbols: solving between them would take longer than the answer.
_MOST_INSTANTS = 2000
COLUMNS_DRAWN = {
    "force over depth": ("indentation_depth", "normal_force"),
    "contact radius over depth": ("indentation_depth", "contact_radius"),
}
HISTORIES_DRAWN = {
    "force": ("time", "normal_force"),
    "depth": ("time", "indentation_depth"),
    "contact radius": ("time", "contact_radius"),
}


def solution_figure(solution: Solution, curve: Solution | None = None) -> Figure:
    """The figure of an answer, in units with fitting prefixes; bands where the method states an uncertainty.

    Args:
        solution: Answer whose states are drawn: symbols at prescribed ones, a line through steps that the method chose
            itself, as in an impact.
        curve: The same scene with states between the prescribed ones, drawn as a line; None where there is none.
    """
    drawn = HISTORIES_DRAWN if _in_time(solution) else COLUMNS_DRAWN
    panels = tuple(_panel(solution, curve, title, x, y) for title, (x, y) in drawn.items())
    caption = "Band: uncertainty the method states. Symbols: what the scene prescribes."
    return Figure(name="solution", title="Answer", caption=caption, panels=panels)


def between(scene: Scene) -> Scene | None:
    """The scene with further states between the prescribed ones; None where an answer would depend on them.

    Instants lie closer behind each prescribed one, where relaxation is fastest.
    """
    loading = scene.loading
    match loading:
        case DepthHistory(time=time) | ForceHistory(time=time) if time.size <= _MOST_INSTANTS:
            parts = np.linspace(0.0, 1.0, max(_FEWEST, _POINTS // time.size), endpoint=False) ** 3
            finer = np.append((time[:-1, None] + np.diff(time)[:, None] * parts).ravel(), time[-1])
            finer = np.unique(finer)
            name = "depth" if isinstance(loading, DepthHistory) else "force"
            values = np.interp(finer, time, getattr(loading, name))
            return scene.replace(loading=loading.replace(time=finer, **{name: values}))
        case IndentationDepths(values=values) | NormalForces(values=values) | ContactRadii(values=values):
            if scene.effects or values.size == 1 or np.ptp(values) == 0.0:
                return None
            finer = np.union1d(values, np.linspace(values.min(), values.max(), _POINTS))
            return scene.replace(loading=loading.replace(values=finer))
    return None


def _in_time(solution: Solution) -> bool:
    return isinstance(solution, HistoryPath | FrictionHistory | ImpactHistory)


def _panel(solution: Solution, curve: Solution | None, title: str, x: str, y: str) -> Panel:
    prescribed = getattr(solution.scene.loading, "time", None)
    chosen = solution.CURVE_ALONE or (prescribed is not None and len(solution) > prescribed.size)
    series = [] if curve is None else [_series(curve, curve.method, (x, y), solution, "solid")]
    name = solution.method if curve is None else "prescribed states"
    series.append(_series(solution, name, (x, y), solution, "solid" if chosen else "symbols"))
    x_label, y_label = (solution.label(axis) for axis in (x, y))
    return Panel(title=title, x_label=x_label, y_label=y_label, series=tuple(series))


def _series(
    drawn: Solution, name: str, axes: tuple[str, str], answer: Solution, style: Literal["solid", "symbols"]
) -> Series:
    """A line or symbols of the states `drawn`, in the units of the axes of `answer`."""
    x, y = (getattr(drawn, axis) * answer.factor(axis) for axis in axes)
    stated = drawn.stated_error(axes[1])
    half_width = np.empty(0) if stated is None else stated * answer.factor(axes[1])
    return Series(
        label=name,
        method=name,
        group="",
        x=tuple(x.tolist()),
        y=tuple(y.tolist()),
        half_width=tuple(half_width.tolist()),
        style=style,
    )

"""Pictures of one answer and of answers over a range of a number."""

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure

from cases.sweep import Sweep
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
from contact.records.validation import FloatArray
from reports.answer import GIVEN
from reports.answer_plot import draw
from reports.inside import draw_inside  # noqa: F401 - drawn like the others, by its name
from reports.style import mark_decades, panels
from reports.words import scaled_column

# Points of a line, about: half as many show corners in a printed figure.
POINTS = 240
# Points on each part of a history, at least: half as many show corners.
FEWEST = 8
# Histories of more instants are drawn as symbols: solving between them would take longer than the answer.
MOST_INSTANTS = 2000
# Lines named in a legend, at most: of more, every second or third is named.
MOST_NAMED = 8
# A panel [inches]; one that stands alone is larger by this factor.
SIZE, ALONE = (4.0, 2.9), 1.4


def solution_figure(solution: Solution, curve: Solution | None = None) -> Figure:
    """Force and contact radius over depth, or histories; bands and bars where the method states an error.

    Args:
        solution: Answer whose states are drawn: symbols at prescribed ones, a line through steps that the method chose
            itself, as in an impact.
        curve: The same scene with states between the prescribed ones, drawn as a line; None where there is none.
    """
    in_time = isinstance(solution, HistoryPath | FrictionHistory | ImpactHistory)
    x = "time" if in_time else "indentation_depth"
    wanted = ("normal_force", "indentation_depth", "contact_radius")
    shown = [name for name in wanted if name in solution.ARRAYS and name != x]
    drawing, all_axes = panels(len(shown), size=SIZE)
    for axes, y in zip(all_axes, shown, strict=True):
        draw(solution, axes, x, y, curve)
    drawing.legend(handles=all_axes[0].get_legend_handles_labels()[0], loc="outside lower center", ncols=2)
    return drawing


def between(scene: Scene) -> Scene | None:
    """The scene with further states between the prescribed ones; None where an answer would depend on them.

    Instants lie closer behind each prescribed one, where relaxation is fastest.
    """
    loading = scene.loading
    match loading:
        case DepthHistory(time=time) | ForceHistory(time=time) if time.size <= MOST_INSTANTS:
            parts = np.linspace(0.0, 1.0, max(FEWEST, POINTS // time.size), endpoint=False) ** 3
            finer = np.append((time[:-1, None] + np.diff(time)[:, None] * parts).ravel(), time[-1])
            finer = np.unique(finer)
            name = "depth" if isinstance(loading, DepthHistory) else "force"
            values = np.interp(finer, time, getattr(loading, name))
            return scene.replace(loading=loading.replace(time=finer, **{name: values}))
        case IndentationDepths(values=values) | NormalForces(values=values) | ContactRadii(values=values):
            if scene.effects or values.size == 1 or np.ptp(values) == 0.0:
                return None
            finer = np.union1d(values, np.linspace(values.min(), values.max(), POINTS))
            return scene.replace(loading=loading.replace(values=finer))
    return None


def sweep_figure(sweep: Sweep) -> Figure:
    """Each quantity that the varied number changes.

    Scenes of more states than varied values have a line per value over the prescribed quantity, others a line per
    prescribed value over the varied number, on a logarithmic axis where that grows by equal factors.
    """
    columns = sweep.columns
    swept, *heads = (head for head in columns if "_uncertainty" not in head)
    groups = [np.flatnonzero(columns[swept] == value) for value in dict.fromkeys(columns[swept].tolist())]
    states, last = max(groups, key=len), [rows[-1] for rows in groups]
    given = GIVEN[type(sweep.answers[0][1].scene.loading).__name__]
    prescribed = next((head for head in heads if head.partition(" [")[0] in given), "")
    others = [head for head in heads if head != prescribed]
    varied = [head for head in others if np.ptp(columns[head][last]) > 0.0] or others
    over_states = bool(prescribed) and len(states) > len(groups)
    if over_states:
        x_head, lines, names = prescribed, groups, _named(sweep, swept, last)
    else:
        lines = [np.array([rows[k] for rows in groups if k < len(rows)]) for k in range(len(states))]
        x_head, names = swept, _named(sweep, prescribed or swept, states)
    size = (ALONE * SIZE[0], ALONE * SIZE[1]) if len(varied) == 1 else SIZE
    drawing, all_axes = panels(len(varied), size=size)
    for axes, head in zip(all_axes, varied, strict=True):
        (x_factor, x_label), (y_factor, y_label) = (
            scaled_column(name, columns[name].tolist()) for name in (x_head, head)
        )
        axes.set(xlabel=x_label, ylabel=y_label)
        if over_states:
            axes.set_prop_cycle(color=colormaps["viridis"](np.linspace(0.0, 0.9, len(names))))
        for rows, name in zip(lines, names, strict=True):
            axes.plot(columns[x_head][rows] / x_factor, columns[head][rows] / y_factor, label=name)
        if not over_states and _by_factors(sweep.swept.values):
            axes.set_xscale("log")
            mark_decades(axes.xaxis)
    if len(names) > 1:
        named = all_axes[0].lines[:: -(-len(names) // MOST_NAMED)]
        drawing.legend(handles=named, loc="outside lower center", ncols=min(len(named), 4))
    return drawing


def _named(sweep: Sweep, head: str, rows: Any) -> list[str]:
    """Values of a column at these rows as names of lines, "thickness [mm]: 1.5"."""
    values = sweep.columns[head]
    scale, label = scaled_column(head, values.tolist())
    return [f"{label}: {value:.4g}" for value in values[rows] / scale]


def _by_factors(values: FloatArray) -> bool:
    """Whether at least three values grow by equal factors."""
    return bool(values.size > 2 and values.min() > 0.0 and np.ptp(np.diff(np.log(values))) < 1e-9)

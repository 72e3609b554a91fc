"""Signed errors over a/h and Poisson's ratio, with the region that is good to one percent framed."""

import re
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import SymLogNorm
from matplotlib.figure import Figure as Drawing
from matplotlib.patches import Rectangle

from cases.results.records.reliability import ErrorMap
from cases.results.records.run import CaseResult
from reports.figures.axes_grid import numbered_parts
from reports.figures.figure import ReportFigure
from reports.figures.panel_chart import PanelChart
from reports.figures.style import BLACK, mark_decades, power_of_ten
from reports.words.file_names import file_name

# Cells with an error of at most this are framed as good.
GOOD = 1e-2
# Colours saturate at the largest error and are linear below the smallest.
LARGEST, SMALLEST = 1.0, 1e-6
# A figure has so many maps: one page.
PANELS_A_FIGURE = 4
COLUMNS = ("map", "quantity", "poissons_ratio", "a_over_h", "relative_error")
CAPTION = (
    "Colour: signed relative error of a paraboloid's force at a given depth, or of its depth at a given force; blue "
    "too small, red too large, white within 1e-6; a/h is that of the exact answer. Framed: within 1 %. Grey: no answer."
)


def figures(case: CaseResult) -> list[ReportFigure]:
    """Four maps a figure."""
    return [
        replace(
            CHART,
            title=", ".join(dict.fromkeys(re.split("[,:]", found.title)[0] for found in maps)),
            caption=f"{CAPTION} Reference: {maps[0].reference}.",
        ).figure(file_name(case.name, f"{number}"), maps)
        for number, maps in numbered_parts(case.maps, PANELS_A_FIGURE)
    ]


def _rows(found: ErrorMap) -> list[tuple[str | float | None, ...]]:
    return [
        (found.name, found.quantity, row, ratio, error)
        for row, errors in zip(found.rows, found.errors, strict=True)
        for ratio, error in zip(found.ratios, errors, strict=True)
    ]


def _add_bar(drawing: Drawing, all_axes: list[Axes], meshes: list[QuadMesh]) -> None:
    """One bar of colours for all maps."""
    bar = drawing.colorbar(meshes[-1], ax=all_axes, shrink=0.8, label="relative error")
    ticks = [-1.0, -1e-2, -1e-4, 0.0, 1e-4, 1e-2, 1.0]
    bar.set_ticks(ticks, labels=["0" if t == 0 else f"{'−' if t < 0 else ''}{power_of_ten(abs(t))}" for t in ticks])
    bar.minorticks_off()


def _draw_map(axes: Axes, found: ErrorMap) -> QuadMesh:
    norm = SymLogNorm(linthresh=SMALLEST, vmin=-LARGEST, vmax=LARGEST)
    errors = np.array([[np.nan if error is None else error for error in row] for row in found.errors])
    edges = _edges(np.log(found.ratios))
    rows = np.arange(len(found.rows) + 1)
    axes.set_facecolor("#dddddd")
    mesh = axes.pcolormesh(np.exp(edges), rows, errors, norm=norm, cmap="RdBu_r", linewidth=0.0)
    for k, j in zip(*np.nonzero(np.abs(errors) <= GOOD), strict=True):
        _frame(axes, np.exp(edges[j : j + 2]), float(k))
    axes.set(title=found.title, xscale="log", xlabel="$a/h$", ylabel=r"Poisson's ratio")
    axes.set_yticks(rows[:-1] + 0.5, labels=found.rows)
    axes.grid(visible=False)
    mark_decades(axes.xaxis)
    return mesh


def _edges(middles: np.ndarray) -> np.ndarray:
    """Borders between evenly spaced middles."""
    half = (middles[1] - middles[0]) / 2
    borders: np.ndarray = np.append(middles - half, middles[-1] + half)
    return borders


def _frame(axes: Axes, ends: np.ndarray, row: float) -> None:
    """A thin frame around one cell."""
    size = float(ends[1] - ends[0])
    axes.add_patch(Rectangle((float(ends[0]), row), size, 1.0, fill=False, edgecolor=BLACK, linewidth=0.5))


CHART = PanelChart(
    title="Signed errors",
    caption=CAPTION,
    columns=COLUMNS,
    rows=_rows,
    panel=_draw_map,
    size=(5.0, 3.1),
    finish=_add_bar,
)

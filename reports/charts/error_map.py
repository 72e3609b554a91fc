"""Signed errors over a/h and Poisson's ratio, with the region that is good to one percent framed."""

from collections.abc import Sequence
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import SymLogNorm
from matplotlib.figure import Figure as Drawing
from matplotlib.patches import Rectangle

from cases.results.records.reliability import ErrorMap
from cases.results.records.run import CaseResult
from reports.figures.axes_grid import numbered_parts, panel_grid
from reports.figures.figure import ReportFigure
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
    "Colour: signed relative error of the force of a paraboloid at a prescribed contact radius, blue too small, red "
    "too large, white within 1e-6. Framed: good to 1 %. Grey: refused by name."
)


def figures(case: CaseResult) -> list[ReportFigure]:
    """Four maps a figure."""
    return [
        ReportFigure(
            name=file_name(case.name, f"{number}"),
            title=", ".join(found.title.partition(",")[0] for found in maps),
            caption=f"{CAPTION} Reference: {maps[0].reference}.",
            paint=partial(draw, maps),
            columns=COLUMNS,
            rows=tuple(row for found in maps for row in _rows(found)),
        )
        for number, maps in numbered_parts(case.maps, PANELS_A_FIGURE)
    ]


def _rows(found: ErrorMap) -> list[tuple[str | float | None, ...]]:
    return [
        (found.name, found.quantity, row, ratio, error)
        for row, errors in zip(found.rows, found.errors, strict=True)
        for ratio, error in zip(found.ratios, errors, strict=True)
    ]


def draw(maps: Sequence[ErrorMap]) -> Drawing:
    """Panels in rows of two with one bar of colours."""
    drawing, all_axes = panel_grid(len(maps), 2, (5.0, 3.1))
    norm = SymLogNorm(linthresh=SMALLEST, vmin=-LARGEST, vmax=LARGEST)
    for axes, found in zip(all_axes, maps, strict=True):
        mesh = _draw_map(axes, found, norm)
    bar = drawing.colorbar(mesh, ax=all_axes, shrink=0.8, label="relative error of the force")
    ticks = [-1.0, -1e-2, -1e-4, 0.0, 1e-4, 1e-2, 1.0]
    bar.set_ticks(ticks, labels=["0" if t == 0 else f"{'−' if t < 0 else ''}{power_of_ten(abs(t))}" for t in ticks])
    bar.minorticks_off()
    return drawing


def _draw_map(axes: Axes, found: ErrorMap, norm: SymLogNorm) -> QuadMesh:
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

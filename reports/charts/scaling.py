"""Seconds against size, with the slope that theory expects."""

from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes

from cases.results.records.cost import ScalingFit
from cases.results.records.run import CaseResult
from reports.figures.figure import Cell, ReportFigure
from reports.figures.panel_chart import PanelChart
from reports.figures.style import GREY, look_of, mark_decades
from reports.words.method_names import display_name

# A fitted curve has so many points: it looks smooth.
CURVE = 60
COLUMNS = ("method", "size", "value", "cpu_seconds")
CAPTION = (
    "Processor time of a first solution, and c + k n^p fitted to it; in the titles p with its 95 % interval. Dashed: "
    "the slope of the most expensive stage in theory, through the largest size."
)


def figures(case: CaseResult) -> list[ReportFigure]:
    """One figure for all fits, if there are any."""
    return [CHART.figure(f"{case.name}-seconds", case.scaling)] if case.scaling else []


def _rows(fit: ScalingFit) -> Iterator[tuple[Cell, ...]]:
    return ((fit.method, fit.size, *point) for point in zip(fit.sizes, fit.seconds, strict=True))


def _draw_fit(axes: Axes, fit: ScalingFit) -> None:
    look = look_of(fit.method)
    largest, last = fit.sizes[-1], fit.seconds[-1]
    half = len(fit.sizes) // 2
    slope = [last * (size / largest) ** fit.theory for size in fit.sizes[half:]]
    axes.set(xscale="log", yscale="log", xlabel=fit.size, ylabel="processor time [s]")
    axes.set_title(f"{display_name(fit.method)}: {round(fit.exponent, 2) + 0.0:.2f} ± {fit.half_width:.2f}")  # no -0.00
    axes.plot(fit.sizes[half:], slope, color=GREY, linestyle="--", linewidth=1.0, label=f"slope {fit.theory:g}")
    sizes = np.geomspace(fit.sizes[0], largest, CURVE)
    axes.plot(sizes, fit.fixed + fit.growing * (sizes / largest) ** fit.exponent, color=look.colour, linewidth=0.8)
    axes.plot(fit.sizes, fit.seconds, color=look.colour, marker=look.marker, linestyle="none")
    axes.set_ylim(_at_least_a_decade(*axes.get_ylim()))
    mark_decades(axes.xaxis)
    mark_decades(axes.yaxis)
    axes.legend(loc="upper left")


def _at_least_a_decade(low: float, high: float) -> tuple[float, float]:
    """Limits so far apart that the noise of times that do not grow looks like noise."""
    middle, half = (low * high) ** 0.5, max((high / low) ** 0.5, 10**0.5)
    return middle / half, middle * half


CHART = PanelChart(
    title="Seconds against size",
    caption=CAPTION,
    columns=COLUMNS,
    rows=_rows,
    panel=_draw_fit,
    size=(3.6, 2.7),
    across=3,
)

"""One renderer for every figure of a case: lines, symbols and asymptotes of the methods, overlaid.

The colour of a curve says which scene it belongs to (`Series.group`), its line or symbol says which method made it.
A figure with a single group is coloured by method instead.
"""

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import groupby
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure as Drawing
from matplotlib.lines import Line2D

from cases.results.records.figure import Figure, Panel, Series
from reports.figures.axes_grid import axes_of
from reports.figures.figure import ReportFigure
from reports.style import BLACK, GREY, look_of, mark_decades
from reports.words import base_of, display_name

PANEL_HEIGHT, PANEL_WIDTH, LEGEND_ROW = 2.75, 4.0, 0.2  # inches
# A panel that stands alone is so many times larger.
ALONE = 1.4
# An entry of a legend takes these widths [inches] for its symbol and for each letter.
HANDLE_WIDTH, LETTER_WIDTH = 0.62, 0.072
# So many panels stand side by side.
MOST_COLUMNS = 3
# A band narrower than this fraction of what the ordinates span is thinner than the line, and left out.
NARROWEST_BAND = 1e-3
# A curve of symbols shows about so many of its points; more would run together.
SYMBOLS_ON_A_CURVE = 24
LINE_METHODS = ("mdr",)
FULL_WIDTH, THIN_WIDTH = 1.5, 1.0
SYMBOL_METHODS = ("fem", "bem", "integral_equation", "literature", "paper", "reference")


@dataclass(frozen=True, kw_only=True)
class Stroke:
    """Line and marker of a series in Matplotlib's words."""

    line: Any
    marker: str
    width: float = FULL_WIDTH


STYLES = {
    "solid": Stroke(line="-", marker=""),
    "dashed": Stroke(line=(0, (4, 2)), marker="", width=THIN_WIDTH),
    "dotted": Stroke(line=(0, (1, 1.5)), marker="", width=THIN_WIDTH),
}


def report_figure(figure: Figure, case: str) -> ReportFigure:
    """A case's figure for the report, its data one row a point."""
    return ReportFigure(
        name=f"{case}-{figure.name}",
        title=figure.title,
        caption=figure.caption,
        paint=partial(draw, figure),
        columns=("panel", "series", "method", "group", "x", "y", "half_width"),
        rows=tuple(_rows(figure)),
    )


def _rows(figure: Figure) -> Iterable[tuple[str | float | None, ...]]:
    for panel in figure.panels:
        for series in panel.series:
            widths = series.half_width or (None,) * len(series.x)
            for x, y, half_width in zip(series.x, series.y, widths, strict=True):
                yield panel.title, series.label, series.method, series.group, x, y, half_width


def draw(figure: Figure) -> Drawing:
    """The figure with its panels in rows of two or three and one legend below them."""
    columns = _columns(figure.panels)
    rows = math.ceil(len(figure.panels) / columns)
    legend = _legend_entries(figure)
    size = ALONE if len(figure.panels) == 1 else 1.0
    width = size * PANEL_WIDTH * columns
    legend_rows = math.ceil(len(legend) / _entries_a_row(legend, width))
    drawing = Drawing(
        figsize=(width, size * PANEL_HEIGHT * rows + LEGEND_ROW * legend_rows + 0.15), layout="constrained"
    )
    colours = _colours(figure)
    for axes, panel in zip(axes_of(drawing, len(figure.panels), columns), figure.panels, strict=True):
        draw_panel(axes, panel, colours)
    if legend:
        drawing.legend(handles=legend, loc="outside lower center", ncols=math.ceil(len(legend) / legend_rows))
    return drawing


def _entries_a_row(legend: Sequence[Line2D], width: float) -> int:
    """How many legend entries stand side by side in a figure of this width [inches]."""
    longest = max((len(re.sub(r"[$\\{}_^]|mathrm", "", str(entry.get_label()))) for entry in legend), default=0)
    return max(1, math.floor(width / (HANDLE_WIDTH + LETTER_WIDTH * longest)))


def _columns(panels: Sequence[Panel]) -> int:
    """Panels that share a title stand in one row; others three a row, or two when there are two or four."""
    runs = [len(list(run)) for _, run in groupby(panels, key=lambda panel: panel.title)]
    if len(set(runs)) == 1 and 1 < runs[0] <= MOST_COLUMNS:
        return runs[0]
    return min(len(panels), 2) if len(panels) in (1, 2, 4) else MOST_COLUMNS


def draw_panel(axes: Axes, panel: Panel, colours: dict[str, str]) -> None:
    """The series of a panel; symbols lie above lines, asymptotes below both."""
    axes.set(title=panel.title, xlabel=panel.x_label, ylabel=panel.y_label, xscale=panel.x_scale, yscale=panel.y_scale)
    for series in panel.series:
        _draw_series(axes, series, _colour(series, colours))
    _set_ranges(axes, panel)
    for axis, scale in ((axes.xaxis, panel.x_scale), (axes.yaxis, panel.y_scale)):
        if scale == "log":
            mark_decades(axis)


def _set_ranges(axes: Axes, panel: Panel) -> None:
    """Axes as printed where the panel fixes them."""
    if panel.x_range is not None:
        axes.set_xlim(panel.x_range)
    if panel.y_range is not None:
        axes.set_ylim(panel.y_range)


def _draw_series(axes: Axes, series: Series, colour: str) -> None:
    stroke = stroke_of(series)
    layer = 1.5 if stroke.width < FULL_WIDTH else 3.0 if stroke.marker else 2.0
    every = max(1, len(series.x) // SYMBOLS_ON_A_CURVE) if stroke.marker else None
    axes.plot(
        series.x,
        series.y,
        color=colour,
        linestyle=stroke.line,
        linewidth=stroke.width,
        marker=stroke.marker or None,
        markevery=every,
        markerfacecolor="white",
        markeredgewidth=1.1,
        zorder=layer,
    )
    if _visible(series):
        _draw_uncertainty(axes, series, colour, symbols=bool(stroke.marker))


def _visible(series: Series) -> bool:
    """Whether the uncertainty is wider than the line, roughly a thousandth of what the ordinates span."""
    span = max(series.y, default=0.0) - min(series.y, default=0.0)
    return bool(series.half_width) and max(series.half_width) > NARROWEST_BAND * span


def _draw_uncertainty(axes: Axes, series: Series, colour: str, *, symbols: bool) -> None:
    """Bars at symbols, a band around a line."""
    y, half_width = np.array(series.y), np.array(series.half_width)
    if symbols:
        axes.errorbar(series.x, y, yerr=half_width, fmt="none", ecolor=colour, elinewidth=1.0, capsize=2.0, zorder=2.5)
    else:
        axes.fill_between(series.x, y - half_width, y + half_width, color=colour, alpha=0.2, linewidth=0.0)


def stroke_of(series: Series) -> Stroke:
    """The style a series asks for, or that of its method.

    MDR is a line, the other methods are symbols on it, closed forms and asymptotes thin dashes below.
    """
    marker = look_of(series.method).marker
    if series.style in STYLES:
        return STYLES[series.style]
    if series.style == "symbols" or base_of(series.method) in SYMBOL_METHODS:
        return Stroke(line="none", marker=marker)
    if _is_asymptote(series.method):
        return STYLES["dotted" if "half" in series.method else "dashed"]
    return Stroke(line="-" if base_of(series.method) in LINE_METHODS else look_of(series.method).dash, marker="")


def _is_asymptote(method: str) -> bool:
    return any(word in method for word in ("asymptot", "closed", "thin", "half"))


def _colour(series: Series, colours: dict[str, str]) -> str:
    if len(colours) > 1 and series.group in colours:
        return colours[series.group]
    return BLACK if _is_asymptote(series.method) else look_of(series.method).colour


def _colours(figure: Figure) -> dict[str, str]:
    """A colour for each group, dark to light as the groups come: readable in grey and with any colour vision."""
    shown = (series for panel in figure.panels for series in panel.series if series.group)
    groups = _distinct(series.group for series in shown if not _is_asymptote(series.method))
    places = np.linspace(0.0, 0.84, max(2, len(groups)))
    return {group: to_hex(colormaps["viridis"](place)) for group, place in zip(groups, places, strict=False)}


def _legend_entries(figure: Figure) -> list[Line2D]:
    """Groups by colour, then methods by line or symbol; nothing when there is only one thing to tell."""
    colours = _colours(figure)
    grouped = len(colours) > 1
    entries = [Line2D([], [], color=colour, linewidth=3.0, label=group) for group, colour in colours.items() if grouped]
    all_series = [series for panel in figure.panels for series in panel.series]
    shown = {s.method: s for s in all_series} | {s.method: s for s in all_series if s.style == "by method"}
    return entries + [_method_entry(series, GREY if grouped else _colour(series, colours)) for series in shown.values()]


def _method_entry(series: Series, colour: str) -> Line2D:
    stroke = stroke_of(series)
    return Line2D(
        [],
        [],
        color=colour,
        linestyle=stroke.line,
        linewidth=stroke.width,
        marker=stroke.marker or None,
        markerfacecolor="white",
        label=display_name(series.method),
    )


def _distinct(names: Iterable[str]) -> Sequence[str]:
    return tuple(dict.fromkeys(names))

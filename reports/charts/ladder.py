"""Stability ladders: significant digits left as a parameter gets hard, and the rung where a method gives up by name."""

import math
from collections.abc import Iterable, Sequence
from itertools import groupby

from matplotlib.axes import Axes

from cases.measurements.measurement import grouped
from cases.results.records.reliability import Ladder, Rung
from cases.results.records.run import CaseResult
from cases.results.status import Status
from reports.figures.figure import Cell, ReportFigure
from reports.figures.panel_chart import PanelChart
from reports.pages.outcomes import worded
from reports.style import look_of, mark_decades
from reports.words import display_name

# Significant digits of a double, the unit roundoff as digits.
DOUBLE_DIGITS = -math.log10(2.0**-53)
COLUMNS = (
    "ladder", "parameter", "unit", "method", "quantity", "value", "status", "digits", "iterations", "residuals",
    "reason",
)  # fmt: skip
CAPTION = (
    "From left to right the parameter gets harder. Symbols: significant digits that repeats share when inputs move by "
    "one unit in the last place, unknowns are permuted and other kernels compute. Crosses at the bottom: the method "
    "refused with a named error instead of a number. The dotted line is what doubles can carry."
)


def figures(case: CaseResult) -> list[ReportFigure]:
    """The ladders of a case: one panel a ladder, the methods overlaid."""
    panels = list(grouped(case.ladders, lambda ladder: (ladder.name, ladder.quantity)).values())
    return CHART.figures(f"{case.name}-ladders", panels)


def _rows(ladders: Sequence[Ladder]) -> Iterable[tuple[Cell, ...]]:
    return (_row(ladder, rung) for ladder in ladders for rung in ladder.rungs)


def _row(ladder: Ladder, rung: Rung) -> tuple[Cell, ...]:
    names = (ladder.name, ladder.parameter, ladder.unit, ladder.method, ladder.quantity)
    residuals = " ".join(f"{name}={value!r}" for name, value in rung.residuals.items())
    return *names, rung.value, str(rung.status), rung.digits, rung.iterations, residuals, rung.reason


def _draw_panel(axes: Axes, ladders: Sequence[Ladder]) -> None:
    first = ladders[0]
    unit = "" if first.unit == "1" else f" [{first.unit}]"
    quantity = first.quantity.replace("_", " ")
    axes.set(xscale="log", xlabel=f"{first.parameter}{unit}", ylabel=f"digits of {quantity}", title=first.name)
    axes.axhline(DOUBLE_DIGITS, color="black", linestyle=":", linewidth=0.8)
    for ladder in ladders:
        _draw_ladder(axes, ladder)
    axes.set_ylim(0.0, 17.0)
    if _falls(first.rungs):
        axes.invert_xaxis()
    mark_decades(axes.xaxis)
    axes.legend(loc="lower left")


def _draw_ladder(axes: Axes, ladder: Ladder) -> None:
    look, name = look_of(ladder.method), display_name(ladder.method)
    climbed = [(rung.value, rung.digits) for rung in ladder.rungs if rung.digits is not None]
    refused = [rung.value for rung in ladder.rungs if rung.digits is None]
    failed = any(rung.status is Status.FAIL for rung in ladder.rungs if rung.digits is None)
    values, digits = zip(*climbed, strict=True) if climbed else ((), ())
    axes.plot(values, digits, color=look.colour, linestyle=look.dash, linewidth=1.0, marker=look.marker, label=name)
    if refused:
        axes.plot(
            refused, [0.0] * len(refused), color=look.colour, marker="x", markersize=8, markeredgewidth=2.0,
            linestyle="none", clip_on=False, label=f"{name}, {'refused or failed' if failed else 'refused by name'}",
        )  # fmt: skip


def _falls(rungs: Sequence[Rung]) -> bool:
    """Whether the parameter is walked downwards: then the axis turns, so that hard stands on the right."""
    return rungs[-1].value < rungs[0].value


CHART = PanelChart(
    title="Stability: digits left where it gets hard",
    caption=CAPTION,
    columns=COLUMNS,
    rows=_rows,
    panel=_draw_panel,
    size=(5.0, 2.9),
)


def refusals(case: CaseResult) -> Iterable[str]:
    """One sentence for each stretch of rungs that a method refused, with what the first of them said."""
    for ladder in case.ladders:
        for was_refused, stretch in groupby(ladder.rungs, key=lambda rung: rung.digits is None):
            if was_refused:
                yield _refusal(ladder, list(stretch))


def _refusal(ladder: Ladder, rungs: Sequence[Rung]) -> str:
    values = f"{rungs[0].value:.3g}"
    if len(rungs) > 1:
        values += f" to {rungs[-1].value:.3g} ({len(rungs)} rungs)"
    place = f"{display_name(ladder.method)}, {ladder.name}, {ladder.parameter} = {values}"
    return f"{place}: {worded(rungs[0].reason)}"

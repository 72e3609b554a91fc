"""Error under refinement: filled symbols for the measured error, empty ones for the stated, bars for the estimated."""

from collections.abc import Iterable, Sequence
from itertools import cycle

from matplotlib.axes import Axes

from cases.measurements.measurement import grouped
from cases.results.records.convergence import ConvergenceStudy, Grid
from cases.results.records.run import CaseResult
from reports.figures.figure import Cell, ReportFigure
from reports.figures.panel_chart import PanelChart
from reports.style import BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILLION, mark_decades
from reports.words import display_name

# A bar is so wide, in decades of length: bars of grids refined by the root of two (0.15 decades) do not touch.
BAR_WIDTH = 0.1
# The legend stands above the symbols: so much of the axis is added for each of its lines.
ROOM_FOR_A_LINE = 0.1
# Colour and marker of the quantities of one panel.
LOOKS_OF_QUANTITIES = ((VERMILLION, "s"), (BLUE, "o"), (GREEN, "^"), (PURPLE, "D"), (ORANGE, "v"))
COLUMNS = (
    "scene", "quantity", "method", "mesh_family", "length", "unknowns", "seconds", "value", "error", "gci", "unit",
    "scale", "formal_order", "observed_order", "digits_per_refinement", "stated",
)  # fmt: skip
CAPTION = (
    "One panel a refinement. Filled symbols: distance to the reference, relative to the scale of the quantity; without "
    "a reference, to the value extrapolated from the refinements, or to that of the finest grid. Empty symbols: error "
    "that the method itself states. Bars: error that the refinements suggest (grid convergence index). Either covers "
    "the error where it lies above the filled symbol. Dashes: formal order. In the legend: observed and formal order, "
    "or digits gained per refinement where convergence is exponential."
)


def figures(case: CaseResult) -> list[ReportFigure]:
    """The convergence of a case: one panel a refinement, its quantities overlaid."""
    panels = grouped(case.convergence, lambda study: (study.scene, study.method, study.mesh_family))
    return CHART.figures(f"{case.name}-convergence", list(panels.values()))


def _rows(studies: Sequence[ConvergenceStudy]) -> Iterable[tuple[Cell, ...]]:
    for study, grid in ((one, grid) for one in studies for grid in one.grids):
        names = study.scene, study.quantity, study.method, study.mesh_family
        measured = (grid.length, grid.unknowns, grid.seconds, grid.value, grid.error, grid.gci)
        orders = (study.formal_order, study.observed_order, study.digits_per_refinement)
        yield *names, *measured, study.unit, study.scale, *orders, grid.stated


def _draw_panel(axes: Axes, studies: Sequence[ConvergenceStudy]) -> None:
    first = studies[0]
    exponential = first.formal_order is None
    axes.set(xscale="linear" if exponential else "log", yscale="log", ylabel="relative error")
    axes.set_xlabel("refinement" if exponential else "relative discretisation length")
    axes.set_title(f"{first.scene}\n{display_name(first.method)}: {first.mesh_family}")
    for study, (colour, marker) in zip(studies, cycle(LOOKS_OF_QUANTITIES)):
        _draw_study(axes, study, colour, marker)
    if not axes.lines:
        axes.text(0.5, 0.5, "all refinements give the same digits", transform=axes.transAxes, ha="center")
        return
    bottom, top = axes.get_ylim()
    axes.set_ylim(bottom, top * (top / bottom) ** (ROOM_FOR_A_LINE * len(axes.get_legend_handles_labels()[1])))
    mark_decades(axes.yaxis)
    if exponential:
        axes.set_xticks(range(len(first.grids)))
    else:
        mark_decades(axes.xaxis)
    axes.legend(loc="upper left")


def _draw_study(axes: Axes, study: ConvergenceStudy, colour: str, marker: str) -> None:
    shown = distances(study)
    if not shown:
        return
    places, errors = zip(*shown, strict=True)
    label = f"{study.quantity.replace('_', ' ')} ({_speed(study)})"
    axes.plot(places, errors, color=colour, linestyle=":", linewidth=0.8, marker=marker, label=label)
    if study.formal_order is not None:
        line = [errors[0] * (place / places[0]) ** study.formal_order for place in places]
        axes.plot(places, line, color=GREY, linestyle="--", linewidth=1.0, zorder=1.5)
    stated = [(place, grid.stated / study.scale) for place, grid in _placed(study) if grid.stated]
    if stated:
        axes.plot(*zip(*stated, strict=True), color=colour, linestyle="none", marker=marker, markerfacecolor="white")
    half = 10.0 ** (BAR_WIDTH / 2)
    for place, gci in ((place, grid.gci) for place, grid in _placed(study) if grid.gci):
        axes.plot([place / half, place * half], [gci, gci], color=colour, linewidth=1.4)


def _placed(study: ConvergenceStudy) -> list[tuple[float, Grid]]:
    """The grids with their length, or with the number of refinements where convergence is exponential."""
    if study.formal_order is not None:
        return [(grid.length, grid) for grid in study.grids]
    return [(float(number), grid) for number, grid in zip(reversed(range(len(study.grids))), study.grids, strict=True)]


def distances(study: ConvergenceStudy) -> list[tuple[float, float]]:
    """Place and relative distance to the best value there is, finest first; a distance of zero has no logarithm."""
    best = study.extrapolated if study.extrapolated is not None else study.grids[0].value
    found = (
        (place, (abs(grid.value - best) if grid.error is None else grid.error) / study.scale)
        for place, grid in _placed(study)
    )
    return [(place, distance) for place, distance in found if distance > 0.0]


def _speed(study: ConvergenceStudy) -> str:
    """How fast the errors fell, in a few words."""
    if study.digits_per_refinement is not None:
        return f"{study.digits_per_refinement:.1f} digits per refinement"
    if study.observed_order is None or study.formal_order is None:
        return str(study.kind)
    return f"order {study.observed_order:.2f}, formal {study.formal_order:g}"


CHART = PanelChart(
    title="Convergence: error under refinement",
    caption=CAPTION,
    columns=COLUMNS,
    rows=_rows,
    panel=_draw_panel,
    size=(5.0, 3.2),
)

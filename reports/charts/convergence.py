"""Error under refinement: symbols for the measured error, bars for the estimated one, dashes for the formal order."""

from collections.abc import Iterable, Sequence

from matplotlib.axes import Axes

from cases.measurements.measurement import grouped
from cases.results.records.convergence import ConvergenceStudy
from cases.results.records.run import CaseResult
from reports.figures.figure import Cell, ReportFigure
from reports.figures.panel_chart import PanelChart
from reports.figures.style import GREY, look_of, mark_decades
from reports.words.method_names import display_name

# A bar is so wide, in decades of length: bars of grids refined by two (0.3 decades) do not touch.
BAR_WIDTH = 0.16
COLUMNS = (
    "scene", "quantity", "method", "mesh_family", "length", "unknowns", "seconds", "value", "error", "gci", "unit",
    "scale", "formal_order", "observed_order", "digits_per_refinement",
)  # fmt: skip
CAPTION = (
    "Symbols: distance to the reference, relative to the scale of the quantity; without a reference, distance to the "
    "value extrapolated from the refinements, or to that of the finest grid where none was extrapolated. Bars: error "
    "that the refinements themselves suggest (grid convergence index); a bar that reaches its symbol covers the error. "
    "Dashes: formal order. In brackets: observed order, or digits gained per refinement where convergence is spectral."
)


def figures(case: CaseResult) -> list[ReportFigure]:
    """The convergence of a case: one panel a scene and quantity, the methods overlaid."""
    panels = list(grouped(case.convergence, lambda study: (study.scene, study.quantity)).values())
    return CHART.figures(f"{case.name}-convergence", panels)


def _rows(studies: Sequence[ConvergenceStudy]) -> Iterable[tuple[Cell, ...]]:
    for study, grid in ((one, grid) for one in studies for grid in one.grids):
        measured = (grid.length, grid.unknowns, grid.seconds, grid.value, grid.error, grid.gci)
        orders = (study.formal_order, study.observed_order, study.digits_per_refinement)
        yield study.scene, study.quantity, study.method, study.mesh_family, *measured, study.unit, study.scale, *orders


def _draw_panel(axes: Axes, studies: Sequence[ConvergenceStudy]) -> None:
    first = studies[0]
    quantity = first.quantity.replace("_", " ")
    axes.set(xscale="log", yscale="log", xlabel="relative discretisation length", ylabel=f"distance of {quantity}")
    axes.set_title(first.scene)
    for study in studies:
        _draw_study(axes, study)
    if not axes.lines:
        axes.text(0.5, 0.5, "all refinements give the same digits", transform=axes.transAxes, ha="center")
        return
    for study in studies:
        _draw_bars(axes, study)
    for axis in (axes.xaxis, axes.yaxis):
        mark_decades(axis)
    axes.legend(loc="best")


def _draw_study(axes: Axes, study: ConvergenceStudy) -> None:
    look = look_of(study.method)
    shown = distances(study)
    if not shown:
        return
    lengths, errors = zip(*shown, strict=True)
    label = f"{display_name(study.method)} ({_speed(study)})"
    axes.plot(lengths, errors, color=look.colour, linestyle=":", linewidth=0.8, marker=look.marker, label=label)
    if study.formal_order is not None:
        line = [errors[0] * (length / lengths[0]) ** study.formal_order for length in lengths]
        axes.plot(lengths, line, color=GREY, linestyle="--", linewidth=1.0, zorder=1.5)


def distances(study: ConvergenceStudy) -> list[tuple[float, float]]:
    """Length and relative distance to the best value there is, finest first; a distance of zero has no logarithm."""
    best = study.extrapolated if study.extrapolated is not None else study.grids[0].value
    found = (
        (grid.length, (abs(grid.value - best) if grid.error is None else grid.error) / study.scale)
        for grid in study.grids
    )
    return [(length, distance) for length, distance in found if distance > 0.0]


def _draw_bars(axes: Axes, study: ConvergenceStudy) -> None:
    """Bars of the estimated error, from the bottom of the axes up."""
    bottom = axes.get_ylim()[0]
    colour = look_of(study.method).colour
    half = 10.0 ** (BAR_WIDTH / 2)
    for length, gci in ((grid.length, grid.gci) for grid in study.grids if grid.gci):
        sides = [length / half, length * half]
        axes.fill_between(sides, bottom, max(gci, bottom), facecolor=colour, alpha=0.18, edgecolor="none", zorder=1.2)
        axes.plot(sides, [gci, gci], color=colour, linewidth=1.4)
    axes.set_ylim(bottom=bottom)


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
    size=(5.0, 3.1),
)

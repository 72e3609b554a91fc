"""What accuracy costs in time: error bound against seconds, the Pareto front solid, dominated settings faint."""

from collections.abc import Iterable, Sequence
from functools import partial

from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from cases.results.records.cost import WorkPoint, WorkPrecision
from cases.results.records.run import CaseResult
from reports.figures.figure import Cell, ReportFigure
from reports.style import BLACK, FAINT, GREY, look_of, mark_decades
from reports.words import display_name, file_name, small

COLUMNS = (
    "scene", "quantity", "method", "setting", "status", "error", "bound", "seconds", "lower_quartile", "upper_quartile",
    "unknowns", "peak_memory_bytes", "on_front", "reason",
)  # fmt: skip
# Crosses of failed settings stand so far apart, as a fraction of the width of the axes.
CROSSES_APART = 0.03
CAPTION = (
    "Each symbol is one setting: median time of repeated runs (bars: quartiles) and bound U of the relative error "
    "(error plus uncertainty of the reference, dotted line). Filled: on the Pareto front, nothing is both at least "
    "as accurate and clearly faster. Faint: dominated. Crosses on the upper border: settings that failed."
)


def figures(case: CaseResult) -> list[ReportFigure]:
    """One figure for each scene and quantity that was timed."""
    return [
        ReportFigure(
            name=file_name(case.name, "work-precision", work.scene, work.quantity),
            title=f"Error against seconds: {work.quantity.replace('_', ' ')}, {work.scene}",
            caption=f"{CAPTION} Reference: {work.reference_source}.",
            paint=partial(draw, work),
            columns=COLUMNS,
            rows=tuple(_row(work, point) for point in work.points),
        )
        for work in case.work_precision
    ]


def _row(work: WorkPrecision, point: WorkPoint) -> tuple[Cell, ...]:
    times = (point.seconds, point.lower_quartile, point.upper_quartile)
    cost = (point.unknowns, point.peak_memory_bytes, point.on_front)
    error = (str(point.status), point.error, point.bound)
    return work.scene, work.quantity, point.method, point.label, *error, *times, *cost, point.reason


def draw(work: WorkPrecision) -> Drawing:
    """Error bound over median seconds, both logarithmic."""
    drawing = Drawing(figsize=(6.4, 4.2), layout="constrained")
    axes = drawing.subplots()
    axes.set(xscale="log", yscale="log", xlabel="median time [s]")
    axes.set_ylabel(f"bound of the relative error, {work.quantity.replace('_', ' ')}")
    measured = [point for point in work.points if point.bound]
    if measured:
        # There is a decade of room on both sides because a single point has no range of its own.
        marked = (work.reference_uncertainty, work.crossover)
        bounds = [*(_bound(point) for point in measured), *(value for value in marked if value)]
        axes.set_ylim(min(bounds) / 10.0, 10.0 * max(bounds))
    for method in dict.fromkeys(point.method for point in work.points):
        _draw_method(axes, method, [point for point in measured if point.method == method])
    _draw_front(axes, [point for point in measured if point.on_front])
    _draw_references(axes, work)
    _draw_failures(axes, [point for point in work.points if point.bound is None])
    mark_decades(axes.xaxis)
    mark_decades(axes.yaxis)
    drawing.legend(loc="outside lower center", ncols=3)
    return drawing


def _draw_method(axes: Axes, method: str, points: Sequence[WorkPoint]) -> None:
    """Filled on the front, empty and faint where dominated; one entry in the legend."""
    look = look_of(method)
    for chosen, face, alpha in ((True, look.colour, 1.0), (False, "white", 0.55)):
        part = [point for point in points if point.on_front is chosen]
        seconds, bounds = [p.seconds for p in part], [_bound(p) for p in part]
        spread = [[p.seconds - p.lower_quartile for p in part], [p.upper_quartile - p.seconds for p in part]]
        axes.errorbar(
            seconds, bounds, xerr=spread, color=look.colour, linestyle="none", marker=look.marker, markerfacecolor=face,
            alpha=alpha, elinewidth=0.9,
        )  # fmt: skip
    axes.plot([], [], color=look.colour, linestyle="none", marker=look.marker, label=display_name(method))


def _draw_front(axes: Axes, points: Iterable[WorkPoint]) -> None:
    """Steps from point to point: nothing between two measured settings is promised."""
    front = sorted(points, key=lambda point: point.seconds)
    axes.plot(
        [p.seconds for p in front], [_bound(p) for p in front], color=BLACK, linewidth=1.1, drawstyle="steps-post",
        zorder=1.8, label="Pareto front",
    )  # fmt: skip


def _draw_references(axes: Axes, work: WorkPrecision) -> None:
    if work.reference_uncertainty > 0.0:
        axes.axhline(work.reference_uncertainty, color=GREY, linestyle=":", linewidth=1.0)
    if work.crossover is not None:
        name = display_name(work.fast_method)
        axes.axhline(work.crossover, color=FAINT, linestyle="-", linewidth=1.0, zorder=1.2)
        note = f"{name} is faster down to {small(work.crossover)}"
        axes.annotate(
            note, (1.0, work.crossover), xycoords=("axes fraction", "data"), ha="right", va="bottom", fontsize=7.5
        )


def _draw_failures(axes: Axes, points: Sequence[WorkPoint]) -> None:
    """Crosses side by side on the upper border, from the right: they have no time; one entry in the legend."""
    for number, point in enumerate(points):
        axes.plot(
            [0.98 - CROSSES_APART * number], [1.0], transform=axes.transAxes, color=look_of(point.method).colour,
            marker="x", markersize=8, markeredgewidth=2.0, linestyle="none", clip_on=False,
        )  # fmt: skip
    if points:
        axes.plot([], [], color=BLACK, marker="x", markeredgewidth=2.0, linestyle="none", label="failed")


def _bound(point: WorkPoint) -> float:
    """The bound of a point that has one."""
    if point.bound is None:
        raise ValueError(f"setting {point.label!r} of {point.method} has no error bound: {point.reason}")
    return point.bound

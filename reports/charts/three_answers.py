"""The pictures of the front page: differences against stated errors, error against seconds, how far ladders go."""

import math
from collections.abc import Iterable, Sequence
from functools import partial

from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from cases.results.records.claim import Claim, Kind
from cases.results.records.cost import WorkPoint, WorkPrecision
from cases.results.records.reliability import Ladder
from cases.results.records.run import RunResult
from cases.results.status import Status
from reports.figures.figure import Cell, ReportFigure
from reports.style import GREY, TINT, VERMILLION, look_of, mark_decades
from reports.words import display_name, small

# Inches: a third of a desk's width, or a phone's whole one.
SIZE = (4.7, 3.9)
# Below this differences are roundings; a difference of nothing is drawn here.
SMALLEST = 1e-17


def compared(run: RunResult) -> list[tuple[str, Claim]]:
    """Every relative difference between two methods that was measured, with its case."""
    return [
        (case.name, claim)
        for case in run.cases
        for claim in case.claims
        if claim.kind is Kind.AGREEMENT and claim.observed is not None and claim.unit == "1"
    ]


def agreement(run: RunResult) -> ReportFigure | None:
    """Every comparison of two methods: difference over the error that both state together."""
    found = compared(run)
    if not found:
        return None
    rows = tuple((case, c.scene, c.quantity, " against ".join(c.methods), _stated(c), _seen(c)) for case, c in found)
    return ReportFigure(
        name="all-differences",
        title="Difference of two methods against the error they state",
        caption="Each symbol is one comparison of two methods, all cases. Below the line the difference is explained "
        "by the errors that the two methods state themselves; above it, it is not. Differences below 1e-17 are drawn "
        "there.",
        paint=partial(_draw_differences, [claim for _, claim in found]),
        columns=("case", "scene", "quantity", "methods", "stated_error", "difference"),
        rows=rows,
    )


def _stated(claim: Claim) -> float:
    return math.hypot(*claim.uncertainty.values())


def _seen(claim: Claim) -> float:
    return abs(claim.observed or 0.0)


def _draw_differences(claims: Sequence[Claim]) -> Drawing:
    drawing = Drawing(figsize=SIZE, layout="constrained")
    axes = drawing.subplots()
    axes.set(xscale="log", yscale="log", xlabel="error stated by both", ylabel="relative difference")
    for pair in dict.fromkeys(claim.methods for claim in claims):
        ours = [(max(_stated(c), SMALLEST), max(_seen(c), SMALLEST)) for c in claims if c.methods == pair]
        _draw_symbols(axes, ours, pair)
    ends = [SMALLEST / 3.0, 3.0 * max(max(_stated(c), _seen(c), SMALLEST) for c in claims)]
    axes.fill_between(ends, ends, [ends[0]] * 2, color=TINT, zorder=0.5)
    axes.plot(ends, ends, color=GREY, linewidth=1.0)
    axes.set(xlim=ends, ylim=ends)
    _finish(drawing, axes)
    return drawing


def cost(run: RunResult) -> ReportFigure | None:
    """Error against seconds of all timed cases."""
    found = [
        (case.name, work.quantity, point)
        for case in run.cases
        for work in case.work_precision
        for point in work.points
        if _unbeaten(point, work)
    ]
    if not found:
        return None
    return ReportFigure(
        name="all-costs",
        title="Error against seconds, all timed cases",
        caption="Each symbol is a setting that no other setting of the same method beats in both time and error on "
        "its scene: median time of repeated solutions, and the bound of the relative error.",
        paint=partial(_draw_costs, [point for _, _, point in found]),
        columns=("case", "quantity", "method", "setting", "seconds", "bound"),
        rows=tuple((case, quantity, p.method, p.label, p.seconds, p.bound) for case, quantity, p in found),
    )


def _unbeaten(point: WorkPoint, work: WorkPrecision) -> bool:
    """Whether no other setting of the method is both faster and more accurate on this scene."""
    if not point.bound:
        return False
    others = (other for other in work.points if other.method == point.method and other.bound)
    return not any(other.seconds < point.seconds and (other.bound or 0.0) < point.bound for other in others)


def _draw_costs(points: Sequence[WorkPoint]) -> Drawing:
    drawing = Drawing(figsize=SIZE, layout="constrained")
    axes = drawing.subplots()
    axes.set(xscale="log", yscale="log", xlabel="seconds", ylabel="bound of the relative error")
    for method in dict.fromkeys(point.method for point in points):
        _draw_symbols(axes, [(p.seconds, p.bound or SMALLEST) for p in points if p.method == method], (method,))
    _finish(drawing, axes)
    return drawing


def _draw_symbols(axes: Axes, places: Iterable[tuple[float, float]], methods: Sequence[str]) -> None:
    """Empty symbols of one method, or of the last of two that are compared."""
    look, (x, y) = look_of(methods[-1]), zip(*places, strict=True)
    axes.plot(
        x, y, color=look.colour, marker=look.marker, markersize=3.5, markerfacecolor="none", linestyle="none",
        label=" – ".join(map(display_name, methods)),
    )  # fmt: skip


def _finish(drawing: Drawing, axes: Axes) -> None:
    mark_decades(axes.xaxis)
    mark_decades(axes.yaxis)
    drawing.legend(loc="outside lower center", ncols=2)


def breakdown(run: RunResult) -> ReportFigure | None:
    """How far each method climbs each ladder of hard scenes."""
    found = [ladder for case in run.cases for ladder in case.ladders]
    if not found:
        return None
    return ReportFigure(
        name="all-ladders",
        title="How far hard scenes go",
        caption="Each bar is a ladder: one parameter made harder step by step, from left to right; its value where "
        "the method refuses or fails is written beside it. Digits: those that perturbed repeats share at worst.",
        paint=partial(_draw_ladders, found),
        columns=("ladder", "method", "parameter", "rungs", "climbed", "stops_at"),
        rows=tuple(_ladder_row(one) for one in found),
    )


def _ladder_row(ladder: Ladder) -> tuple[Cell, ...]:
    stop = ladder.breakdown
    end = None if stop is None else stop.value
    return ladder.name, ladder.method, ladder.parameter, len(ladder.rungs), climbed(ladder), end


def climbed(ladder: Ladder) -> int:
    """Rungs before the first that was refused or failed."""
    stop = ladder.breakdown
    return len(ladder.rungs) if stop is None else ladder.rungs.index(stop)


def _draw_ladders(ladders: Sequence[Ladder]) -> Drawing:
    drawing = Drawing(figsize=(SIZE[0], max(SIZE[1], 1.0 + 0.24 * len(ladders))), layout="constrained")
    axes = drawing.subplots()
    for place, ladder in enumerate(ladders):
        look = look_of(ladder.method)
        failed = ladder.breakdown is not None and ladder.breakdown.status is Status.FAIL
        share = climbed(ladder) / len(ladder.rungs)
        axes.barh(place, share, color=VERMILLION if failed else look.colour, height=0.6)
        axes.annotate(_end(ladder), (0.02, place), va="center", fontsize=7.5, color="white" if share > 0.5 else "black")
    axes.set_yticks(range(len(ladders)), [f"{one.name}, {display_name(one.method)}" for one in ladders])
    axes.set_ylim(len(ladders) - 0.5, -0.5)
    axes.set(xlim=(0.0, 1.0), xlabel="share of the ladder that was climbed")
    axes.grid(visible=False, axis="y")
    return drawing


def _end(ladder: Ladder) -> str:
    stop = ladder.breakdown
    digits = "" if ladder.fewest_digits is None else f"{ladder.fewest_digits:.0f} digits, "
    if stop is None:
        return f"{digits}to {small(ladder.rungs[-1].value)}"
    return f"{digits}{'fails at' if stop.status is Status.FAIL else 'refuses'} {small(stop.value)}"


def figures(run: RunResult) -> Iterable[ReportFigure | None]:
    """The three pictures, in the order of the three questions."""
    return agreement(run), cost(run), breakdown(run)

"""Pictures of studies: error under refinement, error against seconds, digits left in stress tests."""

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from cases.runs import Run
from cases.studies import Convergence, CostOfAccuracy, Grid, StressTest
from reports.findings import grouped
from reports.style import BLACK, GREY, look_of, mark_decades, panels
from reports.tables import observed_order, timed_methods
from reports.words import display_name, file_name, quantity_words

# Errors below this are roundings and are drawn at it.
SMALLEST = 1e-17
# Panels on one figure: a page.
MOST_PANELS = 6
# Colours and markers of quantities, not of methods.
QUANTITY_LOOKS = ((BLACK, "o"), ("#8c510a", "^"), ("#01665e", "D"), ("#762a83", "v"), (GREY, "s"))


class Picture(NamedTuple):
    """A picture: file name (unique in the run), title, and the drawing, made in the figure style."""

    name: str
    title: str
    draw: Callable[[], Figure]


def study_pictures(run: Run, case: str) -> list[Picture]:
    """The pictures of a case's studies."""
    studies = grouped((s for s in run.judged.convergence if s.case == case), lambda s: (s.scene, s.method, s.refined))
    tests = grouped((t for t in run.judged.stress_tests if t.case == case), lambda t: (t.name, t.quantity))
    orders, digits = "Convergence: error under refinement", "Stress tests: digits left as a parameter gets hard"
    return [
        *_in_panels(case, "convergence", orders, list(studies.values()), _draw_convergence),
        *(_cost(cost) for cost in run.judged.costs if cost.case == case and len(cost.points) > 1),
        *_in_panels(case, "stress-tests", digits, list(tests.values()), _draw_stress_test),
    ]


def _in_panels(
    case: str, kind: str, title: str, groups: Sequence[Any], draw: Callable[[Axes, Any], None]
) -> list[Picture]:
    """One panel per group, several panels per picture."""
    parts = [groups[start : start + MOST_PANELS] for start in range(0, len(groups), MOST_PANELS)]
    names = (file_name(case, kind, f"{number}") for number in range(1, len(parts) + 1))
    return [Picture(name, title, partial(_panels, part, draw)) for name, part in zip(names, parts, strict=True)]


def _panels(groups: Sequence[Any], draw: Callable[[Axes, Any], None]) -> Figure:
    drawing, all_axes = panels(len(groups), size=(5.0, 3.1), columns=2)
    for axes, group in zip(all_axes, groups, strict=True):
        draw(axes, group)
    return drawing


def logarithmic(size: tuple[float, float], x_label: str, y_label: str) -> tuple[Figure, Axes]:
    """One pair of logarithmic axes."""
    drawing = Figure(figsize=size, layout="constrained")
    axes = drawing.subplots()
    axes.set(xscale="log", yscale="log", xlabel=x_label, ylabel=y_label)
    return drawing, axes


def finished(drawing: Figure, axes: Axes, columns: int = 2) -> Figure:
    """The figure with labels on its decades and a legend below."""
    mark_decades(axes.xaxis, axes.yaxis)
    drawing.legend(loc="outside lower center", ncols=columns)
    return drawing


def _draw_convergence(axes: Axes, studies: Sequence[Convergence]) -> None:
    first = studies[0]
    exponential = first.formal_order is None
    axes.set(xscale="linear" if exponential else "log", yscale="log", ylabel="relative error")
    axes.set_xlabel("refinement" if exponential else "relative discretisation length")
    axes.set_title(f"{first.scene}\n{display_name(first.method)}: {first.refined}")
    for number, study in enumerate(studies):
        _draw_study(axes, study, *QUANTITY_LOOKS[number % len(QUANTITY_LOOKS)])
    if not axes.lines:
        axes.text(0.5, 0.5, "all refinements give the same digits", transform=axes.transAxes, ha="center")
        return
    # The legend stands above the symbols: a tenth of the axis for each of its lines.
    bottom, top = axes.get_ylim()
    axes.set_ylim(bottom, top * (top / bottom) ** (0.1 * len(studies)))
    mark_decades(axes.yaxis, *([] if exponential else [axes.xaxis]))
    if exponential:
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.legend(loc="upper left")


def _draw_study(axes: Axes, study: Convergence, colour: str, marker: str) -> None:
    shown = [(place, error) for place, grid in _placed(study) if (error := relative_distance(study, grid)) > 0.0]
    if not shown:
        return
    places, errors = zip(*shown, strict=True)
    formal = "" if study.formal_order is None else f", formal {study.formal_order:g}"
    label = f"{quantity_words(study.quantity)} ({observed_order(study)}{formal})"
    axes.plot(places, errors, color=colour, linestyle=":", linewidth=0.8, marker=marker, label=label)
    if study.formal_order is not None:
        line = [errors[0] * (place / places[0]) ** study.formal_order for place in places]
        axes.plot(places, line, color=GREY, linestyle="--", linewidth=1.0, zorder=1.5)
    stated = [(place, grid.stated / study.scale) for place, grid in _placed(study) if grid.stated]
    if stated:
        axes.plot(*zip(*stated, strict=True), color=colour, linestyle="none", marker=marker, markerfacecolor="white")


def _placed(study: Convergence) -> list[tuple[float, Grid]]:
    """The grids with their length, or with the number of refinements where convergence is exponential."""
    if study.formal_order is not None:
        return [(grid.length, grid) for grid in study.grids]
    return [(float(len(study.grids) - 1 - number), grid) for number, grid in enumerate(study.grids)]


def relative_distance(study: Convergence, grid: Grid) -> float:
    """Relative error of a grid, or its relative distance to the finest grid where there is no reference."""
    return (abs(grid.value - study.grids[0].value) if grid.error is None else grid.error) / study.scale


def _cost(cost: CostOfAccuracy) -> Picture:
    title = (
        f"Error against seconds: {quantity_words(cost.quantity)}, {cost.scene}, against {display_name(cost.reference)}"
    )
    return Picture(file_name(cost.case, "cost", cost.scene, cost.quantity), title, partial(_draw_cost, cost))


def _draw_cost(cost: CostOfAccuracy) -> Figure:
    label = f"bound of the relative error, {quantity_words(cost.quantity)}"
    drawing, axes = logarithmic((6.4, 4.2), "median time [s]", label)
    for method, points in timed_methods(cost).items():
        look = look_of(method)
        for point in points:
            t, u = point.seconds, point.bound or SMALLEST
            axes.errorbar(
                t, u, xerr=[[max(0.0, t - point.quartiles[0])], [max(0.0, point.quartiles[1] - t)]], fmt=look.marker,
                color=look.colour, markerfacecolor=look.colour if point.on_front else "white", elinewidth=0.9,
            )  # fmt: skip
        axes.plot([], [], look.marker, color=look.colour, label=display_name(method))
    front = sorted((p.seconds, p.bound or SMALLEST) for p in cost.points if p.on_front)
    if front:
        axes.step(*zip(*front, strict=True), where="post", color=BLACK, linewidth=1.1, zorder=1.8, label="Pareto front")
    bounds = [bound for point in cost.points if (bound := point.bound)]
    if bounds:
        axes.set_ylim(min([*bounds, cost.reference_error or math.inf]) / 10.0, 10.0 * max(bounds))
    if cost.reference_error > 0.0:
        axes.axhline(cost.reference_error, color=GREY, linestyle=":", linewidth=1.0)
    for number, point in enumerate(p for p in cost.points if p.bound is None):
        axes.plot(
            [0.98 - 0.03 * number], [1.0], "x", transform=axes.transAxes, color=look_of(point.method).colour,
            markersize=8, markeredgewidth=2.0, clip_on=False,
        )  # fmt: skip
    return finished(drawing, axes, columns=3)


def _draw_stress_test(axes: Axes, tests: Sequence[StressTest]) -> None:
    first = tests[0]
    unit = "" if first.unit == "1" else f" [{first.unit}]"
    axes.set(xscale="log", xlabel=f"{first.parameter}{unit}", title=first.name)
    axes.set(ylabel=f"digits of {quantity_words(first.quantity)}", ylim=(0.0, 17.0))
    axes.axhline(-math.log10(2.0**-53), color="black", linestyle=":", linewidth=0.8)
    for test in tests:
        look = look_of(test.method)
        done = [(step.value, step.digits) for step in test.steps if step.digits is not None]
        axes.plot(*zip(*done, strict=True), color=look.colour, marker=look.marker, label=display_name(test.method))
        # One line per symbol: an empty line that is not clipped has no extent, and the layout would fail.
        for value in (step.value for step in test.steps if step.digits is None):
            axes.plot([value], [0.0], "x", color=look.colour, markersize=8, markeredgewidth=2.0, clip_on=False)
    if first.steps[-1].value < first.steps[0].value:
        axes.invert_xaxis()
    mark_decades(axes.xaxis)
    axes.legend(loc="lower left")

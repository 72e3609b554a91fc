"""Pictures of a run and of its cases, drawn from verdicts, answers and studies; one colour per method."""

import math
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from textwrap import shorten
from typing import Any, NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from cases.cost import pareto_front
from cases.runs import CaseText, Run
from cases.studies import Convergence, CostOfAccuracy, Grid, StressTest
from cases.verdicts import Status, Verdict
from reports.findings import grouped, who
from reports.style import BLACK, GREY, TINT, VERMILLION, look_of, mark_decades, panels
from reports.tables import compared, completed, difference, end_of, fewest_digits, observed_order, timed_methods
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
    drawing, (axes,) = panels(1, size=size)
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


# The worst comparisons of a case that are drawn; its table holds the rest.
WORST_DRAWN = 12
# A front picture [inches]: a third of a desk's width, or a phone's whole one.
FRONT = (4.7, 3.9)
# Curves of one panel: more are not told apart.
MOST_CURVES = 8
# The quantity that stands for an answer: the first of these that it has.
SHOWN_QUANTITIES = (
    "pull_off_force",
    "coefficient_of_restitution",
    "normal_force",
    "contact_stiffness",
    "indentation_depth",
)
UNITS_OF_PARAMETERS = {"thickness": " [m]"}
# Largest number of letters of a scene at a row: more would cover the axes.
LONGEST = 40
Place = tuple[float, float]


def front(run: Run) -> tuple[Picture | None, Picture | None, Picture | None]:
    """The pictures of the three questions: do the methods agree, what does accuracy cost, where does it break."""
    found, costs, tests = compared(run), run.judged.costs, run.judged.stress_tests
    agreement = "Difference of two methods against the error they state"
    return (
        Picture("all-differences", agreement, partial(_draw_differences, found)) if found else None,
        Picture("all-costs", "Error against seconds, all timed cases", partial(_draw_costs, costs)) if costs else None,
        Picture("all-stress-tests", "How far stress tests go", partial(_draw_ends, tests)) if tests else None,
    )


def of_case(run: Run, case: CaseText) -> list[Picture]:
    """The pictures of a case, the worst differences first."""
    own = [v for v in compared(run) if v.case == case.name]
    worst = sorted(own, key=lambda v: -(v.fraction or 0.0))[:WORST_DRAWN]
    name, title = file_name(case.name, "differences"), f"Largest of {len(own)} differences between methods"
    differences = Picture(name, title, partial(_draw_agreement, worst))
    over = _over_parameter(run, case)
    return [*([differences] if own else []), *([over] if over else []), *study_pictures(run, case.name)]


def _symbols(axes: Axes, places: Iterable[Place], methods: Sequence[str]) -> None:
    """Empty symbols of one method, or of the last of two that are compared."""
    look, (x, y) = look_of(methods[-1]), zip(*places, strict=True)
    axes.plot(x, y, look.marker, color=look.colour, markersize=3.5, markerfacecolor="none", label=who(methods))


def _draw_differences(found: Sequence[Verdict]) -> Figure:
    drawing, axes = logarithmic(FRONT, "error stated by both", "relative difference")
    places = {id(v): (max(_stated(v), SMALLEST), max(difference(v), SMALLEST)) for v in found}
    for pair, same in grouped(found, lambda v: v.methods).items():
        _symbols(axes, [places[id(v)] for v in same], pair)
    ends = [SMALLEST / 3.0, 3.0 * max(max(place) for place in places.values())]
    axes.fill_between(ends, ends, ends[0], color=TINT, zorder=0.5)
    axes.plot(ends, ends, color=GREY, linewidth=1.0)
    axes.set(xlim=ends, ylim=ends)
    return finished(drawing, axes)


def _stated(verdict: Verdict) -> float:
    return math.hypot(*verdict.uncertainty.values())


def _draw_costs(costs: Sequence[CostOfAccuracy]) -> Figure:
    drawing, axes = logarithmic(FRONT, "median time [s]", "bound of the relative error")
    fronts = [pareto_front(points, 0.0) for cost in costs for points in timed_methods(cost).values()]
    for method, points in grouped((p for front in fronts for p in front), lambda p: p.method).items():
        _symbols(axes, [(p.seconds, p.bound or SMALLEST) for p in points], (method,))
    return finished(drawing, axes)


def _draw_ends(tests: Sequence[StressTest]) -> Figure:
    drawing, (axes,) = panels(1, size=(FRONT[0], max(FRONT[1], 1.0 + 0.24 * len(tests))))
    for place, test in enumerate(tests):
        number = completed(test)
        failed = number < len(test.steps) and test.steps[number].status == Status.FAIL
        share, digits = number / len(test.steps), fewest_digits(test)
        axes.barh(place, share, color=VERMILLION if failed else look_of(test.method).colour, height=0.6)
        words = f"{digits} digits, {end_of(test)}" if digits else end_of(test)
        axes.annotate(words, (0.02, place), va="center", fontsize=7.5, color="white" if share > 0.5 else "black")
    axes.set_yticks(range(len(tests)), [f"{test.name}, {display_name(test.method)}" for test in tests])
    axes.set(ylim=(len(tests) - 0.5, -0.5), xlim=(0.0, 1.0), xlabel="share of the steps that were completed")
    axes.grid(visible=False, axis="y")
    return drawing


def _draw_agreement(found: Sequence[Verdict]) -> Figure:
    drawing, (axes,) = panels(1, size=(5.0, 0.8 + 0.4 * len(found)))
    shares = [(difference(v) / v.tolerance, _stated(v) / v.tolerance) for v in found]
    least = min((share for pair in shares for share in pair if share > 0.0), default=1.0)
    left = 10.0 ** math.floor(math.log10(max(1e-6, min(least, 0.1))))
    for place, (verdict, (share, stated)) in enumerate(zip(found, shares, strict=True)):
        name = f"{shorten(verdict.scene, LONGEST)}, {quantity_words(verdict.quantity)}, {who(verdict.methods)}"
        axes.annotate(name, (0.01, place - 0.25), xycoords=axes.get_yaxis_transform(), va="center", fontsize=7.5)
        look, middle = look_of(verdict.methods[-1]), max(share, left)
        axes.plot([max(share - stated, left), max(share + stated, left)], [place + 0.15] * 2, color=GREY, linewidth=1.6)
        axes.plot([middle], [place + 0.15], "X" if verdict.status.is_failure else look.marker, color=look.colour)
    right = max(3.0, 3.0 * max(sum(pair) for pair in shares))
    axes.axvspan(left, 1.0, color=TINT, zorder=0.5)
    axes.axvline(1.0, color=VERMILLION, linewidth=1.2)
    axes.set(xscale="log", xlabel="difference / tolerance", xlim=(left, right), ylim=(len(found) - 0.5, -0.8))
    axes.set_yticks([])
    axes.grid(visible=False, axis="y")
    mark_decades(axes.xaxis)
    return drawing


def _over_parameter(run: Run, case: CaseText) -> Picture | None:
    """The answers over the parameter with most numbers; None where no line joins three scenes."""
    numbers: dict[str, set[float]] = {}
    for parameters in case.scenes.values():
        for name, value in parameters.items():
            numbers.setdefault(name, set()).update(_positive(value))
    name = max(numbers, key=lambda one: len(numbers[one]), default="")
    answers = [answer for answer in run.answers.of_case(case.name) if answer.solved]
    quantity = next((q for q in SHOWN_QUANTITIES if any(q in answer.quantities for answer in answers)), "")
    curves: dict[tuple[str, str], list[Place]] = {}
    for answer in (one for one in answers if quantity in one.quantities):
        parameters = case.scenes.get(answer.scene, {})
        group = _group(answer.scene, {other: value for other, value in parameters.items() if other != name})
        for x in _positive(parameters.get(name, "")):
            for y in _positive(abs(answer.quantities[quantity].values[-1])):
                curves.setdefault((group, answer.method), []).append((x, y))
    if max(map(len, curves.values()), default=0) < 3:
        return None
    groups = sorted(dict.fromkeys(group for group, _ in curves), key=lambda g: -len(curves.get((g, "mdr"), ())))
    shown = {place: curve for place, curve in curves.items() if place[0] in groups[:MOST_CURVES]}
    unit = next(a.quantities[quantity].unit for a in answers if quantity in a.quantities)
    label, words = _parameter_words(name), quantity_words(quantity)
    draw = partial(_draw_over, shown, label + UNITS_OF_PARAMETERS.get(name, ""), words + f" [{unit}]" * (unit != "1"))
    return Picture(file_name(case.name, "answers"), f"{words.capitalize()} over {label}", draw)


def _group(scene: str, others: Mapping[str, object]) -> str:
    """What the scenes of a line share: the other parameters, and the words of the scene's name without its numbers."""
    shared = ", ".join(v if isinstance(v, str) else f"{_parameter_words(name)} = {v}" for name, v in others.items())
    words = re.sub(r"\S+=\S+( [mun]m\b)?", "", scene).replace(",", " ").split()
    return ", ".join(filter(None, (" ".join(word for word in words if word not in shared), shared)))


def _parameter_words(name: str) -> str:
    return quantity_words(name.replace("_over_", "/"))


def _positive(value: object) -> tuple[float, ...]:
    """The value alone if it is a number above zero, which a logarithmic axis can show."""
    is_number = isinstance(value, int | float) and not isinstance(value, bool) and value > 0
    return (float(value),) if is_number else ()  # type: ignore[arg-type]


def _draw_over(curves: dict[tuple[str, str], list[Place]], x_label: str, y_label: str) -> Figure:
    drawing, axes = logarithmic((7.0, 4.2), x_label, y_label)
    named: set[str] = set()
    ends: list[tuple[float, float, str]] = []
    for (group, method), places in curves.items():
        look, (x, y) = look_of(method), zip(*sorted(places), strict=True)
        is_line = method == "mdr"
        label = None if method in named else display_name(method)
        axes.plot(
            x, y, look.marker, color=look.colour, linestyle="-" if is_line else "none", linewidth=0.9,
            markerfacecolor="none", markersize=3.0 if is_line else 6.0, label=label,
        )  # fmt: skip
        if is_line and group:
            ends.append((math.log10(y[-1]), x[-1], group))
        named.add(method)
    _name_ends(axes, sorted(ends))
    return finished(drawing, axes, columns=4)


def _name_ends(axes: Axes, ends: Sequence[tuple[float, float, str]]) -> None:
    """The names of lines at their ends (log10 of y, x, name), apart from one another."""
    low, high = (math.log10(end) for end in axes.get_ylim())
    place = -math.inf
    for y, x, name in ends:
        place = max(place + 0.045 * (high - low), y)
        axes.annotate(
            name, (x, 10.0**y), (12, 10.0**place), textcoords=("offset points", "data"), va="center", fontsize=7.0
        )

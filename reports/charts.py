"""Pictures of a run and of its cases, drawn from verdicts, answers and studies; one colour per method."""

import math
import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from textwrap import shorten
from typing import Any, Final, NamedTuple, TypeGuard

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from cases.cost import pareto_front
from cases.runs import CaseText, Run
from cases.studies import Convergence, CostOfAccuracy, Grid, Point, StressTest
from cases.verdicts import Status, Verdict
from reports.findings import grouped, who
from reports.style import BLACK, GREY, TINT, VERMILLION, look_of, mark_decades, panels
from reports.tables import compared, completed, difference, end_of, fewest_digits, observed_order, timed_methods
from reports.words import display_name, file_name, quantity_words

Place = tuple[float, float]

# Errors below this are roundings and are drawn at it.
SMALLEST: Final = 1e-17
# Comparisons that the picture of a case shows, the worst first. Its table has all of them.
WORST_DRAWN: Final = 12
# Width and height of a picture on the front page [inches]: a third of a screen, or the width of a telephone.
FRONT: Final = (4.7, 3.9)
# Most curves of one panel: more cannot be distinguished.
MOST_CURVES: Final = 8
# Largest number of letters of a scene in a row: more would cover the axes.
LONGEST: Final = 40
# Colours and markers of quantities, not of methods.
QUANTITY_LOOKS: Final = ((BLACK, "o"), ("#8c510a", "^"), ("#01665e", "D"), ("#762a83", "v"), (GREY, "s"))
# Quantities that are drawn over a parameter: the first one that the answers have.
SHOWN_QUANTITIES: Final = (
    "pull_off_force",
    "coefficient_of_restitution",
    "normal_force",
    "contact_stiffness",
    "indentation_depth",
)
UNITS_OF_PARAMETERS: Final = {"thickness": " [m]"}


class Picture(NamedTuple):
    """A picture: file name (unique in the run), title, size [inches], and the function that fills its axes."""

    name: str
    title: str
    size: Place
    fill: Callable[[Axes], None]

    def draw(self) -> Figure:
        """The drawing, in the style that is set, with labels on the decades of its logarithmic axes."""
        drawing, (axes,) = panels(1, size=self.size)
        self.fill(axes)
        mark_decades(*(axis for axis in (axes.xaxis, axes.yaxis) if axis.get_scale() == "log"))
        return drawing


def front(run: Run) -> list[list[Picture]]:
    """The pictures of the three questions: do the methods agree, what does accuracy cost, where does it break."""
    title, tests = "Difference of two methods against the error they state", run.judged.stress_tests
    bars = (FRONT[0], max(FRONT[1], 1.0 + 0.24 * len(tests)))
    drawn: tuple[tuple[str, str, Place, Callable[[Any, Axes], None], Sequence[Any]], ...] = (
        ("all-differences", title, FRONT, _draw_differences, compared(run)),
        ("all-costs", "Error against seconds, all timed cases", FRONT, _draw_costs, run.judged.costs),
        ("all-stress-tests", "How far stress tests go", bars, _draw_ends, tests),
    )
    return [[Picture(name, title, size, partial(fill, of))] if of else [] for name, title, size, fill, of in drawn]


def of_case(run: Run, case: CaseText) -> list[Picture]:
    """The pictures of a case, the worst differences first."""
    judged, name = run.judged, case.name
    differences = [v for v in compared(run) if v.case == name]
    worst = sorted(differences, key=lambda v: -(v.fraction or 0.0))[:WORST_DRAWN]
    title, size = f"Largest of {len(differences)} differences between methods", (5.0, 0.8 + 0.4 * len(worst))
    agreement = Picture(file_name(name, "differences"), title, size, partial(_draw_agreement, worst))
    studies = grouped((s for s in judged.convergence if s.case == name), lambda s: (s.scene, s.method, s.refined))
    tests = grouped((t for t in judged.stress_tests if t.case == name), lambda t: (t.name, t.quantity))
    orders, digits = "Convergence: error under refinement", "Stress tests: digits left as a parameter gets hard"
    return [
        *([agreement] if differences else []),
        *_over_parameter(run, case),
        *_panels(file_name(name, "convergence"), orders, studies.values(), _draw_convergence),
        *(_cost(cost) for cost in judged.costs if cost.case == name and len(cost.points) > 1),
        *_panels(file_name(name, "stress-tests"), digits, tests.values(), _draw_stress_test),
    ]


def _panels(name: str, title: str, groups: Iterable[Any], draw: Callable[[Any, Axes], None]) -> Iterable[Picture]:
    """One picture per group, as wide as a telephone's screen."""
    return (Picture(f"{name}-{n}", title, (5.0, 3.1), partial(draw, group)) for n, group in enumerate(groups, 1))


def _logarithmic(axes: Axes, x_label: str, y_label: str) -> None:
    """Make both axes logarithmic and label them."""
    axes.set(xscale="log", yscale="log", xlabel=x_label, ylabel=y_label)


def _legend(axes: Axes, columns: int = 2) -> None:
    """Draw the legend below the axes, each label once."""
    handles = dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    axes.figure.legend(handles.values(), handles, loc="outside lower center", ncols=columns)


def _crosses(axes: Axes, places: Iterable[Place], colour: str, **more: Any) -> None:
    """A cross on the frame for each setting or step without an answer."""
    for x, y in places:  # one line each: an empty line that is not clipped has no extent, and the layout would fail
        axes.plot([x], [y], "x", color=colour, markersize=8, markeredgewidth=2.0, clip_on=False, **more)


def _draw_convergence(studies: Sequence[Convergence], axes: Axes) -> None:
    """Error over discretisation length, or over number of refinements where convergence is exponential."""
    first = studies[0]
    exponential = first.formal_order is None
    axes.set(xscale="linear" if exponential else "log", yscale="log", ylabel="relative error")
    axes.set_xlabel("refinement" if exponential else "relative discretisation length")
    axes.set_title(f"{first.scene}\n{display_name(first.method)}: {first.refined}", y=1.0)
    for number, study in enumerate(studies):
        _draw_study(axes, study, *QUANTITY_LOOKS[number % len(QUANTITY_LOOKS)])
    if not axes.lines:
        axes.text(0.5, 0.5, "all refinements give the same digits", transform=axes.transAxes, ha="center")
        return
    # The legend stands above the symbols: a tenth of the axis for each of its lines.
    bottom, top = axes.get_ylim()
    axes.set_ylim(bottom, top * (top / bottom) ** (0.1 * len(studies)))
    if exponential:
        axes.xaxis.set(major_locator=MaxNLocator(integer=True), major_formatter="{x:g}")
    axes.legend(loc="upper left")


def _draw_study(axes: Axes, study: Convergence, colour: str, marker: str) -> None:
    """Errors (filled), stated errors (empty) and formal order (dashed) over length, or over number of refinements."""
    order, finest = study.formal_order, len(study.grids) - 1
    grids = [(grid.length if order else float(finest - n), grid) for n, grid in enumerate(study.grids)]
    errors = [(x, error) for x, grid in grids if (error := relative_distance(study, grid)) > 0.0]
    if not errors:
        return
    formal = "" if order is None else f", formal {order:g}"
    label = f"{quantity_words(study.quantity)} ({observed_order(study)}{formal})"
    axes.plot(*zip(*errors, strict=True), color=colour, linestyle=":", linewidth=0.8, marker=marker, label=label)
    if order is not None:
        length, error = errors[0]
        line = [(x, error * (x / length) ** order) for x, _ in errors]
        axes.plot(*zip(*line, strict=True), color=GREY, linestyle="--", linewidth=1.0, zorder=1.5)
    stated = [(x, grid.stated / study.scale) for x, grid in grids if grid.stated]
    if stated:
        axes.plot(*zip(*stated, strict=True), color=colour, linestyle="none", marker=marker, markerfacecolor="white")


def relative_distance(study: Convergence, grid: Grid) -> float:
    """Relative error of a grid, or its relative distance to the finest grid where there is no reference."""
    return (abs(grid.value - study.grids[0].value) if grid.error is None else grid.error) / study.scale


def _cost(cost: CostOfAccuracy) -> Picture:
    quantity = quantity_words(cost.quantity)
    title = f"Error against seconds: {quantity}, {cost.scene}, against {display_name(cost.reference)}"
    return Picture(
        file_name(cost.case, "cost", cost.scene, cost.quantity), title, (6.4, 4.2), partial(_draw_cost, cost)
    )


def _draw_cost(cost: CostOfAccuracy, axes: Axes) -> None:
    """Error bound over time of each setting, with the Pareto front and the error of the reference."""
    _logarithmic(axes, "median time [s]", f"bound of the relative error, {quantity_words(cost.quantity)}")
    for method, points in timed_methods(cost).items():
        look = look_of(method)
        for point in points:
            x, y = _place(point)
            bars = [[max(0.0, x - point.quartiles[0])], [max(0.0, point.quartiles[1] - x)]]
            face = look.colour if point.on_front else "white"
            axes.errorbar(x, y, xerr=bars, fmt=look.marker, color=look.colour, markerfacecolor=face, elinewidth=0.9)
        axes.plot([], [], look.marker, color=look.colour, label=display_name(method))
    if front := sorted(_place(point) for point in cost.points if point.on_front):
        axes.step(*zip(*front, strict=True), where="post", color=BLACK, linewidth=1.1, zorder=1.8, label="Pareto front")
    if bounds := [point.bound for point in cost.points if point.bound]:
        axes.set_ylim(min([*bounds, cost.reference_error or math.inf]) / 10.0, 10.0 * max(bounds))
    if cost.reference_error > 0.0:
        axes.axhline(cost.reference_error, color=GREY, linestyle=":", linewidth=1.0)
    for number, point in enumerate(p for p in cost.points if p.bound is None):
        place = (0.98 - 0.03 * number, 1.0)
        _crosses(axes, [place], look_of(point.method).colour, transform=axes.transAxes)
    _legend(axes, columns=3)


def _place(point: Point) -> Place:
    """Seconds and bound of the error of a timed setting."""
    return point.seconds, point.bound or SMALLEST


def _draw_stress_test(tests: Sequence[StressTest], axes: Axes) -> None:
    """Shared digits over the parameter, with crosses at steps without an answer."""
    first = tests[0]
    unit = "" if first.unit == "1" else f" [{first.unit}]"
    axes.set(xscale="log", xlabel=f"{first.parameter}{unit}")
    axes.set_title(first.name, y=1.0)
    axes.set(ylabel=f"digits of {quantity_words(first.quantity)}", ylim=(0.0, 17.0))
    axes.axhline(-math.log10(2.0**-53), color="black", linestyle=":", linewidth=0.8)
    for test in tests:
        look = look_of(test.method)
        answered = [(step.value, step.digits) for step in test.steps if step.digits is not None]
        axes.plot(*zip(*answered, strict=True), color=look.colour, marker=look.marker, label=display_name(test.method))
        _crosses(axes, [(step.value, 0.0) for step in test.steps if step.digits is None], look.colour)
    if first.steps[-1].value < first.steps[0].value:
        axes.invert_xaxis()
    axes.legend(loc="lower left")


def _symbols(axes: Axes, places: Iterable[Place], methods: Sequence[str]) -> None:
    """Empty symbols of one method, or of the last of two that are compared."""
    look, (x, y) = look_of(methods[-1]), zip(*places, strict=True)
    axes.plot(x, y, look.marker, color=look.colour, markersize=3.5, markerfacecolor="none", label=who(methods))


def _stated(verdict: Verdict) -> float:
    return math.hypot(*verdict.uncertainty.values())


def _draw_differences(verdicts: Sequence[Verdict], axes: Axes) -> None:
    """Difference of two methods over the error that both state; below the diagonal the errors cover it."""
    _logarithmic(axes, "error stated by both", "relative difference")
    largest = SMALLEST
    for methods, same in grouped(verdicts, lambda v: v.methods).items():
        places = [(max(_stated(v), SMALLEST), max(difference(v), SMALLEST)) for v in same]
        largest = max(largest, *map(max, places))
        _symbols(axes, places, methods)
    ends = [SMALLEST / 3.0, 3.0 * largest]
    axes.fill_between(ends, ends, ends[0], color=TINT, zorder=0.5)
    axes.plot(ends, ends, color=GREY, linewidth=1.0)
    axes.set(xlim=ends, ylim=ends)
    _legend(axes)


def _draw_costs(costs: Sequence[CostOfAccuracy], axes: Axes) -> None:
    """Error bound over time along the Pareto front of every method, in all studies of cost."""
    _logarithmic(axes, "median time [s]", "bound of the relative error")
    fronts = [pareto_front(points, 0.0) for cost in costs for points in timed_methods(cost).values()]
    for method, points in grouped((p for front in fronts for p in front), lambda p: p.method).items():
        _symbols(axes, map(_place, points), (method,))
    _legend(axes)


def _draw_ends(tests: Sequence[StressTest], axes: Axes) -> None:
    """Share of the completed steps of each stress test."""
    for row, test in enumerate(tests):
        number = completed(test)
        failed = number < len(test.steps) and test.steps[number].status == Status.FAIL
        share, digits = number / len(test.steps), fewest_digits(test)
        axes.barh(row, share, color=VERMILLION if failed else look_of(test.method).colour, height=0.6)
        words = f"{digits} digits, {end_of(test)}" if digits else end_of(test)
        axes.annotate(words, (0.02, row), va="center", fontsize=7.5, color="white" if share > 0.5 else "black")
    axes.set_yticks(range(len(tests)), [f"{test.name}, {display_name(test.method)}" for test in tests])
    axes.set(ylim=(len(tests) - 0.5, -0.5), xlim=(0.0, 1.0), xlabel="share of the steps that were completed")
    axes.grid(visible=False, axis="y")


def _draw_agreement(verdicts: Sequence[Verdict], axes: Axes) -> None:
    """Difference over tolerance (symbol) with the stated error (bar), one verdict per row."""
    shares = [(difference(v) / v.tolerance, _stated(v) / v.tolerance) for v in verdicts]
    least = min((share for pair in shares for share in pair if share > 0.0), default=1.0)
    left = 10.0 ** math.floor(math.log10(max(1e-6, min(least, 0.1))))
    for row, (verdict, (share, stated)) in enumerate(zip(verdicts, shares, strict=True)):
        name = f"{shorten(verdict.scene, LONGEST)}, {quantity_words(verdict.quantity)}, {who(verdict.methods)}"
        axes.annotate(name, (0.01, row - 0.25), xycoords=axes.get_yaxis_transform(), va="center", fontsize=7.5)
        look, height = look_of(verdict.methods[-1]), row + 0.15
        axes.plot([max(share - stated, left), max(share + stated, left)], [height] * 2, color=GREY, linewidth=1.6)
        marker = "X" if verdict.status.is_failure else look.marker
        axes.plot([max(share, left)], [height], marker, color=look.colour)
    right = max(3.0, 3.0 * max(sum(pair) for pair in shares))
    axes.axvspan(left, 1.0, color=TINT, zorder=0.5)
    axes.axvline(1.0, color=VERMILLION, linewidth=1.2)
    axes.set(xscale="log", xlabel="difference / tolerance", xlim=(left, right), ylim=(len(verdicts) - 0.5, -0.8))
    axes.set_yticks([])
    axes.grid(visible=False, axis="y")


def _over_parameter(run: Run, case: CaseText) -> list[Picture]:
    """The answers over the parameter with most values; no picture where no line joins three scenes."""
    parameters = [pair for of_scene in case.scenes.values() for pair in of_scene.items() if _is_positive(pair[1])]
    ((parameter, _), *_) = Counter(name for name, _ in dict.fromkeys(parameters)).most_common() or [("", 0)]
    solved = [answer for answer in run.answers.of_case(case.name) if answer.solved]
    quantity = next((name for name in SHOWN_QUANTITIES if any(name in a.quantities for a in solved)), "")
    answers = [answer for answer in solved if quantity in answer.quantities]
    curves: dict[tuple[str, str], list[Place]] = {}
    for answer in answers:
        others = dict(case.scenes.get(answer.scene, {}))
        x, y = others.pop(parameter, ""), abs(answer.quantities[quantity].values[-1])
        if _is_positive(x) and _is_positive(y):
            curves.setdefault((_group(answer.scene, others), answer.method), []).append((float(x), y))
    if max(map(len, curves.values()), default=0) < 3:
        return []
    groups = sorted(dict.fromkeys(group for group, _ in curves), key=lambda g: -len(curves.get((g, "mdr"), ())))
    shown = {key: curve for key, curve in curves.items() if key[0] in groups[:MOST_CURVES]}
    unit, label, words = answers[0].quantities[quantity].unit, _parameter_words(parameter), quantity_words(quantity)
    axis = label + UNITS_OF_PARAMETERS.get(parameter, "")
    draw = partial(_draw_over, shown, axis, words + f" [{unit}]" * (unit != "1"))
    return [Picture(file_name(case.name, "answers"), f"{words.capitalize()} over {label}", (7.0, 4.2), draw)]


def _group(scene: str, others: Mapping[str, object]) -> str:
    """Common description of the scenes of a line: the other parameters, and the words of their names."""
    shared = ", ".join(v if isinstance(v, str) else f"{_parameter_words(name)} = {v}" for name, v in others.items())
    words = re.sub(r"\S+=\S+( [mun]m\b)?", "", scene).replace(",", " ").split()
    return ", ".join(filter(None, (" ".join(word for word in words if word not in shared), shared)))


def _parameter_words(name: str) -> str:
    return quantity_words(name.replace("_over_", "/"))


def _is_positive(value: object) -> TypeGuard[float]:
    """Whether the value is a number above zero, which a logarithmic axis can show."""
    return isinstance(value, int | float) and not isinstance(value, bool) and value > 0


def _draw_over(curves: Mapping[tuple[str, str], list[Place]], x_label: str, y_label: str, axes: Axes) -> None:
    """Lines of MDR, named at their ends, and symbols of the other methods."""
    _logarithmic(axes, x_label, y_label)
    ends: list[tuple[float, float, str]] = []
    for (group, method), places in curves.items():
        look, (x, y), label = look_of(method), zip(*sorted(places), strict=True), display_name(method)
        style, size = ("-", 3.0) if method == "mdr" else ("none", 6.0)
        axes.plot(x, y, look.marker, color=look.colour, ls=style, lw=0.9, mfc="none", ms=size, label=label)
        if method == "mdr" and group:
            ends.append((math.log10(y[-1]), x[-1], group))
    low, high = (math.log10(end) for end in axes.get_ylim())
    row = -math.inf
    for y_end, x_end, name in sorted(ends):
        row = max(row + 0.045 * (high - low), y_end)  # names stand apart from one another
        offset: Any = {"textcoords": ("offset points", "data"), "va": "center", "fontsize": 7.0}
        axes.annotate(name, (x_end, 10.0**y_end), (12, 10.0**row), **offset)
    _legend(axes, columns=4)

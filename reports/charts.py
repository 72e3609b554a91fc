"""Pictures of a run and of its cases, drawn from verdicts, answers and studies; one colour per method."""

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from functools import partial
from textwrap import shorten

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from cases.cost import pareto_front
from cases.runs import CaseText, Run
from cases.studies import CostOfAccuracy, StressTest
from cases.verdicts import Status, Verdict
from reports.findings import grouped, who
from reports.study_charts import SMALLEST, Picture, finished, logarithmic, study_pictures
from reports.style import GREY, TINT, VERMILLION, look_of, mark_decades
from reports.tables import compared, completed, difference, end_of, fewest_digits, timed_methods
from reports.words import display_name, file_name, quantity_words

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
# Letters of a scene beside a row: more leave no room for the axes.
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
    drawing = Figure(figsize=(FRONT[0], max(FRONT[1], 1.0 + 0.24 * len(tests))), layout="constrained")
    axes = drawing.subplots()
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
    drawing = Figure(figsize=(8.0, 1.0 + 0.26 * len(found)), layout="constrained")
    axes = drawing.subplots()
    shares = [(difference(v) / v.tolerance, _stated(v) / v.tolerance) for v in found]
    least = min((share for pair in shares for share in pair if share > 0.0), default=1.0)
    left = 10.0 ** math.floor(math.log10(max(1e-6, min(least, 0.1))))
    for place, (verdict, (share, stated)) in enumerate(zip(found, shares, strict=True)):
        look, middle = look_of(verdict.methods[-1]), max(share, left)
        axes.plot([max(share - stated, left), max(share + stated, left)], [place, place], color=GREY, linewidth=1.6)
        axes.plot([middle], [place], "X" if verdict.status.is_failure else look.marker, color=look.colour)
    right = max(3.0, 3.0 * max(sum(pair) for pair in shares))
    axes.axvspan(left, 1.0, color=TINT, zorder=0.5)
    axes.axvline(1.0, color=VERMILLION, linewidth=1.2)
    axes.set(xscale="log", xlabel="difference / tolerance", xlim=(left, right), ylim=(len(found) - 0.5, -0.5))
    names = [f"{shorten(v.scene, LONGEST)}, {quantity_words(v.quantity)}, {who(v.methods)}" for v in found]
    axes.set_yticks(range(len(found)), names)
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

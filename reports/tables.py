"""Tables of a run and of its cases: matrix, differences by pair, costs, orders, stress tests, answers side by side."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import median

from cases.answers import Answer, Values
from cases.cost import bound_of, cheapest, price_of_a_digit
from cases.declare.shared import EVERY, SHARED, Sharing
from cases.runs import Run
from cases.studies import Convergence, CostOfAccuracy, Effect, Point, StressTest
from cases.verdicts import Kind, Status, Verdict
from contact import UNITS
from reports.findings import grouped, severity, tone_of, who, word_of
from reports.words import (
    Table,
    display_name,
    duration,
    measured,
    memory,
    quantity_words,
    scaled_unit,
    small,
    tabulated,
)

# Accuracies that tables of costs show.
SHOWN = (1e-2, 1e-4, 1e-6, 1e-8)
# Method whose times are compared with those of the others.
FAST = "mdr"
# Accuracies at which a page says whether an effect may be left out.
DROPPED_AT = (1e-1, 1e-2, 1e-4)


@dataclass(frozen=True, kw_only=True)
class Cell:
    """The worst of several checks: word, fraction of the tolerance, numbers of checks and skips, colour, reason."""

    word: str
    fraction: str = ""
    checks: int
    skipped: int
    tone: str
    title: str

    @property
    def text(self) -> str:
        """The cell as one line: PASS 0.04 (12)."""
        return " ".join(part for part in (self.word, self.fraction, f"({self.checks})") if part)


def cell_of(verdicts: Iterable[Verdict]) -> Cell:
    """The cell of at least one verdict; skipped verdicts are counted separately, unless all were skipped."""
    ordered = sorted(verdicts, key=severity)
    ran = [v for v in ordered if v.status is not Status.SKIP] or ordered
    worst = ran[0]
    return Cell(
        word=word_of(worst),
        fraction="" if worst.fraction is None else small(worst.fraction),
        checks=len(ran),
        skipped=len(ordered) - len(ran),
        tone=tone_of(worst.status),
        title=f"{worst.claim} [{worst.scene}] ({who(worst.methods, ' against ')}): {worst.message}",
    )


def _solved_cell(answers: Sequence[Answer], unjudged: Sequence[str]) -> Cell:
    """Cell for the solutions of a case; the skips of unjudged methods come before the solutions of the others."""
    skipped = [answer for answer in answers if answer.status is Status.SKIP and answer.method in unjudged]
    ran = skipped or [answer for answer in answers if answer.status is not Status.SKIP] or answers
    worst = max(ran, key=lambda answer: (answer.status.is_failure, answer.status is Status.SKIP))
    return Cell(
        word=worst.status.value,
        checks=len(ran),
        skipped=len(answers) - len(ran),
        tone=tone_of(worst.status),
        title=f"{worst.scene} ({display_name(worst.method)}): {worst.reason}",
    )


def matrix(run: Run) -> tuple[tuple[str, ...], list[tuple[str, list[Cell | None]]]]:
    """Heads and rows of the matrix case x kind of claim; the last column holds the solutions."""
    cells = {place: cell_of(same) for place, same in grouped(run.judged.verdicts, lambda v: (v.case, v.kind)).items()}
    kinds = [kind for kind in Kind if any(place[1] is kind for place in cells)]
    rows = []
    for case in run.judged.cases:
        answers = run.answers.of_case(case.name)
        solved = _solved_cell(answers, run.unjudged) if answers else None
        rows.append((case.name, [*(cells.get((case.name, kind)) for kind in kinds), solved]))
    return (*(kind.value for kind in kinds), "solutions"), rows


def matrix_table(run: Run) -> Table:
    """The matrix as words."""
    heads, cells = matrix(run)
    rows = tuple((name, *(cell.text if cell else "" for cell in row)) for name, row in cells)
    note = "The worst check of each kind, the fraction of its tolerance, and how many checks there are."
    return Table(title="", note=note, heads=("case", *heads), rows=rows, words=1 + len(heads))


def compared(run: Run) -> list[Verdict]:
    """Every relative difference of two methods that was measured."""
    return [v for v in run.judged.verdicts if v.kind is Kind.AGREEMENT and v.error is not None and v.unit == "1"]


def difference(verdict: Verdict) -> float:
    """Size of the relative difference."""
    return abs(verdict.error or 0.0)


def pairs(run: Run) -> Table | None:
    """Median and largest difference of each pair of methods and quantity, with the scene of the largest."""
    worst = [
        (same, max(same, key=difference)) for same in grouped(compared(run), lambda v: (v.methods, v.quantity)).values()
    ]
    return tabulated(
        worst,
        {
            "methods": lambda row: who(row[1].methods),
            "quantity": lambda row: quantity_words(row[1].quantity),
            "largest at": lambda row: f"{row[1].case}, {row[1].scene}",
            "comparisons": lambda row: f"{len(row[0])}",
            "median": lambda row: small(median(map(difference, row[0]))),
            "largest": lambda row: small(difference(row[1])),
            "its tolerance": lambda row: small(row[1].tolerance),
        },
        title="Relative differences by pair of methods and quantity",
        words=3,
    )


def shared_things(run: Run) -> Table | None:
    """Table of the code and data that two methods share, if the run compares any methods."""
    if not any(len(verdict.methods) > 1 for verdict in run.judged.verdicts):
        return None
    return tabulated(
        sorted(SHARED, key=lambda thing: list(Sharing).index(thing.kind)),
        {
            "what": lambda thing: thing.name,
            "kind": lambda thing: thing.kind.value,
            "module": lambda thing: thing.place,
            "used by": lambda thing: "all" if thing.methods == EVERY else who(thing.methods, ", "),
            "enters": lambda thing: quantity_words(", ".join((*thing.quantities, *thing.cases))) or "everything",
            "checks that detect a mistake": lambda thing: thing.guard,
        },
        title="What two methods share",
        note="Agreement does not check what both methods use. A comparison is called independent where it rests on "
        "no shared code; others name it. Each of these planted wrong by one per cent, and the checks that fail: "
        "docs/shared.md.",
        words=6,
    )


def percent(tolerance: float) -> str:
    """An accuracy as 1 % or 1e-4."""
    return f"{100 * tolerance:g} %" if tolerance >= 1e-2 else f"{tolerance:.0e}".replace("e-0", "e-")


def timed_methods(cost: CostOfAccuracy) -> dict[str, list[Point]]:
    """The settings that gave an answer, by method."""
    return grouped((point for point in cost.points if point.bound), lambda point: point.method)


def shortest_times(run: Run) -> Table | None:
    """T*(tau) of every timed scene, quantity and method, and how much faster MDR is."""
    rows = []
    for cost in run.judged.costs:
        points = timed_methods(cost)
        for method, timed in points.items():
            times = (_shortest(timed, tau) for tau in SHOWN)
            faster = _speed_up(points.get(FAST, []), timed) if method != FAST else ""
            rows.append((cost.case, quantity_words(cost.quantity), display_name(method), *times, faster))
    if not rows:
        return None
    return Table(
        title="Shortest time to an accuracy",
        note="Shortest measured time T* with bound U (error plus error of the reference) within the accuracy; nothing "
        "is interpolated. In brackets, the first solution with the same setting, which prepares flat-punch data or "
        "meshes that later ones reuse. Where an accuracy was not reached, the best U.",
        heads=("case", "quantity", "method", *map(percent, SHOWN), f"{display_name(FAST)} is faster"),
        rows=tuple(rows),
        words=3,
    )


def _shortest(points: Sequence[Point], tolerance: float) -> str:
    """Shortest time to a relative accuracy, "T* (first solution)"; "best U" where no setting reached it."""
    fastest = cheapest(points, tolerance)
    if fastest is None:
        return f"best {small(min(map(bound_of, points)))}"
    return f"{duration(fastest.seconds)} ({duration(fastest.cold_seconds)})"


def _speed_up(fast: Sequence[Point], other: Sequence[Point]) -> str:
    """The ratio of shortest times at the finest accuracy that both reach."""
    for tau in reversed(SHOWN):
        ours, theirs = cheapest(fast, tau), cheapest(other, tau)
        if ours and theirs:
            return f"{small(theirs.seconds / ours.seconds)} x at {percent(tau)}"
    return ""


def settings(cost: CostOfAccuracy) -> Table | None:
    """Every timed setting that gave an answer, with the price of a digit along each method's own front."""
    priced = ", ".join(filter(None, (_price(name, points) for name, points in timed_methods(cost).items())))
    return tabulated(
        (point for points in timed_methods(cost).values() for point in points),
        {
            "method": lambda point: display_name(point.method),
            "setting": lambda point: point.setting,
            "U": lambda point: small(bound_of(point)),
            "time": lambda point: duration(point.seconds),
            "quartiles": lambda point: " - ".join(map(duration, point.quartiles)),
            "first": lambda point: duration(point.cold_seconds),
            "memory": lambda point: memory(point.memory) if point.memory else "",
            "unknowns": lambda point: f"{point.unknowns}",
        },
        title="All settings",
        note=f"U: bound of the relative error. Time for one more digit: {priced}." if priced else "",
        words=2,
    )


def _price(method: str, points: Sequence[Point]) -> str:
    """Factor of time per correct digit between the cheapest and the most accurate setting."""
    cheap, accurate = min(points, key=lambda p: p.seconds), min(points, key=bound_of)
    if bound_of(accurate) >= bound_of(cheap):
        return ""
    return f"{display_name(method)} {10.0 ** price_of_a_digit(cheap, accurate):.3g} x"


def orders(run: Run) -> Table | None:
    """One row per study of convergence: observed and formal order, stated and true error."""
    return tabulated(
        run.judged.convergence,
        {
            "case": lambda study: study.case,
            "quantity": lambda study: quantity_words(study.quantity),
            "scene": lambda study: study.scene,
            "method": lambda study: display_name(study.method),
            "refined": lambda study: study.refined,
            "reference": lambda study: "none" if study.reference is None else display_name(study.source),
            "formal": lambda study: "exponential" if study.formal_order is None else f"{study.formal_order:g}",
            "observed": observed_order,
            "finest error": lambda study: small((study.grids[0].error or 0.0) / study.scale),
            "stated": _stated_over_true,
        },
        title=f"{len(run.judged.convergence)} studies of convergence",
        note="Order: of the errors against the reference where one is exact enough, else of the values. Stated: error "
        "stated by the method over the true error of the finest grid; from 1 on it covers it. Convergence that is "
        "exponential has digits per refinement in place of an order.",
        words=6,
    )


def observed_order(study: Convergence) -> str:
    """Observed order of convergence, or digits per refinement, in a few words."""
    if study.digits is not None:
        return f"{study.digits:.1f} digits per refinement"
    return study.kind if study.observed_order is None else f"{study.observed_order:.2f}"


def _stated_over_true(study: Convergence) -> str:
    finest = study.grids[0]
    return f"{finest.stated / finest.error:.2g}" if finest.stated and finest.error else ""


def completed(test: StressTest) -> int:
    """Steps before the first that was refused or failed."""
    return next((n for n, step in enumerate(test.steps) if step.status != Status.PASS), len(test.steps))


def end_of(test: StressTest) -> str:
    """End of a stress test in words: "completed to 1e-7", "refused at 1e-7", "fails at 1e-7"."""
    number, unit = completed(test), "" if test.unit == "1" else f" {test.unit}"
    if number == len(test.steps):
        return f"completed to {small(test.steps[-1].value)}{unit}"
    stop = test.steps[number]
    return f"{'fails' if stop.status == Status.FAIL else 'refused'} at {small(stop.value)}{unit}"


def fewest_digits(test: StressTest) -> str:
    """The fewest digits that repeats share on the completed steps."""
    digits = [step.digits for step in test.steps if step.digits is not None]
    return f"{min(digits):.1f}" if digits else ""


def stress_tests(tests: Sequence[StressTest]) -> Table | None:
    """One row per stress test and method: range, where it ended, digits, residuals, and why it stopped."""
    return tabulated(
        tests,
        {
            "test": lambda test: test.name,
            "method": lambda test: display_name(test.method),
            "parameter": lambda test: test.parameter,
            "end": end_of,
            "why it stopped": lambda test: next((step.reason for step in test.steps[completed(test) :]), ""),
            "fewest digits": fewest_digits,
            "residual": lambda test: small(max((r for s in test.steps for r in s.residuals.values()), default=0.0)),
        },
        title="Stress tests",
        note="Digits: those that perturbed repeats share at the worst completed step. Residual: the largest of any law "
        "of mechanics there, independent answers and stated errors included.",
        words=5,
    )


def effects(parts: Sequence[Effect]) -> Table | None:
    """Table of the cost and influence of each effect and of the finite thickness."""
    return tabulated(
        parts,
        {
            "effect": lambda effect: effect.part,
            "scene": lambda effect: effect.scene,
            "method": lambda effect: display_name(effect.method),
            "costs": lambda effect: f"{100 * effect.share_of_time:.0f} % of {duration(effect.seconds)}",
            "changes": lambda effect: (
                ", ".join(f"{quantity_words(name)} by {small(100 * v)} %" for name, v in effect.changes.items())
                or effect.remark
            ),
            "may be left out at": lambda effect: (
                ", ".join(percent(tau) for tau in DROPPED_AT if effect.may_be_dropped(tau)) or "none"
            ),
        },
        title="What each effect costs and changes",
        note="Each part of a scene is left out in turn. Costs: share of the processor time of a first solution. It may "
        "be left out where no quantity changes by more than the accuracy.",
        words=6,
    )


def answers(given: Sequence[Answer]) -> Table | None:
    """The last step of each scene, methods side by side, each number with the error it states."""
    solved = [answer for answer in given if answer.solved]
    methods = tuple(dict.fromkeys(answer.method for answer in solved))
    rows: list[tuple[str, ...]] = []
    for scene, same in grouped(solved, lambda answer: answer.scene).items():
        rows += [(scene,), *_answer_rows({answer.method: answer for answer in same}, methods)]
    note = (
        "Digits in brackets: error of the last digits, stated by the method itself; (?) where it states none. Load "
        "paths show their last step; all steps are in answers.csv."
    )
    heads = ("quantity", *map(display_name, methods))
    return Table(title="Answers", note=note, heads=heads, rows=tuple(rows)) if rows else None


def _answer_rows(by_method: Mapping[str, Answer], methods: Sequence[str]) -> Iterator[tuple[str, ...]]:
    """One row per quantity, time and memory; a method without that quantity leaves its cell empty."""
    final = {method: _final(answer) for method, answer in by_method.items()}
    for name in dict.fromkeys(name for quantities in final.values() for name in quantities):
        values = (_last_value(name, final[m][name]) if name in final.get(m, {}) else "" for m in methods)
        yield quantity_words(name), *values
    yield "time", *(duration(by_method[m].wall_seconds) if m in by_method else "" for m in methods)
    yield "memory", *(memory(by_method[m].memory) if m in by_method and by_method[m].memory else "" for m in methods)


def _final(answer: Answer) -> dict[str, Values]:
    """Single numbers, such as a pull-off force, where an answer has any; else the whole path."""
    paths = {name: q for name, q in answer.quantities.items() if q.values and not q.at}
    return {name: q for name, q in paths.items() if len(q.values) == 1} or paths


def _last_value(name: str, quantity: Values) -> str:
    """Last value of a quantity with its stated uncertainty in brackets, and its unit."""
    if not quantity.error and name not in UNITS:
        return small(quantity.values[-1])  # a residual vanishes but for rounding and has no error of its own
    factor, unit = scaled_unit(quantity.values[-1], quantity.unit)
    error = quantity.error[-1] / factor if quantity.error else float("inf")
    return f"{measured(quantity.values[-1] / factor, error)} {unit}".strip()

"""The tables of one case: answers of each method side by side, what an accuracy costs, where the time went."""

from collections.abc import Iterable, Iterator, Mapping

from cases.measurements.cost.overview import methods
from cases.results.records.cost import CheapestRun, EffectEntry, WorkPrecision
from cases.results.records.run import CaseResult
from cases.results.records.scene_run import Quantity, SceneRun
from contact import UNITS
from reports.words import Table, display_name, duration, measured, memory, scaled_unit, small, tabulated

# Beyond so many decades of time for one digit, factors are not worth telling apart.
MOST_DECADES = 3
# Accuracies at which a page says whether an effect may be left out.
DROPPED_AT = (1e-1, 1e-2, 1e-4)
DROPPED_WORDS = ", ".join(f"{100 * tau:g} %" for tau in DROPPED_AT)


def answers(case: CaseResult) -> Table | None:
    """The last step of each scene with a claim, methods side by side, each number with the uncertainty it states."""
    judged = dict.fromkeys(claim.scene for claim in case.claims)
    shown = [run for run in case.runs if run.solved and run.scene in judged]
    methods = tuple(dict.fromkeys(run.method for run in shown))
    if not shown:
        return None
    note = (
        "Digits in brackets: uncertainty of the last digits, stated by the method itself; (?) where it states none. "
        "Load paths show their last step, histories what they end with; all steps, and scenes without a claim, are in "
        "results.json."
    )
    rows: list[tuple[str, ...]] = []
    for scene in dict.fromkeys(run.scene for run in shown):
        rows += [(scene,), *_answer_rows({run.method: run for run in shown if run.scene == scene}, methods)]
    heads = ("quantity", *map(display_name, methods))
    return Table(title="Answers", note=note, heads=heads, rows=tuple(rows), words=1)


def _answer_rows(runs: Mapping[str, SceneRun], methods: Iterable[str]) -> Iterator[tuple[str, ...]]:
    """One row a quantity and one for the time; a method without that quantity leaves its cell empty."""
    found = {method: {quantity.name: quantity for quantity in _final(run)} for method, run in runs.items()}
    for name in dict.fromkeys(name for own in found.values() for name in own):
        values = (_last_value(found[m][name]) if name in found.get(m, {}) else "" for m in methods)
        yield name.replace("_", " "), *values
    costs = {method: duration(run.cost.wall_seconds) for method, run in runs.items() if run.cost}
    yield "time", *(costs.get(method, "") for method in methods)


def _final(run: SceneRun) -> tuple[Quantity, ...]:
    """Single numbers, such as a pull-off force, where an answer has any beside its path; else the whole path."""
    single = tuple(quantity for quantity in run.quantities if len(quantity.values) == 1)
    return single or run.quantities


def _last_value(quantity: Quantity) -> str:
    if not quantity.values:
        return ""
    if not quantity.uncertainty and quantity.name not in UNITS:
        # A residual vanishes but for rounding: it has no uncertainty of its own.
        return small(quantity.values[-1])
    return last_value(quantity)


def cheapest(work: WorkPrecision) -> Table:
    """T*(tau): what the next decade of accuracy costs, methods side by side."""
    chosen = methods(work)
    found = {(entry.tolerance, entry.method): _shortest_time(entry) for entry in work.cheapest}
    tolerances = dict.fromkeys(entry.tolerance for entry in work.cheapest)
    return Table(
        title="Shortest time to an accuracy",
        note="T* is the shortest measured time with error bound U within τ; nothing is interpolated. Empty where no "
        "setting got there.",
        heads=("τ", *map(display_name, chosen)),
        rows=tuple((small(tau), *(found.get((tau, method), "") for method in chosen)) for tau in tolerances),
        words=0,
    )


def _shortest_time(entry: CheapestRun) -> str:
    return duration(entry.seconds) if entry.reached and entry.seconds is not None else ""


def digit_prices(work: WorkPrecision) -> Table | None:
    """How many decades of time one more digit costs along the front."""
    return tabulated(
        work.prices,
        {
            "method": lambda price: display_name(price.method),
            "from": lambda price: _setting(price.from_label),
            "to": lambda price: _setting(price.to_label),
            "time for a digit": lambda price: _factor(price.decades_per_digit),
        },
        title="Price of a digit",
        note="Factor of time for one more correct digit, between neighbours on the front.",
        words=3,
    )


def _factor(decades: float) -> str:
    """Of neighbours that are equally accurate the more expensive one gains next to nothing for its time."""
    return f"{10.0**decades:.3g} x" if decades < MOST_DECADES else f"over {10.0**MOST_DECADES:g} x"


def _setting(label: str) -> str:
    """Without the method in front of it."""
    return label.partition(": ")[2] or label


def stages(case: CaseResult) -> Table | None:
    """Where the time of each solution went: the ledger of stages."""
    rows: list[tuple[str, ...]] = []
    judged = {claim.scene for claim in case.claims}
    for run in (run for run in case.runs if run.scene in judged and run.stages):
        total = sum(stage.seconds for stage in run.stages)
        rows.append((f"{run.scene}, {display_name(run.method)}",))
        for stage in run.stages:
            share = f"{100.0 * stage.seconds / total:.0f} %" if total > 0.0 else ""
            size = memory(stage.bytes) if stage.bytes else ""
            rows.append((stage.name, f"{stage.calls}", duration(stage.seconds), share, size))
    if not rows:
        return None
    return Table(
        title="Where the time went",
        note="Stages that ran, and no others: what a scene does not list has no row.",
        heads=("stage", "calls", "time", "share", "memory"),
        rows=tuple(rows),
        words=1,
    )


def effects(case: CaseResult) -> Table | None:
    """What each effect and the finite thickness cost and move, and at which accuracies they may be left out.

    As in: viscosity, 61 % of 12 ms, peak force by 0.02 %, restitution by 3 %.
    """
    return tabulated(
        case.effects,
        {
            "effect": lambda entry: entry.effect,
            "scene": lambda entry: entry.scene,
            "method": lambda entry: display_name(entry.method),
            "costs": lambda entry: f"{100.0 * entry.share_of_time:.0f} % of {duration(entry.seconds)}",
            "moves": _moved,
            "may be left out at": _dropped_at,
        },
        title="What each effect costs and moves",
        note="Each part of a scene is left out in turn. Costs: share of the processor time of a first solution. It may "
        "be left out where no quantity moves by more than the accuracy asked for.",
        words=6,
    )


def _moved(entry: EffectEntry) -> str:
    moved = ", ".join(f"{name.replace('_', ' ')} by {small(100.0 * v)} %" for name, v in entry.changes.items())
    return moved or entry.remark


def _dropped_at(entry: EffectEntry) -> str:
    return (
        ", ".join(f"{100 * tau:g} %" for tau in DROPPED_AT if entry.may_be_dropped(tau)) or "none of " + DROPPED_WORDS
    )


def last_value(quantity: Quantity) -> str:
    """What a quantity ends with, its uncertainty and a fitting unit: 12.345(67) mN."""
    value = quantity.values[-1]
    factor, unit = scaled_unit(value, quantity.unit)
    uncertainty = quantity.uncertainty[-1] if quantity.uncertainty else float("inf")
    return f"{measured(value / factor, uncertainty / factor)} {unit}".strip()

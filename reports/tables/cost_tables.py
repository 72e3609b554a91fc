"""Tables of the cost page: shortest times of all cases side by side, and every setting with its degrees of accuracy."""

from cases.measurements.cost.cost_of_accuracy import (
    degree_of_accuracy,
    degree_of_efficacy,
    degree_of_size,
    true_static_scaling,
)
from cases.measurements.cost.overview import SHOWN, first_speed_up, methods, shortest, speed_up
from cases.results.records.cost import WorkPoint, WorkPrecision
from cases.results.records.run import RunResult
from reports.words import Table, display_name, duration, memory, small, tabulated

# A row of the table names so many stages, those that take most of the time.
STAGES_SHOWN = 3


def shortest_times(run: RunResult) -> Table | None:
    """T*(tau) of every timed scene, quantity and method."""
    rows = tuple(
        _shortest_row(case.name, work, method)
        for case in run.cases
        for work in case.work_precision
        for method in methods(work)
    )
    if not rows:
        return None
    return Table(
        title="Shortest time to an accuracy",
        note="Shortest measured time T* with bound U (error plus uncertainty of the reference) within the accuracy; "
        "nothing is interpolated. In brackets, the first solution with the same setting, which prepares flat-punch "
        "data or meshes that later ones reuse. Where an accuracy was not reached, the best U.",
        heads=("case", "quantity", "method", *(percent(tau) for tau in SHOWN)),
        rows=rows,
        words=3,
    )


def percent(tolerance: float) -> str:
    """An accuracy as 1 % or 1e-4."""
    return f"{100 * tolerance:g} %" if tolerance >= 1e-2 else f"{tolerance:.0e}".replace("e-0", "e-")


def _shortest_row(case: str, work: WorkPrecision, method: str) -> tuple[str, ...]:
    return case, work.quantity.replace("_", " "), display_name(method), *(_time(work, method, tau) for tau in SHOWN)


def _time(work: WorkPrecision, method: str, tolerance: float) -> str:
    row = shortest(work, method, tolerance)
    if row is None or row.seconds is None:
        return ""
    if not row.reached:
        return f"best {small(row.bound or 0.0)}"
    return f"{duration(row.seconds)} ({duration(row.cold_seconds or 0.0)})"


def speed_ups(run: RunResult) -> Table | None:
    """How much faster the fast method is than each other one, at the accuracies both reach."""
    rows = tuple(
        row
        for case in run.cases
        for work in case.work_precision
        for method in methods(work)
        if method != work.fast_method and any(row := _speed_row(case.name, work, method)) and any(row[3:])
    )
    if not rows:
        return None
    fast = display_name(next(work.fast_method for case in run.cases for work in case.work_precision))
    return Table(
        title=f"How much faster {fast} is",
        note="Ratio of shortest times; in brackets, of first solutions. Empty where one of the two did not get there.",
        heads=("case", "quantity", "over", *(percent(tau) for tau in SHOWN), "faster down to"),
        rows=rows,
        words=3,
    )


def _speed_row(case: str, work: WorkPrecision, method: str) -> tuple[str, ...]:
    down_to = small(work.crossover) if work.crossover is not None and method == work.baseline_method else ""
    ratios = (_ratios(work, method, tau) for tau in SHOWN)
    return case, work.quantity.replace("_", " "), display_name(method), *ratios, down_to


def _ratios(work: WorkPrecision, method: str, tolerance: float) -> str:
    warm, cold = (ratio(work, work.fast_method, method, tolerance) for ratio in (speed_up, first_speed_up))
    return "" if warm is None else f"{small(warm)} x" + ("" if cold is None else f" ({small(cold)} x)")


def settings(work: WorkPrecision) -> Table | None:
    """Every setting that gave an answer: size, time, bound, and what the time went into."""
    return tabulated(
        (point for point in work.points if point.bound),
        {
            "method": lambda point: display_name(point.method),
            "setting": lambda point: point.label,
            "most time goes into": _stages,
            "U": lambda point: small(_bound(point)),
            "time": lambda point: duration(point.seconds),
            "quartiles": lambda point: f"{duration(point.lower_quartile)} - {duration(point.upper_quartile)}",
            "first": lambda point: duration(point.cold_seconds),
            "memory": lambda point: memory(point.peak_memory_bytes) if point.peak_memory_bytes else "",
            "unknowns": lambda point: f"{point.unknowns}",
            "DoA": lambda point: f"{degree_of_accuracy(_bound(point)):.1f}",
            "DoS": lambda point: f"{degree_of_size(_unknowns(point)):.1f}",
            "DoE": lambda point: f"{degree_of_efficacy(_bound(point), point.seconds):.1f}",
            "true static scaling [1/s]": lambda point: small(
                true_static_scaling(_unknowns(point), point.seconds, _bound(point))
            ),
        },
        title="All settings",
        note="Degree of accuracy DoA = -log10 U, of size DoS = log10 N, of efficacy DoE = -log10(U T); true static "
        "scaling (N/T)(DoA/DoS). Time: median and quartiles.",
        words=3,
    )


def _bound(point: WorkPoint) -> float:
    return point.bound or 0.0


def _unknowns(point: WorkPoint) -> int:
    """At least two: the logarithm of one is no size."""
    return max(point.unknowns, 2)


def _stages(point: WorkPoint) -> str:
    total = sum(stage.seconds for stage in point.stages)
    most = sorted(point.stages, key=lambda stage: -stage.seconds)[:STAGES_SHOWN]
    return ", ".join(f"{s.name.replace('_', ' ')} {100 * s.seconds / total:.0f} %" for s in most) if total > 0 else ""

"""Work-precision records of many cases side by side: shortest times, and how much faster one method is."""

from collections.abc import Callable

from cases.results.records.cost import CheapestRun, WorkPrecision

SHOWN = (1e-2, 1e-4, 1e-6, 1e-8)
"""Tolerances that an overview has room for."""


def shortest(work: WorkPrecision, method: str, tolerance: float) -> CheapestRun | None:
    """Return T*(tau) of a method, or its most accurate run where it did not reach tau; None without any run."""
    rows = (row for row in work.cheapest if row.method == method and row.tolerance == tolerance)
    return next((row for row in rows if row.seconds is not None), None)


def speed_up(work: WorkPrecision, fast: str, other: str, tolerance: float) -> float | None:
    """Return T* of ``other`` over T* of ``fast`` at one tolerance; None unless both reach it."""
    return _ratio(work, fast, other, tolerance, lambda row: row.seconds)


def first_speed_up(work: WorkPrecision, fast: str, other: str, tolerance: float) -> float | None:
    """Return the same ratio of first solutions, nothing prepared before."""
    return _ratio(work, fast, other, tolerance, lambda row: row.cold_seconds)


def _ratio(
    work: WorkPrecision, fast: str, other: str, tolerance: float, seconds: Callable[[CheapestRun], float | None]
) -> float | None:
    ours, theirs = shortest(work, fast, tolerance), shortest(work, other, tolerance)
    if ours is None or theirs is None or not (ours.reached and theirs.reached and seconds(ours)):
        return None
    return (seconds(theirs) or 0.0) / (seconds(ours) or 1.0)


def methods(work: WorkPrecision) -> tuple[str, ...]:
    """Return the methods with at least one answer, in the order they were tried."""
    return tuple(dict.fromkeys(point.method for point in work.points if point.bound is not None))

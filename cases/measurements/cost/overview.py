"""Work-precision records of many cases side by side: shortest times, and how much faster one method is."""

from cases.results.records.cost import CheapestRun, WorkPrecision

SHOWN = (1e-2, 1e-4, 1e-6, 1e-8)
"""Tolerances that an overview has room for."""


def shortest(work: WorkPrecision, method: str, tolerance: float) -> CheapestRun | None:
    """Return T*(tau) of a method, or its most accurate run where it did not reach tau; None without any run."""
    rows = (row for row in work.cheapest if row.method == method and row.tolerance == tolerance)
    return next((row for row in rows if row.seconds is not None), None)


def speed_up(work: WorkPrecision, fast: str, other: str, tolerance: float) -> float | None:
    """Return T* of ``other`` over T* of ``fast`` at one tolerance; None unless both reach it."""
    ours, theirs = shortest(work, fast, tolerance), shortest(work, other, tolerance)
    if ours is None or theirs is None or not (ours.reached and theirs.reached and ours.seconds):
        return None
    return (theirs.seconds or 0.0) / ours.seconds


def first_speed_up(work: WorkPrecision, fast: str, other: str, tolerance: float) -> float | None:
    """Return the same ratio of first solutions, nothing prepared before."""
    ours, theirs = shortest(work, fast, tolerance), shortest(work, other, tolerance)
    if ours is None or theirs is None or not (ours.reached and theirs.reached and ours.cold_seconds):
        return None
    return (theirs.cold_seconds or 0.0) / ours.cold_seconds


def methods(work: WorkPrecision) -> tuple[str, ...]:
    """Return the methods with at least one answer, in the order they were tried."""
    return tuple(dict.fromkeys(point.method for point in work.points if point.bound is not None))

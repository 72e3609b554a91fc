"""The one driver of all studies: solve, let somebody judge the answer, and write down what came out."""

import time
import warnings
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import TypeAlias, TypeVar

from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]  # ships no types

from cases.measurements.measurement import Measurement
from cases.results.status import Status
from cases.run.empty_caches import forget
from contact import ContactError, Solution

A = TypeVar("A")

Judge: TypeAlias = Callable[[Solution], Iterable[Measurement]]


class CoarseReference(Exception):
    """The reference knows a scene too poorly to measure anything with it, as where a contact hardly leaves its flat."""


def measured(
    solve: Callable[[], Solution], judge: Judge = lambda _: (), *, of: Measurement, first: bool = False
) -> list[Measurement]:
    """Solve and judge: one row for the answer as a whole, then one for each quantity that was judged.

    A warning, in the solution or in the judgement, is a crash.

    Args:
        solve: Gives the answer.
        judge: Compares it; rows of quantities, whose identity is filled in here.
        of: Who solves what: method, settings, scene, parameters and seed of all rows.
        first: Whether nothing may be kept from earlier solutions, as a user finds it; on one thread then.
    """
    start = time.process_time()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            answer, seconds = first_solution(solve) if first else _timed(solve)
            rows = list(judge(answer))
    except ContactError as error:
        return [_unanswered(of, Status.INVALID, error, start)]
    except CoarseReference as error:
        return [_unanswered(of, Status.INCONCLUSIVE, error, start)]
    except Exception as error:
        # A crash is no named refusal: studies look for it.
        return [_unanswered(of, Status.FAIL, error, start)]
    cost = answer.cost
    whole = replace(of, seconds=seconds, unknowns=cost.unknowns, counters=dict(cost.counters))
    return [whole, *(_judged(row, whole) for row in rows)]


def _unanswered(of: Measurement, status: Status, error: Exception, start: float) -> Measurement:
    reason = f"{type(error).__name__}: {error!s:.300}"
    return replace(of, status=status, reason=reason, seconds=time.process_time() - start)


def _judged(row: Measurement, whole: Measurement) -> Measurement:
    """The row of one quantity with the identity and the cost of the answer."""
    return replace(
        whole,
        quantity=row.quantity,
        error=row.error,
        uncertainty=row.uncertainty,
        stated=row.stated,
        sharpness=row.sharpness,
        reference=row.reference,
    )


def first_solution(solve: Callable[[], A]) -> tuple[A, float]:
    """Answer and processor time [s] without anything cached from earlier scenes."""
    forget()
    # Processor time of several threads would count their waiting.
    with threadpool_limits(limits=1):
        return _timed(solve)


def _timed(solve: Callable[[], A]) -> tuple[A, float]:
    start = time.process_time()
    answer = solve()
    return answer, time.process_time() - start

"""Carry out one task.  Whatever happens becomes a row: a failed task never ends a run."""

import time
from collections import deque

from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]  # ships no types

from cases.declare.methods import shared_inputs
from cases.declare.task import Task
from cases.results.records import Scalar, SceneRun
from cases.results.status import Status
from cases.run.empty_caches import forget
from cases.run.recording import cost_record, curves, quantities, stage_records
from cases.run.time_limit import TimeLimitReached, time_limited
from cases.run.timing import timed_warm
from contact import NotConvergedError, Solution, UnsupportedSceneError
from contact.records.plain_text import printable


def solve(task: Task, key: str, time_limit: float = 0.0) -> SceneRun:
    """Return the row of ``task``: its numbers, or the status and the reason why there are none.

    Args:
        task: what to solve.
        key: content key that the row carries.
        time_limit: seconds; zero for no limit.
    """
    try:
        with time_limited(time_limit), threadpool_limits(limits=1):  # one thread: times compare, sums repeat bit by bit
            support = task.solver.supports(task.problem)
            if not support:
                return _without_numbers(task, key, Status.SKIP, getattr(support, "reason", "not supported"))
            return _solved(task, key)
    except TimeLimitReached:
        return _without_numbers(task, key, Status.TIMEOUT, f"not finished after {time_limit:g} s")
    except UnsupportedSceneError as error:
        return _without_numbers(task, key, Status.SKIP, str(error))
    except NotConvergedError as error:
        return _without_numbers(task, key, Status.INVALID, f"NotConvergedError: {error}")
    except Exception as error:  # a solver that breaks in its own way is a row, too
        return _without_numbers(task, key, Status.INVALID, f"{type(error).__name__}: {error}")


def _solved(task: Task, key: str) -> SceneRun:
    if task.timed or task.forgetful:
        task.solver.solve(task.problem)  # loads what the method imports on demand
        forget()
    start = time.perf_counter()
    solutions = deque([task.solver.solve(task.problem)], maxlen=1)
    cold = time.perf_counter() - start
    samples = timed_warm(lambda: solutions.append(task.solver.solve(task.problem))).samples if task.timed else ()
    solution = solutions[0]  # the row of a timing run shows the stages of a warm solve
    return SceneRun(
        key=key,
        scene=task.scene,
        method=task.method,
        settings=_settings(solution),
        status=Status.PASS,
        reason="",
        quantities=quantities(solution, task.sampling),
        curves=curves(solution, task.sampling),
        cost=cost_record(solution.cost),
        stages=stage_records(solution.stages),
        shared_inputs=shared_inputs(task.solver),
        samples=samples,
        cold_seconds=cold if task.timed else None,
        notes=tuple(solution.notes),
    )


def _settings(solution: Solution) -> dict[str, Scalar]:
    plain = bool | int | float | str
    return {name: value if isinstance(value, plain) else str(value) for name, value in solution.settings.items()}


def _without_numbers(task: Task, key: str, status: Status, reason: str) -> SceneRun:
    return SceneRun(
        key=key,
        scene=task.scene,
        method=task.method,
        settings={},
        status=status,
        reason=printable(" ".join(reason.split())) or status.value,
        cost=None,
    )

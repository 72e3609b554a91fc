"""Carry out one task.  Whatever happens becomes a row: a failed task never ends a run."""

import time
from collections import deque
from dataclasses import replace

# This package ships no types.
from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]

from cases.declare.methods import registered, shared_inputs
from cases.declare.task import Task
from cases.judgement.convergence.from_refinement import with_estimated_errors
from cases.results.records.field_types import Scalar
from cases.results.records.scene_run import SceneRun
from cases.results.status import Status
from cases.run.empty_caches import forget
from cases.run.inside.points import fields_at
from cases.run.recording import cost_record, curves, quantities, stage_records
from cases.run.specification import specification
from cases.run.time_limit import TimeLimitReached, time_limited
from cases.run.timing import timed_warm
from contact import ContactPath, NotConvergedError, Solution, UnsupportedSceneError
from contact.records.errors import printable


def solve(task: Task, key: str, time_limit: float = 0.0, *, estimates: bool = True) -> SceneRun:
    """Return the row of ``task``: its numbers, or the status and the reason why there are none.

    Args:
        task: what to solve.
        key: content key that the row carries.
        time_limit: seconds; zero for no limit.
        estimates: whether a method that states no errors is refined for them, which takes many times its own time.
    """
    try:
        # With one thread, times can be compared and sums repeat bit by bit.
        with time_limited(time_limit), threadpool_limits(limits=1):
            support = task.solver.supports(task.problem)
            if not support:
                return without_numbers(task, key, Status.SKIP, getattr(support, "reason", "not supported"))
            return _solved(task, key, estimates=estimates)
    except TimeLimitReached:
        return without_numbers(task, key, Status.TIMEOUT, f"{task.method}: not finished after {time_limit:g} s")
    except UnsupportedSceneError as error:
        return without_numbers(task, key, Status.SKIP, str(error))
    except NotConvergedError as error:
        return without_numbers(task, key, Status.INVALID, f"NotConvergedError: {error}")
    except (Exception, SystemExit) as error:
        # A solver that breaks in its own way becomes a row, too.
        return without_numbers(task, key, Status.INVALID, f"{task.method} crashed: {type(error).__name__}: {error}")


def _solved(task: Task, key: str, *, estimates: bool) -> SceneRun:
    if task.timed or task.forgetful:
        # This loads what the method imports on demand.
        task.solver.solve(task.problem)
        forget()
    start = time.perf_counter()
    solutions = deque([_answer(task)], maxlen=1)
    cold = time.perf_counter() - start
    samples = timed_warm(lambda: solutions.append(_answer(task))).samples if task.timed else ()
    # The row of a timing run shows the stages of a warm solve.
    solution = solutions[0]
    if estimates and not task.timed and task.method in registered():
        solution = _estimated(task, solution)
    return SceneRun(
        key=key,
        scene=task.scene,
        method=task.method,
        settings=_settings(solution),
        specification=specification(task),
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


def _answer(task: Task) -> Solution:
    """The answer; where its time counts, the fields inside that are kept of it count too."""
    solution = task.solver.solve(task.problem)
    if task.timed and task.sampling.inside and isinstance(solution, ContactPath):
        fields_at(solution, task.sampling)
    return solution


def _estimated(task: Task, solution: Solution) -> Solution:
    """The answer with errors from its own refinement; without, where that does not end within the time limit."""
    try:
        return with_estimated_errors(task.solver, task.problem, solution)
    except TimeLimitReached:
        note = "no errors stated; its own refinement did not end within the time limit"
        return replace(solution, notes=(*solution.notes, note))


def _settings(solution: Solution) -> dict[str, Scalar]:
    plain = bool | int | float | str
    return {name: value if isinstance(value, plain) else str(value) for name, value in solution.settings.items()}


def without_numbers(task: Task, key: str, status: Status, reason: str) -> SceneRun:
    """Return the row of a task that has no answer, and why."""
    return SceneRun(
        key=key,
        scene=task.scene,
        method=task.method,
        settings={},
        status=status,
        reason=printable(" ".join(reason.split())) or status.value,
        cost=None,
        shared_inputs=shared_inputs(task.solver),
    )

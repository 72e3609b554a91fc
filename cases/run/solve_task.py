"""Carry out one task.  Whatever happens becomes an answer: a failed task never ends a run."""

import time
from collections import deque
from dataclasses import dataclass, replace

# This package ships no types.
from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]

from cases.answers import Answer
from cases.case import Task
from cases.declare.methods import registered, shared_inputs
from cases.recording import fields_at, recorded
from cases.run.apart import ProcessDied, TimeLimitReached, apart
from cases.run.from_refinement import with_estimated_errors
from cases.run.keys import code, question
from cases.run.timing import clear_caches, timed_warm
from cases.verdicts import Status
from contact import ContactPath, Method, NotConvergedError, Solution, UnsupportedSceneError
from contact.records.errors import printable


@dataclass(frozen=True)
class Job:
    """A task with its method and hashes, built where the run is started and solved in any process.

    Attributes:
        task: Task to solve.
        method: Method with its settings.
        question: Hash of the scene and of the requested settings.
        code: Hash of all else that the answer depends on.
        estimated: Whether a method that states no errors is refined to estimate them, which takes many times as long.
    """

    task: Task
    method: Method
    question: str
    code: str
    estimated: bool = False

    def answer(self, status: Status = Status.PASS, reason: str = "") -> Answer:
        """Return an answer without quantities, with its status and reason."""
        task = self.task
        return Answer(
            case=task.case,
            scene=task.scene,
            method=task.use.label,
            variant=task.variant,
            question=self.question,
            code=self.code,
            status=status,
            reason="" if status is Status.PASS else printable(" ".join(reason.split())) or status.value,
            shared=shared_inputs(self.method),
        )


def job_of(task: Task, *, estimates: bool = True) -> Job:
    """Return the job of a task.

    Raises:
        InvalidInput: If there is no such method, or if it does not take its settings.
    """
    method = task.use.build()
    for _ in range(task.refined):
        method = method.refined()
    foreign = (task.use.method or task.use.label) in registered()
    return Job(task, method, question(task), code(task), estimates and foreign and not task.timed)


def solve(job: Job, time_limit: float = 0.0) -> Answer:
    """Return the answer of a job: its numbers, or the status and the reason why there are none.

    Args:
        job: Job to solve.
        time_limit: Seconds after which the process that solves is killed; zero solves in this process.
    """
    if not time_limit:
        return answered(job)
    try:
        answer: Answer = apart(answered, job, seconds=time_limit)
    except TimeLimitReached:
        return job.answer(Status.TIMEOUT, f"{job.task.use.label}: not finished after {time_limit:g} s")
    except ProcessDied as error:
        return job.answer(Status.INVALID, f"the process that solved it died: {error}")
    return answer


def answered(job: Job) -> Answer:
    """Return the answer of a job, computed in this process."""
    try:
        # With one thread, times can be compared and sums repeat bit by bit.
        with threadpool_limits(limits=1):
            if job.task.measure is not None:
                return replace(job.answer(), **job.task.measure(job.method, job.task.problem))
            support = job.method.supports(job.task.problem)
            if not support:
                return job.answer(Status.SKIP, getattr(support, "reason", "not supported"))
            return _solved(job)
    except UnsupportedSceneError as error:
        return job.answer(Status.SKIP, str(error))
    except NotConvergedError as error:
        return job.answer(Status.INVALID, f"NotConvergedError: {error}")
    except (Exception, SystemExit) as error:
        # A solver that breaks in its own way becomes an answer, too.
        return job.answer(Status.INVALID, f"{job.task.use.label} crashed: {type(error).__name__}: {error}")


def _solved(job: Job) -> Answer:
    """Answer of a job with quantities and costs; a timed task is solved repeatedly."""
    task, method = job.task, job.method
    if task.timed or task.first:
        # This loads what the method imports on demand.
        method.solve(task.problem)
        clear_caches()
    start = time.perf_counter()
    solutions = deque([_solution(task, method)], maxlen=1)
    cold = time.perf_counter() - start
    samples = timed_warm(lambda: solutions.append(_solution(task, method))) if task.timed else ()
    solution = solutions[0]
    if job.estimated:
        solution = with_estimated_errors(method, task.problem, solution)
    settings = {k: v if isinstance(v, bool | int | float | str) else str(v) for k, v in solution.settings.items()}
    cost = solution.cost
    return replace(
        job.answer(),
        settings=settings,
        quantities=recorded(solution, task.sampling),
        seconds=cost.cpu_seconds,
        wall_seconds=cost.wall_seconds,
        memory=cost.peak_memory_bytes,
        unknowns=cost.unknowns,
        counters=dict(cost.counters),
        samples=samples,
        cold_seconds=cold if task.timed else 0.0,
        notes=tuple(solution.notes),
    )


def _solution(task: Task, method: Method) -> Solution:
    """The solution; that of a timed task with the recorded fields inside, whose time counts."""
    solution = method.solve(task.problem)
    if task.timed and task.sampling.inside and isinstance(solution, ContactPath):
        fields_at(solution, task.sampling)
    return solution

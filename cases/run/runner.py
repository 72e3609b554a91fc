"""Carry out cases: plan their tasks, solve each once, keep every finished one, judge the claims.

Results stream to disk as they finish; a failed task is a row; an interrupted run is valid and says that it is
incomplete; timing tasks run after all others, one by one, so that they never share the machine.
"""

import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from functools import partial
from pathlib import Path

from cases.declare.case import Case
from cases.declare.methods import registered
from cases.declare.task import Answers, Task
from cases.judgement.judge import case_result
from cases.results.files import write_run
from cases.results.records.run import CaseResult, RunResult
from cases.results.records.scene_run import SceneRun
from cases.results.status import Status
from cases.run.executors import ClusterLost, ExecutorFactory, ahead, closing, fresh_processes, process_pool, serial
from cases.run.keys import content_key, key_parts
from cases.run.lock import locked
from cases.run.progress import Progress, ProgressEvent, silent
from cases.run.solve_task import solve, without_numbers
from cases.run.specification import specification
from cases.run.stamp import stamp
from cases.run.store import TaskStore
from cases.run.window import Window
from contact import InvalidInput

# Seconds that one solution by a method of an installed package may take unless told otherwise: nobody here knows
# whether it ends.  The value is that of the command `cost`, which allows as much for all repetitions of a setting.
FOREIGN_TIME_LIMIT = 300.0


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """How a run is carried out.

    Attributes:
        out: folder of results; finished tasks lie in ``out/tasks``.
        suite: name of the suite, for the record.
        methods: that were chosen, for the record; empty for those of the cases.
        jobs: tasks at a time; on a cluster as many as it has threads if that is more.
        executor: where they run.
        resume: use finished tasks of an earlier run in the same folder whose keys are equal.
        time_limit: seconds a task may take, zero for no limit; by default only methods of installed packages have one.
        timing: whether timing tasks run; without them there are no work-precision records.
        only_costs: whether only the tasks of work studies run; no claim is then judged.
        progress: told of every event.
        solved: called once all tasks have run, before claims are judged.
    """

    out: Path
    suite: str = ""
    methods: tuple[str, ...] = ()
    jobs: int = 2
    executor: ExecutorFactory = process_pool
    resume: bool = False
    time_limit: float | None = None
    timing: bool = True
    only_costs: bool = False
    progress: Progress = silent
    solved: Callable[[], object] = lambda: None


@dataclass
class _Run:
    """A run under way."""

    options: RunOptions
    store: TaskStore
    total: int
    rows: dict[tuple[str, str, str, str], SceneRun] = field(default_factory=dict)

    def finish(self, planned: "_Planned", row: SceneRun, *, reused: bool = False) -> None:
        """Keep a finished task and tell of it."""
        self.rows[planned.task.identity] = row
        if not reused:
            self.store.put(planned.key, planned.parts, row)
        kind = "reused" if reused else "finished"
        self.tell(kind, planned.task.label, row.status, row.reason)

    def tell(self, kind: str, label: str, status: Status | None = None, reason: str = "") -> None:
        """Report an event."""
        event = ProgressEvent(
            # Its callers pass one of the permitted words.
            kind=kind,  # type: ignore[arg-type]
            label=label,
            done=len(self.rows),
            total=self.total,
            status=status,
            reason=reason,
        )
        self.options.progress(event)


@dataclass(frozen=True)
class _Planned:
    """A task with its key."""

    task: Task
    key: str
    parts: dict[str, object]


def run_cases(cases: Sequence[Case], options: RunOptions) -> RunResult:
    """Run ``cases`` and return the result, which also lies in ``options.out`` as results.json and results.h5.

    An interrupt (Ctrl-C) and a lost cluster end the run early with ``complete`` False; every finished task is kept.

    Raises:
        InvalidInput: if another run works in the folder, or its disk is full.
    """
    with locked(options.out):
        return _run(cases, options)


def _run(cases: Sequence[Case], options: RunOptions) -> RunResult:
    started, clock = datetime.now(UTC), time.perf_counter()
    planned = plan(cases, timing=options.timing, only_costs=options.only_costs)
    run = _Run(options, TaskStore(options.out / "tasks"), total=len(planned))
    run.tell("planned", f"{len(cases)} cases")
    complete = True
    try:
        _carry_out(run, planned)
        options.solved()
    except KeyboardInterrupt:
        complete = False
    except ClusterLost as error:
        complete = False
        run.tell("stopped", "run", reason=f"{error}; finished solutions are kept, go on with --resume")
    answers = Answers(run.rows)
    results = tuple(_judged(run, case, answers, complete=complete) for case in cases)
    result = RunResult(
        suite=options.suite,
        methods=options.methods,
        complete=complete,
        stamp=stamp(started, time.perf_counter() - clock),
        cases=results,
    )
    write_run(result, options.out)
    return result


def plan(cases: Iterable[Case], *, timing: bool = True, only_costs: bool = False) -> list[_Planned]:
    """Return every task of ``cases`` once, with its key; timing tasks last."""
    tasks: dict[tuple[str, str, str, str], Task] = {}
    for case in cases:
        for task in case.cost_tasks() if only_costs else case.tasks():
            tasks.setdefault(task.identity, task)
    wanted = [task for task in tasks.values() if timing or not task.timed]
    return [_planned(task) for task in sorted(wanted, key=lambda task: task.timed)]


def _planned(task: Task) -> _Planned:
    parts = key_parts(task)
    return _Planned(task, content_key(parts), parts)


def _judged(run: _Run, case: Case, answers: Answers, *, complete: bool) -> CaseResult:
    whole = run.options.timing and not run.options.only_costs
    result = case_result(case, answers, complete=complete and whole)
    skipped = whole and not result.status.is_failure and result.unjudged(run.options.methods)
    run.tell("judged", case.name, Status.SKIP if skipped else result.status)
    return result


def _carry_out(run: _Run, planned: list[_Planned]) -> None:
    waiting = [p for p in planned if not _reused(run, p)]
    _solve_in(run, run.options.executor, run.options.jobs, [p for p in waiting if not p.task.timed])
    alone = serial if run.options.executor is serial else fresh_processes
    _solve_in(run, alone, 1, [p for p in waiting if p.task.timed])


def _reused(run: _Run, planned: _Planned) -> bool:
    row = _stored(run, planned) if run.options.resume else None
    if row is None or row.status in (Status.TIMEOUT, Status.INVALID):
        return False
    # Another case may have stored the same scene and settings under names of its own.
    task = planned.task
    own = replace(row, scene=task.scene, method=task.method, specification=specification(task))
    run.finish(planned, own, reused=True)
    return True


def _stored(run: _Run, planned: _Planned) -> SceneRun | None:
    """Return the finished task; one whose file is damaged or changed is refused in words and solved again."""
    try:
        return run.store.get(planned.key)
    except InvalidInput as error:
        run.tell("refused", planned.task.label, reason=str(error))
        return None


def _solve_in(run: _Run, factory: ExecutorFactory, jobs: int, planned: list[_Planned]) -> None:
    """Solve in an executor; when a process dies, the tasks it may have held are repeated one by one, apart."""
    while planned:
        suspects = _solve_until_broken(run, factory, jobs, planned)
        for suspect in suspects:
            _solve_apart(run, factory, suspect)
        planned = [p for p in planned if p.task.identity not in run.rows]


def _solve_until_broken(run: _Run, factory: ExecutorFactory, jobs: int, planned: list[_Planned]) -> list[_Planned]:
    """Return the tasks that were under way when the executor broke; none if it did not."""
    with closing(factory(jobs)) as executor:
        window = Window(partial(_submit, executor, run), partial(ahead, executor, jobs))
        for solved, row in window.results(planned):
            run.finish(solved, row)
    return window.broken


def _submit(executor: Executor, run: _Run, planned: _Planned) -> Future[SceneRun]:
    return executor.submit(solve, planned.task, planned.key, _limit(run.options, planned.task.method))


def _limit(options: RunOptions, method: str) -> float:
    """Seconds that the method may take; zero for no limit."""
    if options.time_limit is not None:
        return options.time_limit
    return FOREIGN_TIME_LIMIT if method in registered() else 0.0


def _solve_apart(run: _Run, factory: ExecutorFactory, planned: _Planned) -> None:
    with closing(factory(1)) as executor:
        try:
            row = _submit(executor, run, planned).result()
        except BrokenExecutor as error:
            row = without_numbers(
                planned.task, planned.key, Status.INVALID, f"the process that solved it died: {error}"
            )
    run.finish(planned, row)

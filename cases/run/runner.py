"""Carry out cases: plan their tasks, solve each once, keep every finished one, judge the claims.

Answers are appended to ``answers.jsonl`` as they come; a failed task is an answer; an interrupted run is valid and says
that it is incomplete; timed tasks run after all others, one by one, so that they never share the machine.
"""

import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import IO, Literal

from cases.answers import NAME, Answer, Identity, Table, read_answers
from cases.case import Case, Task
from cases.declare.methods import registered
from cases.run.executors import (
    ClusterLost,
    ExecutorFactory,
    ahead,
    closing,
    completed,
    died,
    fresh_processes,
    process_pool,
    serial,
)
from cases.run.lock import locked
from cases.run.solve_task import Job, job_of, solve
from cases.run.stamp import stamp
from cases.runs import CaseText, Judged, Run, Stamp, write_run
from cases.studies import Convergence, CostOfAccuracy, Effect, StressTest
from cases.verdicts import Status, worst
from contact import InvalidInput
from contact.files.whole import write_whole


@dataclass(frozen=True, kw_only=True)
class ProgressEvent:
    """One event of a run.

    Attributes:
        kind: "planned" once, then "finished" or "reused" for each task, "judged" for each case; "stopped" when the
            cluster that solves is lost.
        label: Task or case in words.
        done: Number of finished tasks.
        total: Number of all tasks.
        status: Result of the task or case; None for "planned" and "stopped".
        reason: Reason of a status other than PASS, or why the run stopped.
    """

    kind: Literal["planned", "finished", "reused", "judged", "stopped"]
    label: str
    done: int
    total: int
    status: Status | None = None
    reason: str = ""


Progress = Callable[[ProgressEvent], None]


def silent(event: ProgressEvent) -> None:
    """Ignore the event."""


# Default time limit of one solution by a method of an installed package [s]. Half of it stops three-dimensional meshes,
# twice of it only waits longer for methods that hang.
FOREIGN_TIME_LIMIT = 300.0


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """How a run is carried out.

    Attributes:
        out: Folder of results.
        suite: Name of the suite, for the record.
        methods: Labels of chosen methods, for the record; empty for those of the cases.
        jobs: Tasks at a time; a cluster takes as many as it has threads.
        executor: Factory of the executor that runs them.
        resume: Use answers of an earlier run of the same code in the same folder.
        time_limit: Seconds a task may take, zero for no limit; by default only methods of installed packages have one.
        timing: Whether timed tasks run; without them there are no studies of cost.
        only_costs: Whether only the tasks of studies of cost run; no claim is then judged.
        progress: Called with every event.
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


@dataclass
class _Run:
    """A run under way."""

    options: RunOptions
    stream: IO[str]
    total: int
    answers: dict[Identity, Answer] = field(default_factory=dict)

    def finish(self, job: Job, answer: Answer) -> None:
        """Store the answer of a task."""
        self.answers[answer.identity] = answer
        try:
            self.stream.write(answer.line())
            self.stream.flush()
        except OSError as error:
            place = self.options.out / NAME
            raise InvalidInput(f"{place}: cannot be written ({error.strerror}); make room and resume") from None
        self.report("finished", job.task.label, answer.status, answer.reason)

    def report(
        self,
        kind: Literal["planned", "finished", "reused", "judged", "stopped"],
        label: str,
        status: Status | None = None,
        reason: str = "",
    ) -> None:
        """Report an event."""
        place: dict[str, int] = {"done": len(self.answers), "total": self.total}
        self.options.progress(ProgressEvent(kind=kind, label=label, status=status, reason=reason, **place))


def run_cases(cases: Sequence[Case], options: RunOptions) -> Run:
    """Run ``cases`` and return the judged run, which also lies in ``options.out``.

    An interrupt (Ctrl-C) and a lost cluster end the run early with ``complete`` False; every finished task is kept.

    Raises:
        InvalidInput: If another run works in the folder, its disk is full, or a kept answer is damaged.
    """
    with locked(options.out):
        return _run(cases, options)


def _run(cases: Sequence[Case], options: RunOptions) -> Run:
    """Plan, solve and judge the cases, and write the run; the folder is locked."""
    started, clock = datetime.now(UTC), time.perf_counter()
    jobs = [job_of(task) for task in plan(cases, timing=options.timing, only_costs=options.only_costs)]
    reused = _reused(options, jobs)
    complete = True
    with (options.out / NAME).open("a", encoding="utf-8") as stream:
        run = _Run(options, stream, total=len(jobs))
        run.report("planned", f"{len(cases)} case{'s' * (len(cases) != 1)}")
        for job, answer in reused:
            run.answers[answer.identity] = answer
            run.report("reused", job.task.label, answer.status, answer.reason)
        try:
            _carry_out(run, [job for job in jobs if job.task.identity not in run.answers])
        except KeyboardInterrupt:
            complete = False
        except ClusterLost as error:
            complete = False
            run.report("stopped", "run", reason=f"{error}; finished solutions are kept, go on with --resume")
    table = Table(run.answers.values())
    made = stamp(started, time.perf_counter() - clock)
    judged = judge(cases, table, made)
    judged = replace(judged, suite=options.suite, methods=options.methods, complete=complete)
    _report_judged(run, judged, table)
    write_run(judged, options.out)
    return Run(judged=judged, answers=table)


def plan(cases: Iterable[Case], *, timing: bool = True, only_costs: bool = False) -> list[Task]:
    """Return every task of ``cases`` once; timed tasks last."""
    tasks: dict[Identity, Task] = {}
    for case in cases:
        costs = (task for study in case.costs for task in study.tasks(case))
        for task in costs if only_costs else case.tasks():
            tasks.setdefault(task.identity, task)
    wanted = [task for task in tasks.values() if timing or not task.timed]
    return sorted(wanted, key=lambda task: task.timed)


def judge(cases: Iterable[Case], answers: Table, made: Stamp) -> Judged:
    """Return the verdicts and records of cases from the answers present.

    Args:
        cases: Cases as they were run.
        answers: Answers to their tasks; a claim or study without all its answers is left out.
        made: Stamp of the run.
    """
    cases = tuple(cases)
    records = [record for case in cases for claim in case.claims for record in claim.records(case, answers)]
    return Judged(
        stamp=made,
        cases=tuple(words_of(case) for case in cases),
        verdicts=tuple(verdict for case in cases for verdict in case.verdicts(answers)),
        convergence=tuple(record for record in records if isinstance(record, Convergence)),
        costs=tuple(record for record in records if isinstance(record, CostOfAccuracy)),
        stress_tests=tuple(record for record in records if isinstance(record, StressTest)),
        effects=tuple(record for record in records if isinstance(record, Effect)),
    )


def words_of(case: Case) -> CaseText:
    """Return a case in words."""
    return CaseText(
        name=case.name,
        title=case.title,
        question=case.question,
        equations=", ".join(case.equations),
        text=case.text,
        scenes={scene.name: scene.parameters for scene in case.scenes},
    )


def _reused(options: RunOptions, jobs: list[Job]) -> list[tuple[Job, Answer]]:
    """Answers of an earlier run that are used again; the file is written anew with them alone.

    Their hashes of question and code are those of the jobs; timeouts and breakdowns are solved again.
    """
    file = options.out / NAME
    earlier = Table(read_answers(file)) if options.resume and file.is_file() else Table()
    reused = [
        (job, answer)
        for job in jobs
        if (answer := earlier.get(job.task.identity)) is not None
        and answer.status not in (Status.TIMEOUT, Status.INVALID)
        and (answer.question, answer.code) == (job.question, job.code)
    ]
    write_whole(file, "".join(answer.line() for _, answer in reused))
    return reused


def _report_judged(run: _Run, judged: Judged, table: Table) -> None:
    """Report the worst status of each case, or SKIP where a chosen method was not judged."""
    whole = Run(judged=judged, answers=table)
    for case in judged.cases:
        statuses = [verdict.status for verdict in judged.verdicts if verdict.case == case.name]
        status = worst([*statuses, *(answer.status for answer in table.of_case(case.name) if answer.status.is_failure)])
        skipped = not status.is_failure and bool(whole.unjudged_in(case.name))
        run.report("judged", case.name, Status.SKIP if skipped else status)


def _carry_out(run: _Run, jobs: list[Job]) -> None:
    """Solve the jobs in the executor of the run, then the timed ones, one by one."""
    _solve_in(run, run.options.executor, run.options.jobs, [job for job in jobs if not job.task.timed])
    alone = serial if run.options.executor is serial else fresh_processes
    _solve_in(run, alone, 1, [job for job in jobs if job.task.timed])


def _solve_in(run: _Run, factory: ExecutorFactory, count: int, jobs: list[Job]) -> None:
    """Solve in an executor; when a process dies, each task that it may have computed is repeated in one of its own."""
    while jobs:
        suspects: list[Job] = []
        with closing(factory(count)) as executor:
            for job, future in completed(partial(_submit, executor, run), jobs, ahead(executor, count)):
                if not died(future):
                    run.finish(job, future.result())
                elif len(jobs) > 1:
                    suspects.append(job)
                else:
                    reason = f"the process that solved it died: {future.exception()}"
                    run.finish(job, job.answer(Status.INVALID, reason))
        for suspect in suspects:
            _solve_in(run, factory, 1, [suspect])
        jobs = [job for job in jobs if job.task.identity not in run.answers]


def _submit(executor: Executor, run: _Run, job: Job) -> Future[Answer]:
    use = job.task.use
    return executor.submit(solve, job, _limit(run.options, use.method or use.label))


def _limit(options: RunOptions, method: str) -> float:
    """Seconds that the method may take; zero for no limit."""
    if options.time_limit is not None:
        return options.time_limit
    return FOREIGN_TIME_LIMIT if method in registered() else 0.0

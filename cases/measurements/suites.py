"""Studies over many scenes and methods that are no cases of the library, as results that a report shows."""

import time
from collections.abc import Callable, Iterable
from concurrent.futures import Future
from contextlib import ExitStack
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import Self

from cases.results.files import write_run
from cases.results.records.run import CaseResult, RunResult
from cases.run.executors import ClusterLost, ExecutorFactory, closing, serial
from cases.run.stamp import stamp

QUICK_LADDERS = ("vanishing flat end", "stability reverses", "damping ratio")


def run_of(studies: Iterable[CaseResult], out: Path) -> RunResult:
    """Carry out studies (an iterator works while it is listed) and write them as a run into ``out``."""
    started, clock = datetime.now(UTC), time.perf_counter()
    cases = tuple(studies)
    run = RunResult(suite="", complete=True, stamp=stamp(started, time.perf_counter() - clock), cases=cases)
    write_run(run, out)
    return run


class SuiteStudies:
    """The studies of a suite, carried out in processes of their own while its cases are judged.

    Args:
        suite: Its name.
        executor: Where they are carried out.
        jobs: How many at a time.
    """

    def __init__(self, suite: str, executor: ExecutorFactory, jobs: int) -> None:
        self._studies = NIGHTLY if suite == "nightly" else QUICK
        self._executor, self._jobs = executor, jobs
        self._begun = ExitStack()
        self._futures: list[Future[CaseResult]] = []

    def begin(self) -> None:
        """Hand them over; in this process they would not let anything else be done, so they wait until `join`."""
        if self._executor is not serial:
            self._hand_over()

    def _hand_over(self) -> None:
        pool = self._begun.enter_context(closing(self._executor(self._jobs)))
        self._futures = [pool.submit(study) for study in self._studies]

    def join(self, run: RunResult, out: Path) -> RunResult:
        """Add them to the finished run and write it again; an interrupt or a lost cluster leaves it incomplete."""
        clock = time.perf_counter()
        try:
            with self._begun:
                if not self._futures:
                    self._hand_over()
                studies = tuple(future.result() for future in self._futures)
        except (KeyboardInterrupt, ClusterLost):
            run, studies = replace(run, complete=False), ()
        seconds = run.stamp.wall_seconds + time.perf_counter() - clock
        whole = replace(run, cases=(*run.cases, *studies), stamp=replace(run.stamp, wall_seconds=seconds))
        write_run(whole, out)
        return whole

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Leave no process behind where the run ended before they were joined."""
        self._begun.__exit__(kind, error, trace)


def quick_ladders() -> CaseResult:
    """Some ladders of the fast method."""
    from cases.measurements.ladders.ladder_study import chosen, ladder_case  # noqa: PLC0415 - imported where it is carried out
    from cases.measurements.ladders.ladder_table import LADDERS  # noqa: PLC0415

    return ladder_case(chosen(LADDERS, QUICK_LADDERS), {"mdr": {}})


def all_ladders() -> CaseResult:
    """All ladders by every method that climbs them."""
    from cases.measurements.ladders.ladder_study import ladder_case  # noqa: PLC0415 - imported where it is carried out
    from cases.measurements.ladders.ladder_table import LADDERS  # noqa: PLC0415

    return ladder_case(LADDERS)


def code_verification() -> CaseResult:
    """Orders, stability and locking of the finite elements."""
    from cases.library._code_verification.finite_elements import finite_element_case  # noqa: PLC0415

    return finite_element_case()


QUICK: tuple[Callable[[], CaseResult], ...] = (code_verification, quick_ladders)
NIGHTLY: tuple[Callable[[], CaseResult], ...] = (code_verification, all_ladders)

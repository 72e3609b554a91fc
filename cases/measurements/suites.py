"""Studies of a whole suite that are no cases of the library: finite elements as a program, stress tests."""

import time
from collections.abc import Callable, Iterable
from concurrent.futures import Future
from contextlib import ExitStack
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from types import TracebackType
from typing import Self

from cases.answers import Table
from cases.run.executors import ClusterLost, ExecutorFactory, closing, serial
from cases.run.stamp import stamp
from cases.runs import Judged, Part, Run, write_run

QUICK_LADDERS = ("vanishing flat end", "stability reverses", "damping ratio")


def run_of(parts: Iterable[Part], out: Path) -> Run:
    """Write studies as a run into ``out``."""
    started, clock = datetime.now(UTC), time.perf_counter()
    judged = Judged(stamp=stamp(started, 0.0)).joined(parts)
    judged = replace(judged, stamp=replace(judged.stamp, wall_seconds=time.perf_counter() - clock))
    write_run(judged, out)
    return Run(judged=judged, answers=Table())


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
        self._futures: list[Future[Part]] = []

    def begin(self) -> None:
        """Start the studies in other processes; with the executor ``serial`` they start in `join`."""
        if self._executor is not serial:
            self._hand_over()

    def _hand_over(self) -> None:
        pool = self._begun.enter_context(closing(self._executor(self._jobs)))
        self._futures = [pool.submit(study) for study in self._studies]

    def join(self, run: Run, out: Path) -> Run:
        """Add them to the finished run and write it again; an interrupt or a lost cluster leaves it incomplete."""
        clock, judged = time.perf_counter(), run.judged
        try:
            with self._begun:
                if not self._futures:
                    self._hand_over()
                judged = judged.joined(future.result() for future in self._futures)
        except (KeyboardInterrupt, ClusterLost):
            judged = replace(judged, complete=False)
        seconds = judged.stamp.wall_seconds + time.perf_counter() - clock
        whole = replace(judged, stamp=replace(judged.stamp, wall_seconds=seconds))
        write_run(whole, out)
        return replace(run, judged=whole)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop the processes where the run ended before `join`."""
        self._begun.__exit__(kind, error, trace)


def quick_ladders() -> Part:
    """Some stress tests of the fast method."""
    from cases.measurements.ladders.ladder_study import chosen, ladder_case  # noqa: PLC0415 - imported where it is carried out
    from cases.measurements.ladders.ladder_table import LADDERS  # noqa: PLC0415

    return ladder_case(chosen(LADDERS, QUICK_LADDERS), {"mdr": {}})


def all_ladders() -> Part:
    """All stress tests by every method that supports them."""
    from cases.measurements.ladders.ladder_study import ladder_case  # noqa: PLC0415 - imported where it is carried out
    from cases.measurements.ladders.ladder_table import LADDERS  # noqa: PLC0415

    return ladder_case(LADDERS)


def code_verification() -> Part:
    """Orders, stability and locking of the finite elements."""
    from cases.library._finite_elements import finite_element_case  # noqa: PLC0415

    return finite_element_case()


QUICK: tuple[Callable[[], Part], ...] = (code_verification, quick_ladders)
NIGHTLY: tuple[Callable[[], Part], ...] = (code_verification, all_ladders)

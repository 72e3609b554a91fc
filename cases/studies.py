"""Studies over many scenes and methods that are no cases of the library, written as runs that a report shows."""

import time
from collections.abc import Iterable
from datetime import UTC, datetime
from pathlib import Path

from cases.results import CaseResult, RunResult
from cases.results_files import write_run
from cases.stamp import stamp


def run_of(studies: Iterable[CaseResult], out: Path) -> RunResult:
    """Carry out studies (an iterator works while it is listed) and write them as a run into ``out``."""
    started, clock = datetime.now(UTC), time.perf_counter()
    cases = tuple(studies)
    run = RunResult(suite="", complete=True, stamp=stamp(started, time.perf_counter() - clock), cases=cases)
    write_run(run, out)
    return run

"""The timing gate on real code and a busy machine: twenty times the same code, twenty times a planted slowdown."""

import os
import subprocess
import sys
from collections import Counter
from contextlib import ExitStack
from pathlib import Path

import pytest

from cases.gate.circumstances import git
from cases.gate.race import judge_race, race
from cases.gate.version import Version, subject
from cases.gate.worktree import worktree
from cases.registry import load_cases
from cases.status import Status

SOURCE = Path(__file__).parents[3]
TIMES = 20
SLOWER = """

def _slower(solve):
    import time

    def solve_and_wait(self, scene):
        start = time.process_time()
        path = solve(self, scene)
        end = time.process_time() + 0.5 * (time.process_time() - start)
        while time.process_time() < end:
            pass
        return path

    return solve_and_wait


Mdr.solve = _slower(Mdr.solve)
"""


@pytest.fixture(scope="module")
def _busy():
    """At least one other process wants each processor."""
    spin = [sys.executable, "-c", "while True: pass"]
    idle = max(0, (os.cpu_count() or 1) - int(os.getloadavg()[0]))
    processes = [subprocess.Popen(spin) for _ in range(idle)]
    yield
    for process in processes:
        process.kill()
        process.wait()


@pytest.fixture
def clone(tmp_path):
    """The committed source, in a repository of its own."""
    git(SOURCE, "clone", "--quiet", "--no-hardlinks", str(SOURCE), str(tmp_path / "source"))
    return tmp_path / "source"


def statuses(repository):
    """How twenty races of the working tree against its last commit end, each with fresh processes."""
    case = load_cases()["truncated_cone"]
    scene = case.scene("bonded nu=0.45 a/h=1")
    what = subject(case, scene, case.use(scene, "mdr"))
    found = []
    with worktree(repository, "HEAD") as base:
        for _ in range(TIMES):
            with ExitStack() as stack:
                versions = [stack.enter_context(Version(folder)) for folder in (base, repository, base)]
                found.append(judge_race(race(versions, what)))
                print(found[-1].status, found[-1].message, flush=True)  # noqa: T201 - shown when the test fails
    return Counter(judged.status for judged in found)


@pytest.mark.slow
@pytest.mark.usefixtures("_busy")
def test_identical_code_passes_twenty_times_in_a_row(clone):
    assert statuses(clone)[Status.PERF] == 0


@pytest.mark.slow
@pytest.mark.usefixtures("_busy")
def test_code_slower_by_half_fails_nineteen_times_of_twenty(clone):
    with (clone / "mdr" / "method.py").open("a", encoding="utf-8") as source:
        source.write(SLOWER)
    assert statuses(clone)[Status.PERF] >= 19

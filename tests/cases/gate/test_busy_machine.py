"""Race and gate by their own commands, in a repository of its own, on a busy machine: twenty times the same code,
twenty times a planted slowdown, and a planted change of 1e-7."""

import os
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from cases.gate.accept import git

SOURCE = Path(__file__).parents[3]
TIMES = 20
CASE = "near_incompressible"
COMMAND = (sys.executable, "-c", "from reports.command_line import main; main()")
SLOWER = """

def _slower(solve):
    import time

    def solve_and_wait(self, scene):
        start = time.process_time()
        path = solve(self, scene)
        end = time.process_time() + 2.0 * (time.process_time() - start)
        while time.process_time() < end:
            pass
        return path

    return solve_and_wait


Mdr.solve = _slower(Mdr.solve)
"""
HEAVIER = """

def _heavier(solve):
    import dataclasses

    def solve_and_change(self, scene):
        path = solve(self, scene)
        return dataclasses.replace(path, normal_force=path.normal_force * (1 + 1e-7))

    return solve_and_change


Mdr.solve = _heavier(Mdr.solve)
"""


@pytest.fixture(scope="module", autouse=True)
def _busy():
    """At least one other process wants each processor."""
    spin = [sys.executable, "-c", "while True: pass"]
    idle = max(0, (os.cpu_count() or 1) - int(os.getloadavg()[0]))
    processes = [subprocess.Popen(spin) for _ in range(idle)]
    yield
    for process in processes:
        process.kill()
        process.wait()


@pytest.fixture(scope="module")
def accepted(tmp_path_factory):
    """The committed source in a repository of its own, one method's run of one case, and its accepted numbers."""
    folder = tmp_path_factory.mktemp("gated")
    git(SOURCE, "clone", "--quiet", "--no-hardlinks", str(SOURCE), str(folder / "source"))
    assert verify(folder, "run", CASE, *RUN) == 0
    accept = ("accept", CASE, "--reason", "first numbers", "--run", folder / "run", "--baseline", folder / "accepted")
    assert verify(folder, *accept, "--write", "--jobs", "1") == 0
    return folder


@pytest.fixture
def gated(accepted):
    """The same, with the source as it was committed, before and after."""
    yield accepted
    git(accepted / "source", "checkout", "--quiet", ".")


RUN = ("--method", "mdr", "--no-timing", "--quiet", "--jobs", "1", "--out", "../run")
GATE = ("gate", "../run", "--baseline", "../accepted", "--quiet")
RACE = (sys.executable, "-m", "benchmarks.race", "HEAD", "Mdr by depth")


def verify(folder, *words):
    """The exit code of the console command, run in the repository's own source."""
    return exit_code(folder, *COMMAND, *map(str, words))


def exit_code(folder, *words):
    environment = {**os.environ, "PYTHONPATH": str(folder / "source"), "CI": ""}
    return subprocess.run(words, cwd=folder / "source", env=environment, check=False).returncode


def plant(folder, text):
    with (folder / "source" / "mdr" / "method.py").open("a", encoding="utf-8") as source:
        source.write(text)


def exit_codes(folder):
    """How twenty races end, each with a worktree and processes of its own."""
    codes = Counter(exit_code(folder, *RACE) for _ in range(TIMES))
    print(f"exit codes: {dict(codes)}", flush=True)  # noqa: T201 - the measured numbers, shown by pytest -s
    return codes


@pytest.mark.slow
def test_identical_code_passes_twenty_times_in_a_row(gated):
    assert exit_codes(gated) == {0: TIMES}
    assert len(git(gated / "source", "worktree", "list").splitlines()) == 1


@pytest.mark.slow
def test_code_three_times_as_slow_fails_nineteen_times_of_twenty(gated):
    plant(gated, SLOWER)
    assert exit_codes(gated)[1] >= 19


@pytest.mark.slow
def test_a_change_of_1e_7_fails_always(gated):
    plant(gated, HEAVIER)
    changed = gated / "changed"
    for _ in range(3):
        shutil.rmtree(changed, ignore_errors=True)
        assert verify(gated, "run", CASE, *RUN[:-1], changed) == 0  # no claim of the case is about the force
        assert verify(gated, "gate", changed, *GATE[2:]) == 1
    assert "DIFF" in (changed / "summary.md").read_text(encoding="utf-8")

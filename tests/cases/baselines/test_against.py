"""Two revisions of a tiny solver in a repository of its own, one of them slowed down on purpose."""

import subprocess
from pathlib import Path

import pytest

import contact
from cases import methods
from cases.baselines.against import against, subjects, worktree
from cases.methods import TableEntry
from cases.status import Status
from contact import InvalidInput
from tests.cases.fake_case import fake_case, use

SOLVER = """
from dataclasses import dataclass

@dataclass(frozen=True)
class Tiny:
    name = "tiny"
    cell: float = 0.0

    def supports(self, scene):
        return True

    def solve(self, scene):
        return sum(i * i for i in range({work}))

    def refined(self):
        return self
"""


def git(folder, *arguments):
    identity = ["-c", "user.name=t", "-c", "user.email=t@example.org", "-c", "commit.gpgsign=false"]
    done = subprocess.run(["git", *identity, *arguments], cwd=folder, capture_output=True, text=True, check=True)
    return done.stdout.strip()


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """A repository whose first revision does 20 000 units of work; it uses this project's scenes."""
    git(tmp_path, "init", "-q")
    (tmp_path / "contact").symlink_to(Path(contact.__file__).parent)
    git(tmp_path, "add", "contact")
    commit(tmp_path, 20_000)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setitem(methods.BUILT_IN, "fake", TableEntry(module="tiny_solver", attribute="Tiny"))
    return tmp_path


def commit(folder, work):
    (folder / "tiny_solver.py").write_text(SOLVER.format(work=work), encoding="utf-8")
    git(folder, "add", "tiny_solver.py")
    git(folder, "commit", "-qm", f"work {work}")


def case():
    return fake_case(fast=use("fast"), slow=use("slow"))


def compared(repository, pairs=7):
    return against("HEAD~1", [case()], repository=repository, pairs=pairs, shortest=0.02)


def test_identical_code_passes(repository):
    git(repository, "commit", "-q", "--allow-empty", "-m", "nothing")
    claims = compared(repository)
    assert [c.methods for c in claims] == [("fast",), ("slow",)]
    assert Status.PERF not in {c.status for c in claims}


def test_a_slowdown_of_one_and_a_half_is_seen(repository):
    commit(repository, 30_000)
    assert {c.status for c in compared(repository)} == {Status.PERF}


def test_a_speed_up_passes(repository):
    commit(repository, 10_000)
    assert {c.status for c in compared(repository)} == {Status.PASS}


def test_the_other_tree_is_removed_and_the_own_one_untouched(repository):
    with worktree("HEAD", repository) as place:
        assert (place / "tiny_solver.py").is_file()
    assert not place.exists()
    assert git(repository, "worktree", "list").count("\n") == 0


def test_an_unknown_revision_is_one_clear_error(repository):
    with pytest.raises(InvalidInput, match="'nowhere' cannot be checked out"):
        against("nowhere", [case()], repository=repository)


def test_a_tree_that_cannot_solve_is_one_clear_error(repository):
    (repository / "tiny_solver.py").write_text("raise RuntimeError('broken tree')\n", encoding="utf-8")
    git(repository, "commit", "-qam", "broken")
    commit(repository, 20_000)
    with pytest.raises(InvalidInput, match="broken tree"):
        compared(repository)


def test_each_method_is_timed_on_one_scene():
    found = list(subjects([fake_case()]))
    assert [(s.use.label, s.scene) for s in found] == [("fast", "half-space nu=0.3"), ("slow", "half-space nu=0.3")]


@pytest.mark.slow
def test_twenty_identical_pass_and_nineteen_of_twenty_slowdowns_fail(repository):
    """On whatever machine this runs, busy or not: the promise of the gate, measured."""
    git(repository, "commit", "-q", "--allow-empty", "-m", "nothing")
    identical = [claim.status for _ in range(10) for claim in compared(repository)]
    commit(repository, 30_000)
    slower = [claim.status for _ in range(10) for claim in compared(repository)]
    assert identical.count(Status.PERF) == 0
    assert slower.count(Status.PERF) >= 19

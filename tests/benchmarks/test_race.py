"""The race of two sources: what the verdict does with times, and that each sample runs the source it names."""

import math

import numpy as np
import pytest

from benchmarks import race as race_module
from benchmarks.race import ROWS, Race, judge, main, raced, slowdown, worktree
from cases.run.stamp import git
from cases.verdicts import Status
from contact import InvalidInput


def noise(seed, size=15):
    """CPU seconds of a busy machine: 4 % jitter, and now and then a cold cache."""
    draw = np.random.default_rng(seed)
    return 0.1 * np.exp(0.04 * draw.standard_normal(size)) * (1 + 0.3 * (draw.random(size) < 0.05))


def race_of(factor, seed):
    return Race(base=noise(seed), head=factor * noise(seed + 1000), repeated=noise(seed + 2000))


def test_identical_code_passes_and_a_slowdown_of_one_and_a_half_fails_in_59_of_60_races():
    same = [judge(race_of(1.0, seed)) for seed in range(60)]
    slow = [judge(race_of(1.5, seed)) for seed in range(60)]
    assert same.count(Status.PERF) == 0
    assert slow.count(Status.PERF) >= 59


def test_a_limit_inside_the_interval_stays_open():
    steady = Race(base=(1.0,) * 8, head=(1.0,) * 4 + (1.3,) * 4, repeated=(1.0,) * 8)
    assert judge(steady) is Status.INCONCLUSIVE


def test_a_row_with_a_limit_of_two_may_take_1_9_times_the_time():
    assert judge(Race(base=(1.0,) * 8, head=(1.9,) * 8, repeated=(1.0,) * 8, limit=2.0)) is Status.PASS
    assert judge(Race(base=(1.0,) * 8, head=(2.1,) * 8, repeated=(1.0,) * 8, limit=2.0)) is Status.PERF


def test_a_machine_that_shows_nothing_moves_the_limit():
    wild = Race(base=(1.0,) * 8, head=(1.5,) * 8, repeated=(1.3,) * 8)
    assert wild.largest == pytest.approx(1 + 3 * math.log(1.3), rel=1e-12, abs=0.0)
    assert judge(wild) is Status.PASS


@pytest.mark.parametrize(
    ("base", "head"), [([1.0] * 6, [1.0] * 6), ([1.0] * 7, [1.0] * 8), ([1.0] * 8, [math.nan] * 8)]
)
def test_too_few_unpaired_or_missing_times_are_refused(base, head):
    with pytest.raises(InvalidInput, match="times"):
        slowdown(base, head)


# -- real processes on a little package, in two revisions ------------------------------------------------------------

LITTLE = """
import json, time
from little import solve
solve()
start = time.process_time()
answer = solve()
print(json.dumps([time.process_time() - start, 1.0, [answer]]))
"""
SOURCE = """
import time
def solve():
    end = time.process_time() + SECONDS
    while time.process_time() < end:
        pass
    return ANSWER
"""


def source(seconds, answer):
    return SOURCE.replace("SECONDS", seconds).replace("ANSWER", answer)


@pytest.fixture(scope="module")
def repository(tmp_path_factory):
    """A repository whose first commit, `quick`, needs 20 ms, and whose working tree needs 30 ms."""
    folder = tmp_path_factory.mktemp("repository")
    (folder / "little.py").write_text(source("0.02", "2.0"), encoding="utf-8")
    git(folder, "init", "--quiet")
    git(folder, "add", ".")
    git(folder, "-c", "user.name=t", "-c", "user.email=t@t", "commit", "--quiet", "-m", "first")
    git(folder, "tag", "quick")
    (folder / "little.py").write_text(source("0.03", "2.002"), encoding="utf-8")
    return folder


@pytest.mark.slow
def test_a_planted_slowdown_of_one_and_a_half_and_a_changed_answer_are_seen_in_real_processes(repository):
    with worktree(repository, "quick") as base:
        race, line = raced(LITTLE, 1.1, base, repository, rounds=7)
        assert base.is_dir()
    assert slowdown(race.base, race.head).ratio == pytest.approx(1.5, rel=0.1, abs=0.0)
    assert judge(race) is Status.PERF
    assert "| 1e-03 |" in line
    assert not base.exists()
    assert len(git(repository, "worktree", "list").splitlines()) == 1


def test_a_program_that_one_source_cannot_run_is_refused_with_its_error(repository):
    with worktree(repository, "quick") as base, pytest.raises(InvalidInput, match="ImportError"):
        raced("from little import absent", 1.1, base, repository, rounds=7)


def test_an_unknown_revision_is_refused_with_the_words_of_git(repository):
    with pytest.raises(InvalidInput, match="rev-parse"), worktree(repository, "no-such-revision"):
        pass


@pytest.mark.parametrize(("words", "said"), [(["no-such-revision"], "rev-parse"), (["HEAD", "nothing"], "no row")])
def test_an_unknown_revision_or_row_is_one_clear_line(words, said, capsys):
    assert main(words) == 4
    assert said in capsys.readouterr().err


@pytest.mark.slow
def test_a_slower_row_fails_and_a_row_that_the_revision_cannot_run_is_skipped(repository, monkeypatch, capsys):
    monkeypatch.setattr(race_module, "SOURCE", repository)
    monkeypatch.setattr(race_module, "PREPARED", "")
    monkeypatch.setattr(race_module, "ROWS", {"busy": (LITTLE, 1.1), "new": ("import newer", 1.1)})
    assert main(["quick"]) == 1
    told = capsys.readouterr().out
    assert "PERF: busy" in told
    assert "SKIP: new | ModuleNotFoundError" in told
    assert main(["quick", "new"]) == 0


@pytest.mark.slow
@pytest.mark.parametrize("row", ROWS)
def test_every_row_runs(row):
    program, _ = ROWS[row]
    sample = race_module.sampled(race_module.SOURCE, race_module.PREPARED + program, "")
    assert sample.seconds > 0
    assert np.all(np.isfinite(sample.answers))

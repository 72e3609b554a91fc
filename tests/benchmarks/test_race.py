"""Times of two versions: what the verdict does with them, and that each version really runs its own source."""

import dataclasses
import math
import sys

import numpy as np
import pytest

from benchmarks.race import __main__ as race_command
from benchmarks.race import race as race_module
from benchmarks.race import version
from benchmarks.race.__main__ import main, raced, subjects
from benchmarks.race.race import Race, judge_race, race
from benchmarks.race.version import Subject, Version, subject
from benchmarks.race.worktree import worktree
from cases.gate.write_permission import SOURCE, git
from cases.judgement.rules.judgement import nothing_compared
from cases.results.status import Status
from contact import InvalidInput
from tests.cases.fake_case import fake_case


def noise(seed, size):
    """CPU seconds of a busy machine: 4 % jitter, and now and then a cold cache."""
    draw = np.random.default_rng(seed)
    return 0.1 * np.exp(0.04 * draw.standard_normal(size)) * (1 + 0.3 * (draw.random(size) < 0.05))


def race_of(factor, seed, pairs=15):
    return Race(
        base=tuple(noise(seed, pairs)),
        head=tuple(factor * noise(seed + 1000, pairs)),
        again=tuple(noise(seed + 2000, pairs)),
    )


def test_identical_code_passes_and_a_slowdown_of_one_and_a_half_fails_in_59_of_60_races():
    same = [judge_race(race_of(1.0, seed)).status for seed in range(60)]
    slow = [judge_race(race_of(1.5, seed)).status for seed in range(60)]
    assert same.count(Status.PERF) == 0
    assert slow.count(Status.PERF) >= 59


def test_a_limit_inside_the_interval_warns():
    steady = Race(base=(1.0,) * 8, head=(1.0,) * 4 + (1.3,) * 4, again=(1.0,) * 8)
    assert judge_race(steady).status is Status.INCONCLUSIVE


def test_a_machine_that_shows_nothing_moves_the_limit():
    wild = Race(base=(1.0,) * 8, head=(1.5,) * 8, again=(1.3,) * 8)
    assert wild.null_spread == pytest.approx(math.log(1.3), rel=1e-12, abs=0.0)
    assert wild.limit == pytest.approx(1 + 3 * math.log(1.3), rel=1e-12, abs=0.0)
    assert judge_race(wild).status is Status.PASS
    assert "identical code differs by 26.2 %" in judge_race(wild).message


def test_a_nan_among_the_times_is_refused():
    with pytest.raises(InvalidInput, match="times"):
        judge_race(Race(base=(1.0,) * 8, head=(math.nan,) * 8, again=(1.0,) * 8))


# -- real processes on a little package called `contact`, in two revisions -----------------------------------------

LITTLE_CONTACT = """
import time
def scene_from_mapping(mapping):
    return mapping["repeats"]
class Busy:
    def __init__(self, fail=False):
        self.fail = fail
    def solve(self, repeats):
        print("noise that must not be taken for an answer")
        if self.fail:
            raise ZeroDivisionError("a slip")
        end = time.process_time() + REPEAT * 1e-3 * repeats
        while time.process_time() < end:
            pass
"""


@pytest.fixture
def short(monkeypatch):
    """Samples of 20 ms, so that the test is quick; the ratio is 1.5 all the same."""
    monkeypatch.setattr(race_module, "SHORTEST", 0.02)


@pytest.fixture(scope="module")
def repository(tmp_path_factory):
    """A repository whose first commit, `quick`, needs 10 ms, and whose working tree needs 15 ms."""
    folder = tmp_path_factory.mktemp("repository")
    (folder / "contact").mkdir()
    source = folder / "contact" / "__init__.py"
    source.write_text(LITTLE_CONTACT.replace("REPEAT", "1"), encoding="utf-8")
    git(folder, "init", "--quiet")
    git(folder, "add", "contact")
    git(folder, "-c", "user.name=t", "-c", "user.email=t@t", "commit", "--quiet", "-m", "first")
    git(folder, "tag", "quick")
    source.write_text(LITTLE_CONTACT.replace("REPEAT", "1.5"), encoding="utf-8")
    return folder


def busy(**settings):
    import base64
    import pickle

    order = base64.b64encode(pickle.dumps(({"repeats": 10}, "contact", "Busy", settings))).decode()
    return Subject(case="little", scene="busy", method="busy", order=order)


@pytest.mark.usefixtures("short")
def test_a_planted_slowdown_of_one_and_a_half_is_seen_in_real_processes(repository):
    with worktree(repository, "quick") as base, Version(base) as one, Version(repository) as head, Version(base) as two:
        finished = race([one, head, two], busy(), pairs=7)
    assert finished.measured.ratio == pytest.approx(1.5, rel=0.05, abs=0.0)
    assert judge_race(finished).status is Status.PERF


def test_the_worktree_is_gone_afterwards_also_after_an_error(repository):
    seen = []

    def look_and_fail(folder):
        seen.append((folder, (folder / "contact" / "__init__.py").is_file()))
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError), worktree(repository, "quick") as base:
        look_and_fail(base)
    (folder, was_there), *_ = seen
    assert was_there
    assert not folder.exists()
    assert len(git(repository, "worktree", "list").splitlines()) == 1


def test_an_unknown_revision_is_refused_with_the_words_of_git(repository):
    with pytest.raises(InvalidInput, match="rev-parse"), worktree(repository, "no-such-revision"):
        pass


def test_a_folder_without_the_project_is_refused(tmp_path):
    with pytest.raises(InvalidInput, match=r"no package `contact`|ended with code"):
        Version(tmp_path)


def test_an_error_in_one_version_names_subject_and_error(repository):
    with Version(repository) as head, pytest.raises(InvalidInput, match=r"little / busy / busy .* ZeroDivisionError"):
        head.seconds(busy(fail=True), 1)


def test_a_version_that_dies_is_no_endless_wait(repository, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/bin/false")
    with pytest.raises(InvalidInput, match="ended with code 1"):
        Version(repository)


def test_each_method_of_a_case_is_raced_on_the_first_scene_it_solves_in_the_suite_ci():
    case = fake_case()
    first, *others = case.scenes
    slow_later = dataclasses.replace(case, scenes=(dataclasses.replace(first, nightly=("slow",)), *others))
    assert [(s.case, s.scene, s.method) for s in subjects([case])] == [
        ("fake_hertz", "half-space nu=0.3", "fast"),
        ("fake_hertz", "half-space nu=0.3", "slow"),
    ]
    assert {s.method: s.scene for s in subjects([slow_later])} == {"fast": first.name, "slow": others[0].name}


@pytest.mark.usefixtures("short")
def test_a_slower_tree_ends_with_perf_and_what_the_revision_cannot_solve_is_skipped_with_its_words(repository):
    found = list(raced("quick", [busy(), busy(fail=True)], repository=repository, pairs=7))
    assert [judged.status for _, judged in found] == [Status.PERF, Status.SKIP]
    assert 0.4 < found[0][1].observed < 0.6
    assert "ZeroDivisionError" in found[1][1].message


@pytest.fixture
def fake_library(monkeypatch):
    monkeypatch.setattr(race_command, "load_cases", lambda: {"fake_hertz": fake_case()})


@pytest.mark.parametrize(
    ("statuses", "strict", "code"),
    [
        ((Status.PASS, Status.SKIP), False, 0),
        ((Status.PASS, Status.PERF), False, 1),
        ((Status.INCONCLUSIVE,), False, 0),
        ((Status.INCONCLUSIVE,), True, 1),
        ((Status.SKIP,), False, 5),
    ],
)
@pytest.mark.usefixtures("fake_library")
def test_the_exit_code_of_the_command(statuses, strict, code, monkeypatch, capsys):
    judged = [(busy(), nothing_compared(status, "as planted")) for status in statuses]
    monkeypatch.setattr(race_command, "raced", lambda *_, **__: iter(judged))
    assert main(["HEAD", *(["--strict"] if strict else [])]) == code
    assert f"{statuses[0]}: little / busy / busy: as planted" in capsys.readouterr().out


@pytest.mark.usefixtures("fake_library")
@pytest.mark.parametrize(("words", "said"), [(["no-such-revision"], "rev-parse"), (["HEAD", "nothing"], "nothing")])
def test_an_unknown_revision_or_case_is_one_clear_line(words, said, capsys):
    assert main(words) == 4
    assert said in capsys.readouterr().err


def test_a_subject_is_understood_without_the_library():
    case = fake_case()
    order = subject(case, case.scenes[0], case.methods[0]).order
    import base64
    import pickle

    mapping, module, attribute, settings = pickle.loads(base64.b64decode(order))
    assert mapping["indenter"]["kind"] == "paraboloid"
    assert (module, attribute, settings) == ("tests.cases.fake_method", "FakeHertz", {"stated": 1e-12})
    assert version.subject(case, case.scenes[0], case.methods[0]).label == "fake_hertz / half-space nu=0.3 / fast"


def test_the_source_that_is_raced_and_accepted_holds_every_package():
    packages = ("contact", "bem", "mdr", "fem_reference", "cases", "reports")
    assert [name for name in packages if not (SOURCE / name / "__init__.py").is_file()] == []

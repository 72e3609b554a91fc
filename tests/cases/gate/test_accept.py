"""Accepting: what it writes, what it shows, and everything it refuses."""

import dataclasses

import pytest

from cases.gate.accept import refusals, write_conditions
from cases.gate.baseline import read_baselines, relative_tolerance
from cases.run.stamp import git
from cases.verdicts import Kind, Status
from contact import InvalidInput
from tests.cases.example_run import PASSING, SCENE, example_stamp, fast, verdict
from tests.cases.gate.example_baselines import (
    NOW,
    accepted,
    clean_run,
    gated,
    proposal_of,
    scaled,
    with_answers,
    with_force,
)


def quantities(folder):
    """Accepted quantities by method, scene and name."""
    (baseline,) = read_baselines(folder)
    return {(a.method, a.scene, name): q for a in baseline.answers for name, q in a.quantities.items()}


def refused(folder, run=None, now=NOW, **how):
    run = run or clean_run()
    return refusals(proposal_of(run, folder, **how), run, now)


def test_one_file_per_case_with_one_answer_per_line_and_every_digit(tmp_path):
    accepted(tmp_path, with_force("mdr", scaled(1 / 3)))
    assert [path.name for path in tmp_path.iterdir()] == [f"{PASSING}.jsonl"]
    assert len((tmp_path / f"{PASSING}.jsonl").read_text(encoding="utf-8").splitlines()) == 1 + 4
    kept = quantities(tmp_path)
    assert kept["mdr", SCENE, "normal_force"].values == (0.5,)
    assert kept["mdr", SCENE, "indentation_depth"].values == fast(SCENE).quantities["indentation_depth"].values
    assert kept["mdr", SCENE, "pressure"].values == ()  # of a field the stated error alone


def test_a_quantity_keeps_unit_scale_error_and_spread_and_the_case_its_reason(tmp_path):
    accepted(tmp_path, reason="checked against Sneddon")
    q = quantities(tmp_path)["mdr", SCENE, "normal_force"]
    assert (q.unit, q.scale, q.error, q.spread) == ("N", 1.5, (1.5e-12,), 1e-10)
    assert relative_tolerance(q) == 1e-9  # ten times the spread
    (baseline,) = read_baselines(tmp_path)
    assert baseline.accepted.reason == "checked against Sneddon"
    assert {len(answer.question) for answer in baseline.answers} == {16}


def test_a_spread_of_zero_still_allows_1e_12(tmp_path):
    accepted(tmp_path, spread=0.0)
    assert {relative_tolerance(q) for q in quantities(tmp_path).values()} == {1e-12}


def test_a_change_is_shown_in_tolerances_and_in_uncertainty(tmp_path):
    accepted(tmp_path)
    run = with_force("mdr", scaled(1 + 1e-7))
    changes = proposal_of(run, tmp_path).changes
    assert {(c.method, c.quantity) for c in changes} == {("mdr", "normal_force")}
    change = changes[0]
    assert change.values == (1.5, 1.5 * (1 + 1e-7))
    assert change.in_tolerances == pytest.approx(100, rel=1e-3, abs=0.0)
    assert change.in_stated_errors == pytest.approx(1e5, rel=1e-3, abs=0.0)  # U is 1e-12 of the force


def test_accepting_the_same_again_changes_no_byte(tmp_path):
    accepted(tmp_path)
    before = {path: path.read_bytes() for path in tmp_path.rglob("*.json*")}
    accepted(tmp_path, reason="another reason")
    assert {path: path.read_bytes() for path in tmp_path.rglob("*.json*")} == before


def test_loosening_is_refused_without_the_flag_and_kept_with_its_reason(tmp_path):
    accepted(tmp_path)
    assert any("would grow from 1.0e-09 to 1.0e-06" in line for line in refused(tmp_path, spread=1e-7))
    with pytest.raises(InvalidInput, match="--loosen"):
        accepted(tmp_path, spread=1e-7)
    accepted(tmp_path, spread=1e-7, loosen=True, reason="another compiler")
    assert {relative_tolerance(q) for q in quantities(tmp_path).values() if not q.at} == {1e-6}


def test_a_larger_declared_scale_is_a_loosening_too(tmp_path):
    accepted(tmp_path)
    run = with_force("mdr", lambda quantity: dataclasses.replace(quantity, scale=15.0))
    assert any("tolerance of normal_force" in line for line in refused(tmp_path, run))


def test_a_smaller_value_of_the_same_scale_is_no_loosening(tmp_path):
    accepted(tmp_path)
    assert not refused(tmp_path, with_force("mdr", scaled(0.01)))


def test_withdrawing_a_record_or_a_counter_is_a_loosening(tmp_path):
    accepted(tmp_path)
    assert any("no longer be watched" in line for line in refused(tmp_path, with_force("mdr", lambda _: None)))
    uncounted = with_answers(lambda row: dataclasses.replace(row, counters={}))
    assert any("counter solves" in line for line in refused(tmp_path, uncounted))


def test_a_smaller_spread_leaves_the_tolerance_as_it_is(tmp_path):
    accepted(tmp_path)
    assert not proposal_of(clean_run(), tmp_path, spread=1e-14).changes


def test_a_solver_that_broke_down_is_refused(tmp_path):
    broken = dataclasses.replace(fast(SCENE), status=Status.INVALID, reason="value is nan", quantities={}, counters={})
    run = with_answers(lambda row: broken if (row.method, row.scene) == ("mdr", SCENE) else row)
    assert any("value is nan" in line for line in refused(tmp_path, run))


@pytest.mark.parametrize("kind", [Kind.EXACT, Kind.ORDER])
@pytest.mark.parametrize("status", [Status.FAIL, Status.INVALID, Status.TIMEOUT, Status.XPASS])
def test_a_failing_exact_or_order_claim_is_refused(tmp_path, kind, status):
    claim = dataclasses.replace(verdict(), case=PASSING, kind=kind, status=status)
    assert any("half-space force" in line for line in refused(tmp_path, clean_run(verdicts=(claim,))))


def test_a_passing_claim_and_a_regression_are_no_obstacle(tmp_path):
    accepted(tmp_path)
    run = gated(with_force("mdr", scaled(1 + 1e-7)), tmp_path)
    assert not refused(tmp_path, run)


@pytest.mark.parametrize(
    ("now", "message"),
    [
        (dataclasses.replace(NOW, in_ci=True), "continuous integration"),
        (dataclasses.replace(NOW, changed=("mdr/core.py",)), "mdr/core.py"),
        (dataclasses.replace(NOW, revision="1" * 40), "run again"),
    ],
)
def test_the_wrong_place_or_time_is_refused(tmp_path, now, message):
    assert any(message in line for line in refused(tmp_path, now=now))


def test_a_run_of_uncommitted_code_and_an_unfinished_one_are_refused(tmp_path):
    dirty = clean_run(stamp=dataclasses.replace(example_stamp(), dirty=True))
    assert any("uncommitted" in line for line in refused(tmp_path, dirty))
    assert any("interrupted" in line for line in refused(tmp_path, clean_run(complete=False)))


def test_no_reason_is_refused(tmp_path):
    assert any("reason" in line for line in refused(tmp_path, reason="  "))


@pytest.mark.parametrize(("value", "in_ci"), [("true", True), ("1", True), ("", False), ("false", False)])
def test_continuous_integration_is_known_by_its_variable(tmp_path, value, in_ci):
    repository(tmp_path)
    assert write_conditions(tmp_path, tmp_path / "baselines", {"CI": value}).in_ci is in_ci


def test_changed_and_new_files_are_seen_but_not_the_baselines_being_written(tmp_path):
    repository(tmp_path)
    folder = tmp_path / "baselines"
    assert write_conditions(tmp_path, folder, {}).changed == ()
    folder.mkdir()
    (folder / f"{PASSING}.jsonl").write_text("{}", encoding="utf-8")
    assert write_conditions(tmp_path, folder, {}).changed == ()
    (tmp_path / "new.py").write_text("x = 1\n", encoding="utf-8")
    (tmp_path / "tracked.py").write_text("x = 2\n", encoding="utf-8")
    assert set(write_conditions(tmp_path, folder, {}).changed) == {"new.py", "tracked.py"}


def test_outside_a_repository_nothing_can_be_accepted(tmp_path):
    with pytest.raises(InvalidInput, match="git"):
        write_conditions(tmp_path, tmp_path / "baselines", {})


def repository(folder):
    (folder / "tracked.py").write_text("x = 1\n", encoding="utf-8")
    git(folder, "init", "--quiet")
    git(folder, "add", "tracked.py")
    git(folder, "-c", "user.name=t", "-c", "user.email=t@t", "commit", "--quiet", "-m", "first")


def test_a_claim_is_withdrawn_only_when_told_so(tmp_path):
    less = clean_run(verdicts=())
    accepted(tmp_path)
    with pytest.raises(InvalidInput, match="claim 'force agrees' about normal_force by mdr and fem would no longer be"):
        accepted(tmp_path, less)
    accepted(tmp_path, less, loosen=True)
    assert not any(baseline.accepted.claims for baseline in read_baselines(tmp_path))

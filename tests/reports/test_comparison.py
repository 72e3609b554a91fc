"""The page of two runs: what got worse is said first, and a run against itself is all equal."""

import dataclasses

import pytest

from cases.answers import NAME, Table
from cases.runs import RUN, Run, write_run
from cases.verdicts import Status
from reports.commands.runs import compare_runs, report
from reports.comparison import changed_claims, changed_numbers, headline, worst_first
from tests.cases.example_run import PASSING, example, only
from tests.reports.test_pages import not_a_number, words_of


@pytest.fixture
def runs(tmp_path):
    """A run, and a later one in which a passing claim fails."""
    run = only(PASSING)
    first, *others = run.judged.verdicts
    failed = dataclasses.replace(first, status=Status.FAIL, fraction=7.0)
    for name, verdicts in (("first", (first, *others)), ("second", (failed, *others))):
        write_run(dataclasses.replace(run.judged, verdicts=verdicts), tmp_path / name)
        (tmp_path / name / NAME).write_text("".join(answer.line() for answer in run.answers), encoding="utf-8")
    return tmp_path / "first", tmp_path / "second"


def test_a_run_against_itself_is_all_equal():
    run = example()
    claims, numbers = changed_claims(run, run), changed_numbers(run, run)
    assert headline(claims, numbers) == ("all 10 numbers identical", "good")
    assert worst_first(claims + numbers) == []


def test_a_number_that_moved_beyond_the_stated_errors_is_told_from_one_within():
    run = example()
    first, *others = run.answers
    force = first.quantities["normal_force"]
    for move, status in ((0.5, Status.PASS), (3.0, Status.DIFF)):
        values = (force.values[0] + move * force.error[0],)
        moved = dataclasses.replace(first, quantities={"normal_force": dataclasses.replace(force, values=values)})
        found = changed_numbers(run, Run(judged=run.judged, answers=Table([moved, *others])))
        assert [v.status for v in found if v.quantity == "normal_force" and v.error] == [status]
        assert Status.INCOMPARABLE in {v.status for v in found if v.quantity == "indentation_depth"}


def test_what_got_worse_is_the_headline(runs, capsys):
    compare_runs(*runs)
    page = (runs[1] / "comparison.html").read_text(encoding="utf-8")
    assert "1 check got worse; all 8 numbers identical" in words_of(page)
    assert "force agrees" in capsys.readouterr().out
    assert not not_a_number(page)


@pytest.mark.slow
def test_pages_are_rebuilt_from_stored_results_without_a_change(runs, capsys):
    first, _ = runs
    report(first)
    written = {path: path.read_bytes() for path in first.rglob("*") if path.is_file()}
    report(first)
    assert {path: path.read_bytes() for path in first.rglob("*") if path.is_file()} == written
    assert {"report.html", "summary.md", "junit.xml", RUN} <= {path.name for path in written}
    assert "PASSED: all 3 checks" in capsys.readouterr().out

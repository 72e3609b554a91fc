"""The page of two runs: what got worse is said first, and a run against itself is all equal."""

import dataclasses

import pytest

from cases.results.compare_runs import compare
from cases.results.files import write_run
from cases.results.status import Status
from reports.commands.runs import compare_runs, rebuild
from reports.pages.comparison import headline
from tests.cases.example_run import example_run, passing_case
from tests.reports.test_pages import not_a_number, words_of


@pytest.fixture
def runs(tmp_path):
    """A run, and a later one in which a passing claim fails."""
    case = passing_case()
    failed = dataclasses.replace(case.claims[0], status=Status.FAIL, fraction=7.0)
    worse = dataclasses.replace(case, claims=(failed, *case.claims[1:]))
    for name, cases in (("first", (case,)), ("second", (worse,))):
        write_run(dataclasses.replace(example_run(), cases=cases), tmp_path / name)
    return tmp_path / "first", tmp_path / "second"


def test_a_run_against_itself_is_all_equal():
    words, tone = headline(compare(example_run(), example_run()))
    assert (words, tone) == ("all 10 numbers identical", "good")


def test_what_got_worse_is_the_headline(runs, capsys):
    compare_runs(*runs)
    page = (runs[1] / "comparison.html").read_text(encoding="utf-8")
    assert "1 check got worse; all 8 numbers identical" in words_of(page)
    assert "force agrees" in capsys.readouterr().out
    assert not not_a_number(page)


def test_pages_are_rebuilt_from_stored_results_without_a_change(runs, capsys):
    first, _ = runs
    rebuild(first)
    written = {path: path.read_bytes() for path in first.rglob("*") if path.is_file()}
    rebuild(first)
    assert {path: path.read_bytes() for path in first.rglob("*") if path.is_file()} == written
    assert {"report.html", "summary.md", "junit.xml", "results.json"} <= {path.name for path in written}
    assert "PASSED: all 3 checks" in capsys.readouterr().out

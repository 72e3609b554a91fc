"""A suite's report contains quick studies of stability and code verification, and they pass."""

import dataclasses

import pytest

from cases.measurements import suites as studies
from cases.measurements.ladders import ladder_study
from cases.measurements.ladders.ladder_table import LADDERS
from cases.results.files import read_run
from cases.results.records.reliability import Ladder
from cases.run.executors import SerialExecutor, serial
from cases.run.runner import RunOptions, run_cases
from tests.cases.example_run import example_run
from tests.cases.fake_case import fake_case

# The claims of `code_verification` are judged by tests/verification/test_fem_code_verification.py, too.
SLOW = dict.fromkeys((studies.quick_ladders, studies.code_verification), pytest.mark.slow)


@pytest.mark.parametrize(
    "study", [pytest.param(s, marks=SLOW.get(s, ())) for s in studies.QUICK], ids=lambda study: study.__name__
)
def test_quick_studies_pass(study):
    found = study()
    assert not found.status.is_failure, [claim.message for claim in found.claims if claim.status.is_failure]
    assert found.claims or found.ladders


def test_an_interrupt_keeps_the_run_and_says_that_it_is_incomplete(tmp_path, monkeypatch):
    def interrupted():
        raise KeyboardInterrupt

    monkeypatch.setattr(studies, "QUICK", (interrupted,))
    run = studies.SuiteStudies("ci", serial, 1).join(example_run(), tmp_path)
    assert (run.complete, run.cases) == (False, example_run().cases)
    assert read_run(tmp_path) == run


def test_studies_join_a_finished_run(tmp_path, monkeypatch):
    monkeypatch.setattr(studies, "QUICK", (lambda: dataclasses.replace(example_run().cases[0], name="a study"),))
    run = studies.SuiteStudies("ci", serial, 1).join(example_run(), tmp_path)
    assert [case.name for case in run.cases[len(example_run().cases) :]] == ["a study"]
    assert read_run(tmp_path) == run


def test_studies_begin_when_all_is_solved_and_before_anything_is_judged(tmp_path, monkeypatch):
    """Seen to fail: claims and figures were judged first, on one core."""
    events, judged = [], example_run().cases[0]
    monkeypatch.setattr(studies, "QUICK", (lambda: events.append("study") or judged,))
    options = RunOptions(out=tmp_path, executor=serial, progress=lambda event: events.append(event.kind))
    with studies.SuiteStudies("ci", lambda jobs: SerialExecutor(), 1) as begun:
        run = run_cases([fake_case()], dataclasses.replace(options, solved=begun.begin))
        whole = begun.join(run, tmp_path)
    assert events[-3:] == ["finished", "study", "judged"]
    assert whole.cases == (*run.cases, judged)


def test_the_nightly_suite_walks_all_ladders_by_all_methods(tmp_path, monkeypatch):
    def glanced_at(plan, method, label):
        return Ladder(name=plan.name, parameter="p", unit="1", method=label, quantity=plan.quantity, rungs=())

    monkeypatch.setattr(studies, "NIGHTLY", (studies.all_ladders,))
    monkeypatch.setattr(ladder_study, "climb", glanced_at)
    nightly = dataclasses.replace(example_run(), suite="nightly")
    case = studies.SuiteStudies("nightly", serial, 1).join(nightly, tmp_path).cases[-1]
    assert {ladder.name for ladder in case.ladders} == {plan.name for plan in LADDERS}
    assert {ladder.method for ladder in case.ladders} == set(ladder_study.CLIMBERS)

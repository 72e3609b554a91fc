"""A suite's report contains quick studies of stability and code verification, and they pass."""

import dataclasses

import pytest

from cases.measurements import suites as studies
from cases.measurements.ladders import ladder_study
from cases.measurements.ladders.ladder_table import LADDERS
from cases.run.executors import SerialExecutor, serial
from cases.run.runner import RunOptions, run_cases
from cases.runs import Part, read_run
from cases.studies import StressTest
from tests.cases.example_run import example_run
from tests.cases.fake_case import fake_case

# The claims of `code_verification` are judged by tests/verification/test_fem_code_verification.py, too.
SLOW = dict.fromkeys((studies.quick_ladders, studies.code_verification), pytest.mark.slow)


@pytest.mark.parametrize(
    "study", [pytest.param(s, marks=SLOW.get(s, ())) for s in studies.QUICK], ids=lambda study: study.__name__
)
def test_quick_studies_pass(study):
    found = study()
    assert [verdict.message for verdict in found.verdicts if verdict.status.is_failure] == []
    assert found.verdicts or found.stress_tests


def part(name="a study"):
    text = dataclasses.replace(example_run().judged.cases[0], name=name)
    return Part(text=text, verdicts=())


def test_an_interrupt_keeps_the_run_and_says_that_it_is_incomplete(tmp_path, monkeypatch):
    def interrupted():
        raise KeyboardInterrupt

    monkeypatch.setattr(studies, "QUICK", (interrupted,))
    run = studies.SuiteStudies("ci", serial, 1).join(example_run(), tmp_path)
    assert (run.judged.complete, run.judged.cases) == (False, example_run().judged.cases)
    assert read_run(tmp_path).judged == run.judged


def test_studies_join_a_finished_run(tmp_path, monkeypatch):
    monkeypatch.setattr(studies, "QUICK", (part,))
    run = studies.SuiteStudies("ci", serial, 1).join(example_run(), tmp_path)
    assert [case.name for case in run.judged.cases[len(example_run().judged.cases) :]] == ["a study"]
    assert read_run(tmp_path).judged == run.judged


def test_studies_begin_when_all_is_solved_and_before_anything_is_judged(tmp_path, monkeypatch):
    events = []
    monkeypatch.setattr(studies, "QUICK", (lambda: events.append("study") or part(),))
    options = RunOptions(out=tmp_path, executor=serial, progress=lambda event: events.append(event.kind))
    with studies.SuiteStudies("ci", lambda jobs: SerialExecutor(), 1) as begun:
        run = run_cases([fake_case()], dataclasses.replace(options, solved=begun.begin))
        whole = begun.join(run, tmp_path)
    assert events[-3:] == ["finished", "study", "judged"]
    assert whole.judged.cases == (*run.judged.cases, part().text)


def test_the_nightly_suite_walks_all_ladders_by_all_methods(tmp_path, monkeypatch):
    def glanced_at(plan, method, label):
        words = {"parameter": "p", "unit": "1", "quantity": plan.quantity}
        return StressTest(case="stability", name=plan.name, method=label, steps=(), **words)

    monkeypatch.setattr(studies, "NIGHTLY", (studies.all_ladders,))
    monkeypatch.setattr(ladder_study, "climb", glanced_at)
    tests = studies.SuiteStudies("nightly", serial, 1).join(example_run(), tmp_path).judged.stress_tests
    tests = [test for test in tests if test.case == "stability"]
    assert {test.name for test in tests} == {plan.name for plan in LADDERS}
    assert {test.method for test in tests} == set(ladder_study.CLIMBERS)

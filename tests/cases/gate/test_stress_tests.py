"""Stress tests in the gate: a lost step, a lost digit, a test that nobody accepted."""

import dataclasses

import pytest

from cases.studies import Step, StressTest
from cases.verdicts import Status
from contact import InvalidInput
from tests.cases.example_run import PASSING
from tests.cases.gate.example_baselines import accepted, clean_run, gated, regressions


def stress_test(*digits, method="mdr"):
    steps = tuple(
        Step(value=10.0**-k, status="INVALID", reason="NotConvergedError: x", digits=None)
        if d is None
        else Step(value=10.0**-k, status="PASS", digits=d)
        for k, d in enumerate(digits)
    )
    return StressTest(
        case=PASSING, name="walk", parameter="p", unit="1", method=method, quantity="normal_force", steps=steps
    )


def verdicts(tests, folder):
    result = gated(clean_run(stress_tests=tests), folder)
    return [verdict for verdict in regressions(result) if verdict.claim == "accepted steps and digits"]


@pytest.fixture
def folder(tmp_path):
    return accepted(tmp_path, clean_run(stress_tests=(stress_test(14.0, 12.0, None),)))


@pytest.mark.parametrize(
    ("digits", "status"),
    [
        ((14.0, 12.0, None), Status.PASS),
        ((13.1, 11.2, None), Status.PASS),  # repeats that share less than a digit less
        ((14.0, 12.0, 9.0), Status.PASS),  # one step further
        ((14.0, None, None), Status.DIFF),
        ((14.0, 10.9, None), Status.DIFF),
        ((14.0,), Status.DIFF),  # a step that is no longer taken
    ],
)
def test_no_step_and_no_more_than_one_digit_may_be_lost(folder, digits, status):
    (verdict,) = verdicts((stress_test(*digits),), folder)
    assert verdict.status is status


def test_a_test_nobody_accepted_fails_by_its_name(folder):
    verdict = verdicts((stress_test(14.0, method="fem"),), folder)[0]
    assert (verdict.status, verdict.methods) == (Status.INCOMPARABLE, ("fem",))
    assert "never accepted" in verdict.message


def test_a_test_that_its_method_no_longer_takes_fails_by_its_name(folder):
    both = (stress_test(14.0, 12.0, None), stress_test(9.0, method="fem"))
    accepted(folder, clean_run(stress_tests=both))
    other = dataclasses.replace(stress_test(9.0, method="fem"), name="another walk")
    lost = [v for v in verdicts((stress_test(14.0, 12.0), other), folder) if (v.scene, v.methods) == ("walk", ("fem",))]
    assert [(verdict.status, verdict.message) for verdict in lost] == [
        (Status.DIFF, "walk, fem, p = 1: not solved, but 9.0 digits were accepted")
    ]
    assert [v.scene for v in verdicts((stress_test(14.0, 12.0),), folder)] == ["walk"]  # finite elements were not asked


def test_losing_a_step_is_accepted_only_when_told_to(folder):
    worse = clean_run(stress_tests=(stress_test(14.0, None, None),))
    with pytest.raises(InvalidInput, match=r"12\.0 digits were accepted"):
        accepted(folder, worse)
    accepted(folder, worse, loosen=True)
    assert {v.status for v in verdicts(worse.judged.stress_tests, folder)} == {Status.PASS}

import pytest

from cases.verdicts import ExitCode, Status, exit_code, worst


def test_nothing_ran_is_not_a_pass():
    assert exit_code([]) is ExitCode.NOTHING_RAN
    assert exit_code([Status.SKIP]) is ExitCode.NOTHING_RAN


@pytest.mark.parametrize("status", [Status.FAIL, Status.DIFF, Status.PERF, Status.INVALID, Status.INCOMPARABLE])
def test_one_failure_fails_the_gate(status):
    assert exit_code([Status.PASS, status]) is ExitCode.GATE_FAILED


def test_an_unexpected_pass_and_a_timeout_fail():
    assert exit_code([Status.PASS, Status.XPASS]) is ExitCode.GATE_FAILED
    assert exit_code([Status.PASS, Status.TIMEOUT]) is ExitCode.GATE_FAILED


def test_inconclusive_warns_and_has_an_exit_code_of_its_own_under_strict():
    assert exit_code([Status.PASS, Status.INCONCLUSIVE]) is ExitCode.PASSED
    assert exit_code([Status.PASS, Status.INCONCLUSIVE], strict=True) is ExitCode.UNDECIDED
    assert exit_code([Status.FAIL, Status.INCONCLUSIVE], strict=True) is ExitCode.GATE_FAILED
    assert exit_code([Status.PASS], strict=True) is ExitCode.PASSED


def test_skips_and_declared_failures_pass():
    assert exit_code([Status.PASS, Status.SKIP, Status.XFAIL]) is ExitCode.PASSED


def test_the_worst_status_decides():
    assert worst([Status.PASS, Status.SKIP]) is Status.PASS
    assert worst([Status.PASS, Status.INCONCLUSIVE, Status.FAIL]) is Status.FAIL
    assert worst([]) is Status.SKIP


def test_every_status_has_a_rank():
    assert {worst([status]) for status in Status} == set(Status)

"""A method of an installed package that hangs, crashes or leaves: a row that names it, and the run goes on."""

import pytest

from cases.foreign import against
from cases.run import runner
from cases.run.executors import serial
from cases.run.runner import FOREIGN_TIME_LIMIT, RunOptions, run_cases
from cases.verdicts import Status
from tests.cases.fake_case import fake_case
from tests.cases.fake_method import FakeHertz


class Hanging(FakeHertz):
    """Computes without end."""

    def solve(self, scene):
        while True:
            pass


class Leaving(FakeHertz):
    """Takes the whole program with it."""

    def solve(self, scene):
        raise SystemExit("licence not found")


@pytest.fixture
def rows(install, monkeypatch, tmp_path):
    """Rows of a registered class beside the case's fast method."""

    def rows(kind, default=0.5, **options):
        monkeypatch.setattr(runner, "FOREIGN_TIME_LIMIT", default)
        install({"mine": f"{__name__}:{kind.__name__}"})
        cases = against([fake_case()], ["mine"], ["fast"])
        result = run_cases(cases, RunOptions(out=tmp_path, executor=serial, **options))
        own = result.answers.of_case("fake_hertz")
        return {method: [answer for answer in own if answer.method == method] for method in ("mine", "fast")}

    return rows


@pytest.mark.slow
def test_a_hang_ends_by_default_after_five_minutes_and_is_named(rows):
    """Here the default is half a second; that another limit may be given is seen in `test_runner`."""
    assert FOREIGN_TIME_LIMIT == 300.0
    found = rows(Hanging)
    assert {(row.status, row.reason) for row in found["mine"]} == {(Status.TIMEOUT, "mine: not finished after 0.5 s")}
    assert {row.status for row in found["fast"]} == {Status.PASS}


def test_leaving_the_program_is_a_crash_that_is_named(rows):
    found = rows(Leaving, default=60.0)
    assert {(row.status, row.reason) for row in found["mine"]} == {
        (Status.INVALID, "mine crashed: SystemExit: licence not found")
    }
    assert {row.status for row in found["fast"]} == {Status.PASS}

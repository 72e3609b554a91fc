"""Plug-ins that are wrong, or that answer nothing: none of them passes, whatever they state of themselves."""

import dataclasses
from typing import ClassVar

import pytest

from cases.runs import read_run
from cases.verdicts import Kind, Status
from contact import Unsupported
from mdr import Mdr
from reports.command_line import run


@dataclasses.dataclass(frozen=True)
class Wrong:
    """MDR with its force times a factor, and with one stated error for all quantities."""

    name: ClassVar[str] = "mine"
    factor: ClassVar[float] = 1.0
    stated: ClassVar[float] = 1e-9

    def supports(self, scene):
        return Mdr().supports(scene)

    def solve(self, scene):
        answer = Mdr().solve(scene)
        stated = dict.fromkeys(answer.error_estimate, self.stated)
        return dataclasses.replace(answer, normal_force=self.factor * answer.normal_force, error_estimate=stated)

    def refined(self):
        return self


class TenTimes(Wrong):
    factor = 10.0
    stated = 0.9


class Overconfident(Wrong):
    factor = 1.002
    claimed_accuracy = 1e-9


class Refusing(Wrong):
    def supports(self, scene):
        return Unsupported("nothing is modelled")


@pytest.fixture
def run_with(install, monkeypatch, tmp_path):
    def run_with(kind, *arguments):
        install({"mine": f"{__name__}:{kind.__name__}"})
        # Pages are not what is tested here.
        monkeypatch.setattr("reports.commands.runs.write_pages", lambda *_: None)
        out = ("--no-timing", "--executor", "serial", "--time-limit", "0", "--quiet", "--out", str(tmp_path))
        return run(["run", *arguments, *out]), read_run(tmp_path)

    return run_with


def comparisons(result):
    """Claims that compare the force of "mine" with another value."""
    return [
        claim
        for claim in result.judged.verdicts
        if "mine" in claim.methods and claim.quantity == "normal_force" and claim.kind in (Kind.EXACT, Kind.AGREEMENT)
        if claim.status is not Status.SKIP
    ]


@pytest.mark.slow
def test_a_force_ten_times_too_large_fails_everywhere_although_it_states_90_percent(run_with):
    code, result = run_with(TenTimes, "round_and_worn_tips", "--method", "mine")
    assert code == 1
    assert len(comparisons(result)) > 5
    assert {claim.status for claim in comparisons(result)} == {Status.FAIL}


def test_a_method_that_claims_1e_9_and_is_2e_3_wrong_fails(run_with):
    code, result = run_with(Overconfident, "round_and_worn_tips", "--method", "mine")
    assert code == 1
    assert {claim.status for claim in comparisons(result)} == {Status.FAIL}
    assert all("explain" in claim.message or "does not cover" in claim.message for claim in comparisons(result))


@pytest.mark.first(1)
@pytest.mark.parametrize("beside", [(), ("--method", "mdr")])
def test_a_method_that_solves_nothing_did_not_run(run_with, beside, capsys):
    code, result = run_with(Refusing, "paraboloid", "--method", "mine", *beside)
    assert code == 5
    told = capsys.readouterr().out
    assert "PASS" not in told
    assert "mine" in told
    assert {a.status for a in result.answers if a.method == "mine" and not a.variant} == {Status.SKIP}
    # There is nothing to compare, so that the reference solves nothing.
    assert beside or {a.method for a in result.answers} == {"mine"}

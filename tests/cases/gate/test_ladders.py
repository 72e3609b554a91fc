"""Ladders in the gate: a lost rung, a lost digit, a ladder nobody accepted, and a file edited by hand."""

import dataclasses

import pytest

from cases.gate.gate import gate
from cases.gate.ladders import accept_ladders, read_ladders
from cases.results.records.claim import Kind
from cases.results.records.reliability import Ladder, Rung
from cases.results.status import Status
from contact import InvalidInput
from tests.cases.example_run import example_run, passing_case


def ladder(*digits, method="mdr"):
    rungs = tuple(
        Rung(value=10.0**-k, status=Status.INVALID, reason="NotConvergedError: x", digits=None)
        if d is None
        else Rung(value=10.0**-k, status=Status.PASS, digits=d)
        for k, d in enumerate(digits)
    )
    return Ladder(name="walk", parameter="p", unit="1", method=method, quantity="normal_force", rungs=rungs)


def claims(walked, folder):
    case = dataclasses.replace(passing_case(), ladders=walked, claims=())
    run = dataclasses.replace(example_run(), cases=(case,))
    gated = gate(run, (), read_ladders(folder))
    return [c for c in gated.cases[0].claims if c.kind is Kind.REGRESSION and c.name == "accepted rungs and digits"]


@pytest.fixture
def folder(tmp_path):
    accept_ladders(tmp_path, [ladder(14.0, 12.0, None)])
    return tmp_path


@pytest.mark.parametrize(
    ("digits", "status"),
    [
        ((14.0, 12.0, None), Status.PASS),
        ((13.1, 11.2, None), Status.PASS),  # repeats that share less than a digit less
        ((14.0, 12.0, 9.0), Status.PASS),  # one rung further
        ((14.0, None, None), Status.DIFF),
        ((14.0, 10.9, None), Status.DIFF),
        ((14.0,), Status.DIFF),  # a rung that is no longer walked
    ],
)
def test_no_rung_and_no_more_than_one_digit_may_be_lost(folder, digits, status):
    (claim,) = claims((ladder(*digits),), folder)
    assert claim.status is status


def test_a_ladder_nobody_accepted_fails_by_its_name(folder):
    (claim,) = claims((ladder(14.0, method="fem"),), folder)
    assert (claim.status, claim.methods) == (Status.INCOMPARABLE, ("fem",))
    assert "never accepted" in claim.message


def test_a_ladder_that_its_method_no_longer_climbs_fails_by_its_name(folder):
    accept_ladders(folder, [ladder(9.0, method="fem")])
    other = dataclasses.replace(ladder(9.0, method="fem"), name="another walk")
    lost = [c for c in claims((ladder(14.0, 12.0), other), folder) if (c.scene, c.methods) == ("walk", ("fem",))]
    assert [(claim.status, claim.message) for claim in lost] == [
        (Status.DIFF, "walk, fem, p = 1: not walked, but 9.0 digits were accepted")
    ]
    assert [c.scene for c in claims((ladder(14.0, 12.0),), folder)] == ["walk"]  # finite elements were not asked


def test_losing_a_rung_is_accepted_only_when_told_to(folder):
    worse = [ladder(14.0, None, None)]
    with pytest.raises(InvalidInput, match=r"12\.0 digits were accepted"):
        accept_ladders(folder, worse)
    assert read_ladders(folder)[0].rungs[1].digits == 12.0
    accept_ladders(folder, worse, loosen=True)
    assert read_ladders(folder)[0].rungs[1].digits is None


def test_other_ladders_of_the_method_stay_as_they_were(folder):
    accept_ladders(folder, [dataclasses.replace(ladder(9.0), name="another walk")])
    assert {found.name for found in read_ladders(folder)} == {"walk", "another walk"}


def test_a_damaged_file_is_refused(folder):
    path = folder / "ladders-mdr.json"
    path.write_text(path.read_text(encoding="utf-8").replace("12.0", "NaN"), encoding="utf-8")
    with pytest.raises(InvalidInput, match="non-finite"):
        read_ladders(folder)

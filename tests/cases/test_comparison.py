"""Two runs side by side: every change of a number, a claim or a time is found, and none is invented."""

import dataclasses

import pytest

from cases.results.compare_runs import ChangeKind, compare
from cases.results.status import Status
from tests.cases.example_run import OTHER_SCENE, example_run, fast_run, passing_case, slow_run


def with_case(case):
    return dataclasses.replace(example_run(), cases=(case,))


def with_force(run, factor, uncertainty=None):
    depth, force = run.quantities
    changed = dataclasses.replace(force, values=tuple(factor * value for value in force.values))
    if uncertainty is not None:
        changed = dataclasses.replace(changed, uncertainty=uncertainty)
    return dataclasses.replace(run, quantities=(depth, changed))


def pair(one, two):
    case = passing_case()
    return compare(with_case(dataclasses.replace(case, runs=(one,))), with_case(dataclasses.replace(case, runs=(two,))))


def test_a_run_against_itself_has_no_change():
    result = compare(example_run(), example_run())
    assert {number.change for number in result.numbers} == {ChangeKind.IDENTICAL}
    assert not result.claims
    assert not result.missing
    assert {time.ratio for time in result.times} == {1.0}


@pytest.mark.parametrize(
    ("factor", "change"), [(1 + 1e-13, ChangeKind.WITHIN), (1 + 1e-11, ChangeKind.BEYOND), (2.0, ChangeKind.BEYOND)]
)
def test_a_changed_number_is_measured_against_both_uncertainties(factor, change):
    one = fast_run("scene")
    _, force = pair(one, with_force(one, factor)).numbers
    assert force.change is change
    assert force.difference == pytest.approx(factor - 1, rel=1e-3, abs=0.0)
    assert force.uncertainty == pytest.approx(2**0.5 * 1e-12, rel=1e-12, abs=0.0)  # two equal uncertainties of 1e-12


def test_a_method_without_uncertainty_gives_no_verdict():
    one = fast_run("scene")
    _, force = pair(one, with_force(one, 1.1, uncertainty=())).numbers
    assert force.change is ChangeKind.UNKNOWN


def test_other_units_or_lengths_are_not_compared():
    one = fast_run("scene")
    depth, force = one.quantities
    other = dataclasses.replace(one, quantities=(depth, dataclasses.replace(force, unit="kN")))
    assert pair(one, other).numbers[1].change is ChangeKind.INCOMPARABLE
    longer = dataclasses.replace(force, values=(1.0, 2.0), uncertainty=())
    assert pair(one, dataclasses.replace(one, quantities=(depth, longer))).numbers[1].change is ChangeKind.INCOMPARABLE


def test_two_methods_are_compared_where_each_run_has_one():
    numbers = pair(fast_run("scene"), slow_run("scene")).numbers
    assert [number.methods for number in numbers] == [("mdr", "fem")] * 2
    assert [number.change for number in numbers] == [ChangeKind.WITHIN] * 2


def test_missing_solutions_and_claims_are_named():
    case = passing_case()
    fewer = dataclasses.replace(case, runs=case.runs[:-1], claims=case.claims[:-1])
    result = compare(with_case(case), with_case(fewer))
    assert result.missing == (f"example_cone / {OTHER_SCENE} by fem",)
    assert result.claims[0].statuses == (Status.PASS, None)
    none_left = dataclasses.replace(case, runs=case.runs[:2])
    assert len(compare(with_case(case), with_case(none_left)).missing) == 2


def test_a_claim_that_ends_otherwise_is_listed_with_both_ends():
    case = passing_case()
    failed = dataclasses.replace(case.claims[0], status=Status.FAIL, fraction=7.0)
    result = compare(with_case(case), with_case(dataclasses.replace(case, claims=(failed, *case.claims[1:]))))
    assert [(c.claim, c.statuses, c.fractions) for c in result.claims] == [
        (failed.name, (Status.PASS, Status.FAIL), (0.14, 7.0))
    ]

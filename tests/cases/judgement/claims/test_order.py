"""Orders of a fabricated method: several grids a refinement, references of another method, quantities that share."""

import dataclasses

import pytest

from cases.declare.methods import MethodUse
from cases.declare.task import Answers
from cases.judgement.claims.order import Order
from cases.results.status import Status
from cases.run.solve_task import solve
from contact import InvalidInput
from tests.cases.fake_case import REASON, fake_case


def order(**changes):
    ladder = tuple({"cell": 0.1 / 2**level} for level in range(3))
    fields = {"name": "first order", "quantity": "normal_force", "method": "slow", "ladder": ladder}
    return Order(formal_order=1.0, mesh_family="uniform", tolerance=0.2, reason=REASON, **(fields | changes))


def judged(claim, case):
    case = dataclasses.replace(case, claims=(claim,))
    answers = Answers({task.identity: solve(task, "key") for task in case.tasks()})
    return list(claim.judge(case, answers)), list(claim.studies(case, answers))


@pytest.mark.parametrize("against", ["fast", MethodUse(label="finest", method="fake", settings={"stated": 1e-12})])
def test_errors_are_taken_against_another_method(against):
    claims, studies = judged(order(against=against), fake_case())
    assert {claim.status for claim in claims} == {Status.PASS}
    assert all(study.reference is not None and study.grids[0].error > 0 for study in studies)
    assert studies[0].reference_source == ("fast" if against == "fast" else "finest")
    assert studies[0].grids[0].stated is not None


def test_a_method_with_the_wrong_order_is_caught_against_a_reference():
    claims, _ = judged(dataclasses.replace(order(against="fast"), formal_order=2.0), fake_case())
    assert {claim.status for claim in claims} == {Status.FAIL}


def test_the_grids_of_one_refinement_count_by_their_root_mean_square():
    pairs = tuple(({"cell": 0.1 / 2**level}, {"cell": 0.11 / 2**level}) for level in range(3))
    claims, (study, _) = judged(order(ladder=pairs, against="fast"), fake_case())
    _, (single, _) = judged(order(against="fast"), fake_case())
    assert {claim.status for claim in claims} == {Status.PASS}
    assert single.grids[0].error < study.grids[0].error < 1.1 * single.grids[0].error


def test_claims_about_two_quantities_share_their_grids():
    case = fake_case()
    first, second = order(), order(name="depth", quantity="indentation_depth")
    assert {t.identity for t in first.tasks(case)} == {t.identity for t in second.tasks(case)}


def test_an_unknown_method_of_reference_is_refused():
    with pytest.raises(InvalidInput, match="'fats'"):
        dataclasses.replace(fake_case(), claims=(order(against="fats"),))


def test_a_field_counts_by_the_root_mean_square_over_its_points():
    """Its last point alone had no quantity of that name: KeyError."""
    claims, (study, _) = judged(order(quantity="pressure", against="fast"), fake_case())
    assert {claim.status for claim in claims} == {Status.PASS}
    values = [grid.value for grid in study.grids]
    assert study.reference == pytest.approx(values[0], rel=0.1, abs=0)
    errors = [abs(value - study.reference) for value in values]
    # All points of this method err by the same share.
    assert [grid.error for grid in study.grids] == pytest.approx(errors, rel=1e-9, abs=0)

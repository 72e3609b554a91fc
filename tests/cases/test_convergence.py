"""Observed orders. Oracles: Celik et al. 2008, J. Fluids Eng. 130, 078001, sample calculations; NASA NPARC tutorial."""

import dataclasses
import math

import pytest

from cases.answers import Table
from cases.convergence import Order, behaviour, digits_per_refinement, grid_convergence_index, observed_order
from cases.declare.methods import MethodUse
from cases.run.solve_task import job_of, solve
from cases.verdicts import Status
from contact import InvalidInput
from tests.cases.fake_case import WHY, fake_case

NASA = (0.97050, 0.96854, 0.96178)


def lengths_of(cells: tuple[int, ...]) -> list[float]:
    """Cell sizes of two-dimensional grids."""
    return [n**-0.5 for n in cells]


@pytest.mark.parametrize(
    ("cells", "values", "order", "gci_percent"),
    [
        ((18000, 8000, 4500), (6.063, 5.972, 5.863), 1.534, 2.17),
        ((18000, 4500, 980), (10.788, 10.725, 10.605), 0.752, 1.07),
        ((18000, 4500, 980), (6.0042, 5.9624, 6.0909), 1.508, 0.47),  # oscillatory
    ],
)
def test_celik_et_al_table(cells, values, order, gci_percent):
    lengths = lengths_of(cells)
    p = observed_order(values, lengths)
    gci = grid_convergence_index(values[0], values[1], lengths[1] / lengths[0], p, p, scale=0.0)
    assert p == pytest.approx(order, abs=5e-4)
    assert 100 * gci == pytest.approx(gci_percent, abs=5e-3)


def test_nasa_tutorial():
    p = observed_order(NASA, (1, 2, 4))
    assert p == pytest.approx(1.78617, abs=1e-5)
    fine, coarse = (grid_convergence_index(*NASA[i : i + 2], 2, p, p, scale=0.0) for i in (0, 1))
    assert 100 * fine == pytest.approx(0.10308, abs=1e-5)
    assert 100 * coarse == pytest.approx(0.35625, abs=2e-5)


@pytest.mark.parametrize(
    ("values", "lengths", "message"),
    [
        ((1.0, 1.0, 2.0), (1, 2, 4), "different"),
        ((1.0, math.nan, 2.0), (1, 2, 4), "finite"),
        ((1.0, math.inf, 2.0), (1, 2, 4), "finite"),
        (NASA, (4, 2, 1), "finest first"),
    ],
)
def test_values_without_an_order_are_refused(values, lengths, message):
    with pytest.raises(InvalidInput, match=message):
        observed_order(values, lengths)


@pytest.mark.parametrize(
    ("observed", "safety", "order"), [(1.95, 1.25, 2.0), (1.7, 3.0, 1.7), (0.2, 3.0, 0.5), (3.0, 3.0, 2.0)]
)
def test_safety_factor_trusts_the_formal_order_only_within_ten_percent(observed, safety, order):
    found = grid_convergence_index(1.0, 1.1, 2.0, observed, 2.0, scale=0.0)
    assert found == pytest.approx(safety * 0.1 / (2.0**order - 1), rel=1e-12, abs=0.0)


def test_growing_differences_have_a_negative_order():
    """With the modulus of the textbook formula this diverging sequence would be reported as second order."""
    assert observed_order((1.0, 5.0, 6.0), (1, 2, 4)) == pytest.approx(-2.0, rel=1e-12, abs=0.0)


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ((1.0, 1.1, 1.3), "monotone"),
        ((1.0, 0.9, 0.7), "monotone"),
        ((1.0, 1.1, 0.7), "oscillatory"),
        ((1.0, 1.3, 1.4), "divergent"),
        ((1.0, 1.3, 1.2), "divergent"),
        ((1.0, 1.0 + 1e-15, 1.1), "floor"),
        ((1.0, 1.0, 1.0), "floor"),
        ((1.0, 1.1), "too-few"),
        ((), "too-few"),
    ],
)
def test_classes(values, expected):
    assert behaviour(values, 1e-15) == expected


def test_nan_is_invalid_and_no_class():
    with pytest.raises(InvalidInput, match="finite"):
        behaviour((1.0, math.nan, 1.2), 1e-15)
    with pytest.raises(InvalidInput, match="finite"):
        digits_per_refinement((math.nan, 1e-3), 1e-15)


@pytest.mark.parametrize(
    ("errors", "digits"),
    [
        ((1e-9, 1e-6, 1e-3), 3.0),
        # The fifth and sixth grid show round-off only; counting them would dilute the rate.
        ((2e-15, 1e-15, 1e-12, 1e-8, 1e-4), 11 / 3),
        ([h**2 for h in (1 / 16, 1 / 8, 1 / 4, 1 / 2)], math.log10(4)),
        ((1e-15, 1e-15), None),
    ],
)
def test_spectral_convergence_counts_digits_down_to_the_floor(errors, digits):
    assert digits_per_refinement(errors, 1e-15) == (digits and pytest.approx(digits, rel=1e-12, abs=0.0))


def order(**changes):
    ladder = tuple({"cell": 0.1 / 2**level} for level in range(3))
    fields = {"name": "first order", "quantity": "normal_force", "method": "slow", "ladder": ladder}
    return Order(formal_order=1.0, mesh_family="uniform", tolerance=0.2, why=WHY, **(fields | changes))


def judged(claim, case):
    case = dataclasses.replace(case, claims=(claim,))
    answers = Table(solve(job_of(task)) for task in case.tasks())
    return list(claim.judge(case, answers)), list(claim.records(case, answers))


@pytest.mark.parametrize("against", ["fast", MethodUse(label="finest", method="fake", settings={"stated": 1e-12})])
def test_errors_are_taken_against_another_method(against):
    verdicts, studies = judged(order(against=against), fake_case())
    assert {verdict.status for verdict in verdicts} == {Status.PASS}
    assert all(study.reference is not None and study.grids[0].error > 0 for study in studies)
    assert studies[0].source == ("fast" if against == "fast" else "finest")
    assert studies[0].grids[0].stated is not None


def test_without_a_reference_the_grids_themselves_show_order_and_error():
    verdicts, (study, _) = judged(order(), fake_case())
    assert {verdict.status for verdict in verdicts} == {Status.PASS}
    assert study.reference is None
    assert [grid.error is None for grid in study.grids] == [False, False, True]


def test_a_method_with_the_wrong_order_is_caught_against_a_reference():
    verdicts, _ = judged(dataclasses.replace(order(against="fast"), formal_order=2.0), fake_case())
    assert {verdict.status for verdict in verdicts} == {Status.FAIL}


def test_the_grids_of_one_refinement_count_by_their_root_mean_square():
    pairs = tuple(({"cell": 0.1 / 2**level}, {"cell": 0.11 / 2**level}) for level in range(3))
    verdicts, (study, _) = judged(order(ladder=pairs, against="fast"), fake_case())
    _, (single, _) = judged(order(against="fast"), fake_case())
    assert {verdict.status for verdict in verdicts} == {Status.PASS}
    assert single.grids[0].error < study.grids[0].error < 1.1 * single.grids[0].error


def test_an_unknown_method_of_reference_is_refused():
    with pytest.raises(InvalidInput, match="'fats'"):
        dataclasses.replace(fake_case(), claims=(order(against="fats"),))


def test_a_field_counts_by_the_root_mean_square_over_its_points():
    verdicts, (study, _) = judged(order(quantity="pressure", against="fast"), fake_case())
    assert {verdict.status for verdict in verdicts} == {Status.PASS}
    values = [grid.value for grid in study.grids]
    assert study.reference == pytest.approx(values[0], rel=0.1, abs=0)
    errors = [abs(value - study.reference) for value in values]
    # All points of this method err by the same share.
    assert [grid.error for grid in study.grids] == pytest.approx(errors, rel=1e-9, abs=0)

"""The rules behind a verdict: each way to be wrong is seen to fail."""

import math

import pytest

from cases.rules import (
    judge_agreement,
    judge_exact,
    judge_order,
    judge_regression,
    judge_residual,
    nothing_compared,
    relative_spread,
    worst_judgement,
)
from cases.verdicts import Status
from contact import InvalidInput

TOLERANCE = 1e-5


def agreement(difference, u_fast, u_reference):
    return judge_agreement(difference, {"mdr": u_fast, "fem": u_reference}, tolerance=TOLERANCE).status


@pytest.mark.parametrize(
    ("difference", "u", "expected"),
    [
        (4e-6, 3e-6, Status.PASS),
        (-4e-6, 3e-6, Status.PASS),
        (2e-5, 3e-6, Status.FAIL),
        (-2e-5, 3e-6, Status.FAIL),
        (9e-6, 3e-6, Status.INCONCLUSIVE),
        (1.1e-5, 3e-6, Status.INCONCLUSIVE),
        (0.0, 2e-5, Status.INCONCLUSIVE),
        (2e-5, 2e-5, Status.INCONCLUSIVE),
        (1.0, 2e-5, Status.FAIL),
        (5.9, 0.35, Status.FAIL),
    ],
)
def test_agreement_judges_disagreement_first(difference, u, expected):
    assert agreement(difference, 0.0, u) is expected


@pytest.mark.parametrize(("stated", "coarser"), [((1e-12, 2e-5), "fem"), ((3e-5, 1e-6), "mdr")])
def test_inconclusive_names_the_coarser_method(stated, coarser):
    judged = judge_agreement(0.0, dict(zip(("mdr", "fem"), stated, strict=True)), tolerance=TOLERANCE)
    assert f"refine {coarser}" in judged.message


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_non_finite_number_is_invalid_whichever_side(bad):
    assert {agreement(bad, 0.0, 1e-6), agreement(0.0, bad, 1e-6), agreement(0.0, 0.0, bad)} == {Status.INVALID}


def test_a_negative_stated_error_is_invalid():
    assert agreement(0.0, 0.0, -1e-6) is Status.INVALID


def exact(value, tolerance=1e-10, stated=0.0):
    return judge_exact(value, 1.0, scale=1.0, tolerance=tolerance, stated=stated).status


def test_exact_passes_within_and_fails_beyond():
    assert exact(1.0 + 5e-11) is Status.PASS
    assert exact(1.0 + 2e-10) is Status.FAIL
    assert exact(1.0 - 2e-10) is Status.FAIL


def test_an_error_that_the_method_states_itself_is_inconclusive_and_one_beyond_that_fails():
    assert exact(1.0 + 2e-6, 1e-6, 1.5e-6) is Status.INCONCLUSIVE
    assert exact(1.0 + 2e-6, 1e-6, 0.5e-6) is Status.FAIL
    assert exact(1.0 + 0.9e-6, 1e-6, 1.0) is Status.PASS


def test_exact_near_zero_uses_the_declared_scale():
    assert judge_exact(1e-13, 0.0, scale=1.0, tolerance=1e-12).status is Status.PASS


@pytest.mark.parametrize(
    ("value", "expected"), [(math.nan, 1.0), (1.0, math.nan), (math.nan, math.nan), (math.inf, math.inf)]
)
def test_non_finite_is_invalid_and_never_equal_to_itself(value, expected):
    assert judge_exact(value, expected, scale=1.0, tolerance=1e-10).status is Status.INVALID
    assert judge_regression(value, expected, permitted=1e-10).status is Status.INVALID


@pytest.mark.parametrize("tolerance", [0.0, -1e-10, math.nan, math.inf])
def test_a_tolerance_of_the_wrong_sign_is_refused(tolerance):
    with pytest.raises(InvalidInput, match="positive"):
        exact(1.0, tolerance)
    with pytest.raises(InvalidInput, match="positive"):
        judge_residual(0.0, tolerance=tolerance)
    with pytest.raises(InvalidInput, match="positive"):
        judge_agreement(0.0, {"mdr": 0.0, "fem": 0.0}, tolerance=tolerance)


@pytest.mark.parametrize("observed", [0.8, 1.0, 1.02, 1.5])
def test_orders_inside_the_band_pass(observed):
    assert judge_order(observed, 1.0, "monotone").status is Status.PASS


@pytest.mark.parametrize("observed", [math.nan, math.inf, 75.9, 0.79, 1.51, -1.0, None])
def test_orders_outside_the_band_fail(observed):
    assert judge_order(observed, 1.0, "monotone").status is Status.FAIL


def test_a_divergent_sequence_fails_even_with_a_number_inside_the_band():
    assert judge_order(1.0, 1.0, "divergent").status is Status.FAIL
    assert judge_order(None, 1.0, "divergent").status is Status.FAIL


def test_a_sequence_at_the_floor_is_inconclusive():
    assert judge_order(None, 1.0, "floor").status is Status.INCONCLUSIVE
    assert judge_order(1.0, 1.0, "too-few").status is Status.INCONCLUSIVE


def test_the_worst_judgement_decides_and_an_empty_claim_is_refused():
    good, bad = judge_residual(1.0, tolerance=2.0), judge_residual(3.0, tolerance=2.0)
    assert worst_judgement([good, bad, good]) is bad
    assert worst_judgement([good, nothing_compared(Status.INVALID, "")]).status is Status.INVALID
    with pytest.raises(InvalidInput, match="nothing"):
        worst_judgement([])


def test_a_spread_is_half_the_range_over_the_larger_of_values_and_scale():
    assert relative_spread([1.0, 1.2], 0.5) == pytest.approx(0.1 / 1.2, rel=1e-12, abs=0.0)
    assert relative_spread([0.0, 1e-3], 1.0) == pytest.approx(5e-4, rel=1e-12, abs=0.0)
    assert relative_spread([0.0, 0.0], 0.0) == 0.0

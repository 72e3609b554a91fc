"""The rules behind a verdict: each way to be wrong is seen to fail."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cases.gate.gate import permitted_count_change
from cases.rules import (
    judge_agreement,
    judge_digits,
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


def test_stated_errors_add_in_squares():
    judged = judge_agreement(0.0, {"mdr": 3e-6, "fem": 4e-6}, tolerance=TOLERANCE)
    assert judged.fraction == pytest.approx(0.5, rel=1e-12, abs=0.0)


@pytest.mark.parametrize(("stated", "coarser"), [((1e-12, 2e-5), "fem"), ((3e-5, 1e-6), "mdr")])
def test_inconclusive_names_the_coarser_method(stated, coarser):
    judged = judge_agreement(0.0, dict(zip(("mdr", "fem"), stated, strict=True)), tolerance=TOLERANCE)
    assert f"refine {coarser}" in judged.message


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_non_finite_number_is_invalid_whichever_side(bad):
    assert {agreement(bad, 0.0, 1e-6), agreement(0.0, bad, 1e-6), agreement(0.0, 0.0, bad)} == {Status.INVALID}


def test_a_negative_stated_error_is_invalid():
    assert agreement(0.0, 0.0, -1e-6) is Status.INVALID


def test_planted_factors_disagree():
    """A factor 2, E for E* at nu = 0.3, a dropped 2 pi: none is within a tolerance of 1e-5."""
    for factor in (2.0, 1 - 0.3**2, 2 * math.pi):
        assert agreement(factor - 1, 1e-12, 1e-6) is Status.FAIL


@given(st.floats(-1e-4, 1e-4), st.floats(0, 1e-5), st.floats(0, 1e-5))
def test_agree_means_the_worst_case_is_within_tolerance(difference, u_fast, u_reference):
    agreed = agreement(difference, u_fast, u_reference) is Status.PASS
    assert agreed == (abs(difference) + math.hypot(u_fast, u_reference) <= TOLERANCE)


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


def test_residual():
    assert judge_residual(-1e-9, tolerance=1e-8).status is Status.PASS
    assert judge_residual(-2e-8, tolerance=1e-8).status is Status.FAIL
    assert judge_residual(math.nan, tolerance=1e-8).status is Status.INVALID


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


def test_digits():
    assert judge_digits(3.0, 2.0).status is Status.PASS
    assert judge_digits(0.6, 2.0).status is Status.FAIL
    assert judge_digits(-1.0, 2.0).status is Status.FAIL


def test_counters_are_hard():
    assert permitted_count_change("unknowns", 1000) == 20
    assert permitted_count_change("iterations", 10) == 3
    assert permitted_count_change("iterations", 100) == 20


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

import math

import pytest

from cases.judgement.rules.exact import judge_exact
from cases.judgement.rules.invariant import judge_invariant
from cases.judgement.rules.judgement import nothing_compared, passed_or_failed, worst_judgement
from cases.judgement.rules.order import judge_digits, judge_order
from cases.judgement.rules.regression import judge_counter, judge_regression
from cases.results.records.claim import Verdict
from cases.results.records.convergence import ConvergenceClass
from cases.results.status import Status
from contact import InvalidInput


def test_exact_passes_within_and_fails_beyond():
    assert judge_exact(1.0 + 5e-11, 1.0, scale=1.0, tolerance=1e-10).status is Status.PASS
    assert judge_exact(1.0 + 2e-10, 1.0, scale=1.0, tolerance=1e-10).status is Status.FAIL
    assert judge_exact(1.0 - 2e-10, 1.0, scale=1.0, tolerance=1e-10).status is Status.FAIL


def test_an_error_that_the_method_states_itself_is_inconclusive_and_one_beyond_that_fails():
    judged = judge_exact(1.0 + 2e-6, 1.0, scale=1.0, tolerance=1e-6, uncertainty=1.5e-6)
    assert (judged.status, judged.verdict) == (Status.INCONCLUSIVE, Verdict.INCONCLUSIVE)
    assert judge_exact(1.0 + 2e-6, 1.0, scale=1.0, tolerance=1e-6, uncertainty=0.5e-6).status is Status.FAIL
    assert judge_exact(1.0 + 0.9e-6, 1.0, scale=1.0, tolerance=1e-6, uncertainty=1.0).status is Status.PASS


def test_exact_near_zero_uses_the_declared_scale():
    assert judge_exact(1e-13, 0.0, scale=1.0, tolerance=1e-12).status is Status.PASS


@pytest.mark.parametrize(
    ("value", "expected"), [(math.nan, 1.0), (1.0, math.nan), (math.nan, math.nan), (math.inf, math.inf)]
)
def test_non_finite_is_invalid_and_never_equal_to_itself(value, expected):
    assert judge_exact(value, expected, scale=1.0, tolerance=1e-10).status is Status.INVALID
    assert judge_regression(value, expected, scale=1.0, rtol=1e-10).status is Status.INVALID


@pytest.mark.parametrize("tolerance", [0.0, -1e-10, math.nan, math.inf])
def test_a_tolerance_of_the_wrong_sign_is_refused(tolerance):
    with pytest.raises(InvalidInput, match="positive"):
        judge_exact(1.0, 1.0, scale=1.0, tolerance=tolerance)
    with pytest.raises(InvalidInput, match="positive"):
        judge_invariant(0.0, tolerance=tolerance)
    with pytest.raises(InvalidInput, match="positive"):
        judge_regression(1.0, 1.0, scale=1.0, rtol=tolerance)


def test_invariant():
    assert judge_invariant(-1e-9, tolerance=1e-8).status is Status.PASS
    assert judge_invariant(-2e-8, tolerance=1e-8).status is Status.FAIL
    assert judge_invariant(math.nan, tolerance=1e-8).status is Status.INVALID


def test_order_band():
    assert judge_order(1.02, 1.0, ConvergenceClass.MONOTONE).status is Status.PASS
    assert judge_order(0.79, 1.0, ConvergenceClass.MONOTONE).status is Status.FAIL
    assert judge_order(75.9, 1.0, ConvergenceClass.MONOTONE).status is Status.FAIL
    assert judge_order(math.nan, 1.0, ConvergenceClass.MONOTONE).status is Status.FAIL


def test_a_divergent_sequence_fails_even_with_a_number_inside_the_band():
    assert judge_order(1.0, 1.0, ConvergenceClass.DIVERGENT).status is Status.FAIL
    assert judge_order(None, 1.0, ConvergenceClass.DIVERGENT).status is Status.FAIL


def test_a_sequence_at_the_floor_is_inconclusive():
    assert judge_order(None, 1.0, ConvergenceClass.FLOOR).status is Status.INCONCLUSIVE
    assert judge_order(1.0, 1.0, ConvergenceClass.TOO_FEW).status is Status.INCONCLUSIVE


def test_digits():
    assert judge_digits(3.0, 2.0).verdict is Verdict.PASS
    assert judge_digits(0.6, 2.0).verdict is Verdict.FAIL
    assert judge_digits(-1.0, 2.0).verdict is Verdict.FAIL


def test_regression_rule_uses_the_larger_of_value_and_scale():
    assert judge_regression(1.0 + 1e-7, 1.0, scale=1.0, rtol=1e-9).status is Status.DIFF
    assert judge_regression(1.0 + 1e-10, 1.0, scale=1.0, rtol=1e-9).status is Status.PASS
    assert judge_regression(1e-10, 0.0, scale=1.0, rtol=1e-9).status is Status.PASS
    assert judge_regression(1e-10, 0.0, scale=1e-3, rtol=1e-9).status is Status.DIFF


def test_counters_are_hard():
    assert judge_counter("unknowns", 1021, 1000).status is Status.DIFF
    assert judge_counter("unknowns", 1020, 1000).status is Status.PASS
    assert judge_counter("iterations", 13, 10).status is Status.PASS
    assert judge_counter("iterations", 14, 10).status is Status.DIFF
    assert judge_counter("iterations", 120, 100).status is Status.PASS
    assert judge_counter("iterations", 121, 100).status is Status.DIFF
    assert judge_counter("factorisations", 1, 5).status is Status.DIFF


def test_the_worst_judgement_decides_and_an_empty_claim_is_refused():
    good, bad = passed_or_failed(1.0, 2.0, ""), passed_or_failed(3.0, 2.0, "")
    assert worst_judgement([good, bad, good]) is bad
    assert worst_judgement([good, nothing_compared(Status.INVALID, "")]).status is Status.INVALID
    with pytest.raises(InvalidInput, match="nothing"):
        worst_judgement([])

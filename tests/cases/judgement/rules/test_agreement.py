import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cases.judgement.rules.agreement import judge_agreement
from cases.results.records.claim import Verdict
from cases.results.status import Status
from contact import InvalidInput

TOLERANCE = 1e-5


def verdict(difference, u_fast, u_reference, **options):
    judged = judge_agreement(difference, {"mdr": u_fast, "fem": u_reference}, tolerance=TOLERANCE, **options)
    return judged.verdict, judged.status


@pytest.mark.parametrize(
    ("difference", "u", "expected"),
    [
        (4e-6, 3e-6, (Verdict.AGREE, Status.PASS)),
        (-4e-6, 3e-6, (Verdict.AGREE, Status.PASS)),
        (2e-5, 3e-6, (Verdict.DISAGREE, Status.FAIL)),
        (-2e-5, 3e-6, (Verdict.DISAGREE, Status.FAIL)),
        (9e-6, 3e-6, (Verdict.INCONCLUSIVE, Status.INCONCLUSIVE)),
        (1.1e-5, 3e-6, (Verdict.INCONCLUSIVE, Status.INCONCLUSIVE)),
        (0.0, 2e-5, (Verdict.INCONCLUSIVE, Status.INCONCLUSIVE)),
        (2e-5, 2e-5, (Verdict.INCONCLUSIVE, Status.INCONCLUSIVE)),
        (1.0, 2e-5, (Verdict.DISAGREE, Status.FAIL)),
        (5.9, 0.35, (Verdict.DISAGREE, Status.FAIL)),
    ],
)
def test_verdicts(difference, u, expected):
    assert verdict(difference, 0.0, u) == expected


def test_uncertainties_add_in_squares():
    judged = judge_agreement(0.0, {"mdr": 3e-6, "fem": 4e-6}, tolerance=TOLERANCE)
    assert judged.fraction == pytest.approx(0.5, rel=1e-12, abs=0.0)


def test_inconclusive_names_the_coarser_method():
    judged = judge_agreement(0.0, {"mdr": 1e-12, "fem": 2e-5}, tolerance=TOLERANCE)
    assert "refine fem" in judged.message
    judged = judge_agreement(0.0, {"mdr": 3e-5, "fem": 1e-6}, tolerance=TOLERANCE)
    assert "refine mdr" in judged.message


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_non_finite_number_is_invalid_whichever_side(bad):
    assert verdict(bad, 0.0, 1e-6) == (Verdict.NONE, Status.INVALID)
    assert verdict(0.0, bad, 1e-6) == (Verdict.NONE, Status.INVALID)
    assert verdict(0.0, 0.0, bad) == (Verdict.NONE, Status.INVALID)


def test_a_negative_uncertainty_is_invalid():
    assert verdict(0.0, 0.0, -1e-6) == (Verdict.NONE, Status.INVALID)


@pytest.mark.parametrize("tolerance", [-1e-5, 0.0, math.nan, math.inf])
def test_a_tolerance_of_the_wrong_sign_is_refused(tolerance):
    with pytest.raises(InvalidInput, match="tolerance must be positive"):
        judge_agreement(0.0, {"mdr": 0.0, "fem": 0.0}, tolerance=tolerance)


def test_a_declared_model_gap_is_no_disagreement():
    assert verdict(2e-3, 0.0, 1e-6)[0] is Verdict.DISAGREE
    assert verdict(2e-3, 0.0, 1e-6, model_gap=2e-3)[0] is Verdict.AGREE
    assert verdict(-2e-3, 0.0, 1e-6, model_gap=2e-3)[0] is Verdict.DISAGREE


def test_planted_factors_disagree():
    """A factor 2, E for E* at nu = 0.3, a dropped 2 pi: none is within a tolerance of 1e-5."""
    for factor in (2.0, 1 - 0.3**2, 2 * math.pi):
        assert verdict(factor - 1, 1e-12, 1e-6)[0] is Verdict.DISAGREE


@given(st.floats(-1e-4, 1e-4), st.floats(0, 1e-5), st.floats(0, 1e-5))
def test_agree_means_the_worst_case_is_within_tolerance(difference, u_fast, u_reference):
    agreed = verdict(difference, u_fast, u_reference)[0] is Verdict.AGREE
    assert agreed == (abs(difference) + math.hypot(u_fast, u_reference) <= TOLERANCE)

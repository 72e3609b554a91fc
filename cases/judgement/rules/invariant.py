"""A law of the mechanics: its residual must vanish to within what round-off and discretisation allow."""

from cases.judgement.rules.judgement import Judgement, passed_or_failed
from cases.judgement.rules.tolerance import positive_tolerance


def judge_invariant(residual: float, *, tolerance: float) -> Judgement:
    """Judge |residual| <= tolerance, both relative."""
    positive_tolerance(tolerance)
    return passed_or_failed(residual, tolerance, f"relative residual {residual:.1e}, tolerance {tolerance:.0e}")

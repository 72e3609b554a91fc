"""A number against a closed form or the literature."""

import math

from cases.judgement.rules.judgement import Judgement, nothing_compared, passed_or_failed
from cases.judgement.rules.tolerance import positive_tolerance
from cases.results.status import Status


def judge_exact(value: float, expected: float, *, scale: float, tolerance: float) -> Judgement:
    """Judge |value - expected| / max(|expected|, scale) <= tolerance."""
    positive_tolerance(tolerance)
    if not (math.isfinite(value) and math.isfinite(expected)):
        return nothing_compared(Status.INVALID, f"value {value}, expected {expected}: both must be finite")
    size = max(abs(expected), scale)
    error = (value - expected) / size
    message = f"{value:.10g} against {expected:.10g}: relative error {error:.1e}, tolerance {tolerance:.0e}"
    return passed_or_failed(error, tolerance, message)

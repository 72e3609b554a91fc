"""A number against a closed form or the literature."""

import math

from cases.judgement.rules.judgement import Judgement, nothing_compared, passed_or_failed
from cases.judgement.rules.tolerance import positive_tolerance
from cases.results.status import Status


def judge_exact(
    value: float, expected: float, *, scale: float, tolerance: float, uncertainty: float = 0.0
) -> Judgement:
    """Judge |value - expected| / max(|expected|, scale) <= tolerance.

    The tolerance is a requirement. An error beyond it that the method's own ``uncertainty`` (absolute) explains is
    inconclusive: the method says itself that it is too coarse to be judged. The uncertainty is relative to the larger
    of the two values, so that a value that is too large does not widen its own uncertainty.
    """
    positive_tolerance(tolerance)
    if not (math.isfinite(value) and math.isfinite(expected)):
        return nothing_compared(Status.INVALID, f"value {value}, expected {expected}: both must be finite")
    size = max(abs(expected), scale)
    error = (value - expected) / size
    message = f"{value:.10g} against {expected:.10g}: relative error {error:.1e}, tolerance {tolerance:.0e}"
    stated = uncertainty / max(abs(value), size)
    explained = tolerance < abs(error) <= tolerance + stated
    if explained:
        message += f"; stated error {stated:.1e}: refine"
    elif abs(error) > stated > 0:
        message += f"; the stated error {stated:.1e} does not cover it"
    return passed_or_failed(error, tolerance, message, Status.INCONCLUSIVE if explained else Status.FAIL)

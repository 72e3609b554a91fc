"""A number against its own accepted earlier value; regression only, never called verification."""

import math

from cases.judgement.rules.judgement import Judgement, decided, nothing_compared
from cases.judgement.rules.tolerance import permitted_difference
from cases.results.status import Status


def judge_regression(value: float, baseline: float, *, scale: float, rtol: float, atol: float = 0.0) -> Judgement:
    """Judge |value - baseline| <= max(rtol max(|baseline|, scale), atol); non-finite on either side is INVALID."""
    if not (math.isfinite(value) and math.isfinite(baseline)):
        return nothing_compared(Status.INVALID, f"value {value}, baseline {baseline}: both must be finite")
    permitted = permitted_difference(baseline, scale=scale, rtol=rtol, atol=atol)
    change = value - baseline
    good = abs(change) <= permitted
    message = f"{value:.17g} against accepted {baseline:.17g}: change {change:+.1e}, permitted {permitted:.1e}"
    fraction = abs(change) / permitted if permitted > 0 else 0.0 if good else math.inf
    return decided(good, value, fraction, message, Status.DIFF)


def judge_counter(name: str, value: int, baseline: int) -> Judgement:
    """Judge a deterministic counter: unknowns within 2 %, others within max(3, 20 %)."""
    permitted = permitted_count_change(name, baseline)
    change = abs(value - baseline)
    message = f"{name} {value} against accepted {baseline}, permitted change {permitted:g}"
    fraction = change / permitted if permitted > 0 else float(change)
    return decided(change <= permitted, float(value), fraction, message, Status.DIFF)


def permitted_count_change(name: str, baseline: int) -> float:
    """Return the largest change of a counter that counts as equal."""
    return 0.02 * baseline if name == "unknowns" else max(3.0, 0.2 * baseline)

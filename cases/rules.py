"""The rules behind a verdict: one for errors, one for orders, one for regressions."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from cases.verdicts import Status, worst
from contact import InvalidInput

# Smallest relative tolerance of accepted numbers, 4500 times the unit roundoff 2.2e-16: another order of a sum of some
# thousand terms is no change.
SMALLEST_RELATIVE = 1e-12


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """How a comparison ended.

    Attributes:
        status: Result of the comparison.
        error: Signed error; None if nothing was compared.
        fraction: Error over tolerance; None if nothing was compared.
        uncertainty: Error that each method states, by its label, same unit as the error.
        message: Result in one sentence.
    """

    status: Status
    error: float | None = None
    fraction: float | None = None
    uncertainty: Mapping[str, float] = field(default_factory=dict)
    message: str


def nothing_compared(status: Status, message: str) -> Judgement:
    """Return the judgement of a comparison that could not be made, with the reason."""
    return Judgement(status=status, message=message)


def decided(good: bool, error: float, fraction: float, message: str, failure: Status = Status.FAIL) -> Judgement:
    """Return the judgement of a comparison that passes or ends with ``failure``."""
    return Judgement(status=Status.PASS if good else failure, error=error, fraction=fraction, message=message)


def compared(error: float, stated: float, tolerance: float, *, strict: bool = False) -> Status:
    """Return PASS if |E| (+ u, if strict) <= tol, FAIL if |E| - u > tol, else INCONCLUSIVE.

    Args:
        error: E, signed, relative.
        stated: u, the error that the methods state, relative, not negative.
        tolerance: Requirement, fixed beforehand.
        strict: Whether u counts against a pass, as between two methods.
    """
    positive_tolerance(tolerance)
    if not (math.isfinite(error) and math.isfinite(stated) and stated >= 0):
        return Status.INVALID
    if abs(error) + (stated if strict else 0.0) <= tolerance:
        return Status.PASS
    return Status.FAIL if abs(error) - stated > tolerance else Status.INCONCLUSIVE


def judge_exact(value: float, expected: float, *, scale: float, tolerance: float, stated: float = 0.0) -> Judgement:
    """Judge |value - expected| / max(|expected|, scale) <= tolerance.

    A larger error is inconclusive if the absolute ``stated`` error explains it. The stated error is divided by the
    larger of the two values, so that a value that is too large does not widen its own error.
    """
    if not (math.isfinite(value) and math.isfinite(expected)):
        return nothing_compared(Status.INVALID, f"value {value}, expected {expected}: both must be finite")
    size = max(abs(expected), scale)
    error, stated_relative = (value - expected) / size, stated / max(abs(value), size)
    status = compared(error, stated_relative, tolerance)
    message = f"{value:.10g} against {expected:.10g}: relative error {error:.1e}, tolerance {tolerance:.0e}"
    if status is Status.INCONCLUSIVE:
        message += f"; stated error {stated_relative:.1e}: refine"
    elif abs(error) > stated_relative > 0:
        message += f"; the stated error {stated_relative:.1e} does not cover it"
    return Judgement(status=status, error=error, fraction=abs(error) / tolerance, message=message)


def judge_agreement(difference: float, stated: Mapping[str, float], *, tolerance: float) -> Judgement:
    """Judge a signed relative difference of two methods with the error that each states, by its label."""
    u = math.hypot(*stated.values()) if stated else 0.0
    status = compared(difference, u, tolerance, strict=True)
    if status is Status.INVALID or any(error < 0 for error in stated.values()):
        return nothing_compared(Status.INVALID, f"difference {difference} with stated errors {dict(stated)}")
    message = f"relative difference {difference:+.1e}, uncertainty {u:.1e}, tolerance {tolerance:.0e}"
    if status is Status.INCONCLUSIVE:
        message += f"; refine {max(stated, key=lambda label: stated[label])}"
    if abs(difference) > u:
        message += "; more than the methods' own uncertainties explain"
    fraction = (abs(difference) + u) / tolerance
    return Judgement(status=status, error=difference, fraction=fraction, uncertainty=stated, message=message)


def judge_residual(residual: float, *, tolerance: float, failure: Status = Status.FAIL) -> Judgement:
    """Judge |residual| <= tolerance, both relative."""
    status, message = compared(residual, 0.0, tolerance), f"relative residual {residual:.1e}, tolerance {tolerance:.0e}"
    if status is Status.INVALID:
        return nothing_compared(status, f"the error is {residual}: {message}")
    return decided(status is Status.PASS, residual, abs(residual) / tolerance, message, failure)


def judge_order(observed: float | None, formal: float, kind: str) -> Judgement:
    """Judge formal - 0.2 <= observed <= formal + 0.5; divergence fails, a sequence at the floor is inconclusive."""
    no_order = kind in ("floor", "too-few")
    if no_order or observed is None:
        status = Status.INCONCLUSIVE if no_order else Status.FAIL
        return nothing_compared(status, f"the sequence is {kind}: it has no order; formal order {formal:g}")
    if not math.isfinite(observed):
        return nothing_compared(Status.FAIL, f"observed order {observed}, formal order {formal:g}, {kind}")
    fraction = (formal - observed) / 0.2 if observed < formal else (observed - formal) / 0.5
    message = f"observed order {observed:.3f}, formal order {formal:g}, {kind}"
    good = formal - 0.2 <= observed <= formal + 0.5 and kind != "divergent"
    return decided(good, observed, fraction, message)


def judge_digits(digits: float, least: float) -> Judgement:
    """Judge spectral convergence: at least ``least`` digits per refinement."""
    fraction = least / digits if digits > least / 100 else 100.0
    return decided(digits >= least, digits, fraction, f"{digits:.2f} digits per refinement, at least {least:g} claimed")


def judge_regression(value: float, accepted: float, *, permitted: float) -> Judgement:
    """Judge |value - accepted| <= permitted; a number that is not finite on either side is INVALID."""
    if not (math.isfinite(value) and math.isfinite(accepted)):
        return nothing_compared(Status.INVALID, f"value {value}, baseline {accepted}: both must be finite")
    change = value - accepted
    message = f"{value:.17g} against accepted {accepted:.17g}: change {change:+.1e}, permitted {permitted:.1e}"
    return decided(abs(change) <= permitted, value, abs(change) / permitted, message, Status.DIFF)


def worst_judgement(judgements: Sequence[Judgement]) -> Judgement:
    """Return the judgement that decides: by status, then by fraction of the tolerance.

    Raises:
        InvalidInput: Without any judgement; nothing compared is no pass.
    """
    if not judgements:
        raise InvalidInput("a claim compared nothing; give it at least one step, scene and method")
    decisive = worst(j.status for j in judgements)
    return max((j for j in judgements if j.status is decisive), key=lambda j: j.fraction or 0.0)


def positive_tolerance(tolerance: float) -> float:
    """Return the tolerance itself.

    Raises:
        InvalidInput: Unless it is positive and finite; a wrong sign or an infinite one would decide every check.
    """
    if not (math.isfinite(tolerance) and tolerance > 0):
        raise InvalidInput(f"a tolerance must be positive and finite, got {tolerance}")
    return tolerance


def relative_spread(samples: Sequence[float], scale: float) -> float:
    """Return half the range of repeated values over max(largest magnitude, scale)."""
    values = np.asarray(samples, dtype=np.float64)
    size = max(float(np.max(np.abs(values))), scale)
    return float(np.ptp(values)) / 2 / size if size > 0 else 0.0

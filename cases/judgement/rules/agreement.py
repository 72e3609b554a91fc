"""Do two methods agree, given the uncertainty of each?  Form of ASME V&V 20."""

import math

from cases.judgement.rules.judgement import Judgement, nothing_compared
from cases.judgement.rules.tolerance import positive_tolerance
from cases.results.records.claim import Verdict
from cases.results.status import Status

_STATUS = {
    Verdict.AGREE: Status.PASS,
    Verdict.DISAGREE: Status.FAIL,
    Verdict.INCONCLUSIVE: Status.INCONCLUSIVE,
}


def judge_agreement(
    difference: float,
    uncertainties: dict[str, float],
    *,
    tolerance: float,
    input_uncertainty: float = 0.0,
    model_gap: float = 0.0,
) -> Judgement:
    """Judge a signed relative difference S_fast - S_reference.

    Args:
        difference: over the scale of the quantity.
        uncertainties: each method's own numerical uncertainty by name, relative, not negative.
        tolerance: largest difference that still is agreement.
        input_uncertainty: of the data both answers start from, relative.
        model_gap: declared difference of the models (a half-space used for a layer), relative and signed.

    Returns:
        DISAGREE when E - u > tolerance, however wide u is; AGREE when E + u <= tolerance; otherwise INCONCLUSIVE, and
        the message names the coarser method.
    """
    positive_tolerance(tolerance)
    numbers = [difference, input_uncertainty, model_gap, *uncertainties.values()]
    if not all(math.isfinite(number) for number in numbers) or any(u < 0 for u in numbers[1:2] + numbers[3:]):
        return nothing_compared(Status.INVALID, f"difference {difference} with uncertainties {uncertainties}")
    error = abs(difference - model_gap)
    spread = math.hypot(input_uncertainty, *uncertainties.values())
    verdict = _verdict(error, spread, tolerance)
    seen = f"relative difference {difference:+.1e}, uncertainty {spread:.1e}, tolerance {tolerance:.0e}"
    advice = f"; refine {max(uncertainties, key=lambda m: uncertainties[m])}" if verdict is Verdict.INCONCLUSIVE else ""
    advice += "; more than the methods' own uncertainties explain" if error > spread else ""
    return Judgement(
        status=_STATUS[verdict],
        verdict=verdict,
        observed=difference,
        fraction=(error + spread) / tolerance,
        message=seen + advice,
    )


def _verdict(error: float, spread: float, tolerance: float) -> Verdict:
    if error - spread > tolerance:
        return Verdict.DISAGREE
    return Verdict.AGREE if error + spread <= tolerance else Verdict.INCONCLUSIVE


def without_uncertainty(judged: Judgement, method: str, quantity: str) -> Judgement:
    """Return the verdict where a method states no uncertainty: a difference beyond the tolerance, or none."""
    if judged.status.is_failure:
        return judged
    message = f"{method} states no uncertainty of {quantity}: no verdict is possible"
    return nothing_compared(Status.INCONCLUSIVE, message)

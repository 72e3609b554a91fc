"""Do two methods agree, given the uncertainty of each?  Form of ASME V&V 20."""

import math

from cases.judgement.rules.judgement import Judgement, nothing_compared
from cases.judgement.rules.tolerance import positive_tolerance
from cases.results.records.claim import Verdict
from cases.results.status import Status

_STATUS = {
    Verdict.AGREE: Status.PASS,
    Verdict.DISAGREE: Status.FAIL,
    Verdict.MARGINAL: Status.INCONCLUSIVE,
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
        AGREE when E + u <= tolerance, DISAGREE when E - u > tolerance, MARGINAL between, INCONCLUSIVE when u alone
        exceeds the tolerance; then the message names the coarser method.
    """
    positive_tolerance(tolerance)
    numbers = [difference, input_uncertainty, model_gap, *uncertainties.values()]
    if not all(math.isfinite(number) for number in numbers) or any(u < 0 for u in numbers[1:2] + numbers[3:]):
        return nothing_compared(Status.INVALID, f"difference {difference} with uncertainties {uncertainties}")
    error = abs(difference - model_gap)
    spread = math.hypot(input_uncertainty, *uncertainties.values())
    verdict = _verdict(error, spread, tolerance)
    seen = f"relative difference {difference:+.1e}, uncertainty {spread:.1e}, tolerance {tolerance:.0e}"
    advice = f"; refine {max(uncertainties, key=lambda m: uncertainties[m])}" if spread > tolerance else ""
    advice += "; more than the methods' own uncertainties explain" if error > spread else ""
    return Judgement(
        status=_STATUS[verdict],
        verdict=verdict,
        observed=difference,
        fraction=(error + spread) / tolerance,
        message=seen + advice,
    )


def _verdict(error: float, spread: float, tolerance: float) -> Verdict:
    if spread > tolerance:
        return Verdict.INCONCLUSIVE
    if error + spread <= tolerance:
        return Verdict.AGREE
    return Verdict.DISAGREE if error - spread > tolerance else Verdict.MARGINAL

"""The observed order of convergence against the formal one of case, quantity and mesh family."""

from cases.judgement.convergence.observed_order import order_is_accepted
from cases.judgement.rules.judgement import Judgement, decided, nothing_compared
from cases.results.records.convergence import ConvergenceClass
from cases.results.status import Status

_NO_ORDER = {ConvergenceClass.FLOOR, ConvergenceClass.TOO_FEW}


def judge_order(observed: float | None, formal: float, kind: ConvergenceClass) -> Judgement:
    """Judge the band [formal - 0.2, formal + 0.5]; a divergent sequence fails, one at the floor is inconclusive."""
    if kind in _NO_ORDER or observed is None:
        status = Status.INCONCLUSIVE if kind in _NO_ORDER else Status.FAIL
        return nothing_compared(status, f"the sequence is {kind.value}: it has no order; formal order {formal:g}")
    good = order_is_accepted(observed, formal) and kind is not ConvergenceClass.DIVERGENT
    message = f"observed order {observed:.3f}, formal order {formal:g}, {kind.value}"
    return decided(good, observed, _fraction_of_band(observed, formal), message)


def judge_digits(digits: float, least: float) -> Judgement:
    """Judge spectral convergence: at least ``least`` digits per refinement."""
    fraction = least / digits if digits > least / 100 else 100.0
    return decided(digits >= least, digits, fraction, f"{digits:.2f} digits per refinement, at least {least:g} claimed")


def _fraction_of_band(observed: float, formal: float) -> float:
    """Distance from the formal order in units of the band's width on that side."""
    return (formal - observed) / 0.2 if observed < formal else (observed - formal) / 0.5

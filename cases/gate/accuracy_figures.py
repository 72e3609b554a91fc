"""What the accepted numbers say about accuracy: which errors each method states, and how far two methods differ."""

import statistics
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Final, TypeAlias

from cases.gate.baseline import AcceptedQuantity, Baseline
from contact import UNITS, DetachmentPath

Accepted: TypeAlias = Mapping[tuple[str, str], AcceptedQuantity]

# The fast method is compared with the independent one, and every other method with the fast one.
_PARTNER: Final = {"mdr": "fem"}
_PARTNER_OF_OTHERS: Final = "mdr"

# Relative difference that is nothing but rounding: a hundred times the spacing of double precision.
_ROUNDING: Final = 100 * sys.float_info.epsilon


@dataclass(frozen=True, kw_only=True)
class AccuracyFigure:
    """One quantity of one method on one case, over all accepted scenes and states.

    Attributes:
        case: Name of the case.
        method: Name of the method.
        quantity: Its name.
        stated: Relative errors that the method states, one for each state.
        partner: The method it is compared with.
        differences: Relative differences to the partner, one for each state that both have.
        within: How many of these differences are rounding, or no larger than both stated errors together.
    """

    case: str
    method: str
    quantity: str
    stated: tuple[float, ...]
    partner: str
    differences: tuple[float, ...]
    within: int


@dataclass(frozen=True)
class _Compared:
    """One state that two methods have: the relative difference, and whether both stated errors cover it."""

    difference: float
    covered: bool


def accuracy_figures(baselines: Iterable[Baseline]) -> Iterator[AccuracyFigure]:
    """The figures in the order of the baselines; quantities that are prescribed have none."""
    by_name = {(b.case, b.method): b for b in baselines}
    for (case, method), baseline in by_name.items():
        partner = _PARTNER.get(method, _PARTNER_OF_OTHERS)
        others = _by_place(by_name[case, partner]) if (case, partner) in by_name else {}
        for quantity in dict.fromkeys(r.quantity for r in baseline.records if r.quantity in UNITS):
            figure = _figure(baseline, quantity, partner, others)
            if max((*figure.stated, *figure.differences), default=0.0) > 0.0:
                yield figure


def _figure(baseline: Baseline, quantity: str, partner: str, others: Accepted) -> AccuracyFigure:
    records = [r for r in baseline.records if r.quantity == quantity]
    pairs = [(r, others[r.place]) for r in records if r.place in others]
    compared = [state for pair in pairs if _same_states(*pair, others) for state in _compare(*pair)]
    return AccuracyFigure(
        case=baseline.case,
        method=baseline.method,
        quantity=quantity,
        stated=tuple(e for r in records for e in _relative(r, r.uncertainty)),
        partner=partner,
        differences=tuple(state.difference for state in compared),
        within=sum(state.covered for state in compared),
    )


def _by_place(baseline: Baseline) -> Accepted:
    return {record.place: record for record in baseline.records}


def _same_states(record: AcceptedQuantity, other: AcceptedQuantity, others: Accepted) -> bool:
    """Each method chooses its own states along a detachment, so only the pull-off is compared there."""
    chosen = (record.scene, "pull_off_force") in others and record.quantity not in DetachmentPath.SCALARS
    return not chosen and len(record.values) == len(other.values)


def _compare(record: AcceptedQuantity, other: AcceptedQuantity) -> Iterator[_Compared]:
    """States whose errors both methods state."""
    rows = zip(record.values, other.values, record.uncertainty, other.uncertainty, strict=False)
    apart = [(abs(a - b), own + theirs) for a, b, own, theirs in rows]
    sizes = _relative(record, [difference for difference, _ in apart])
    return (
        _Compared(size, gap <= allowed or size <= _ROUNDING) for size, (gap, allowed) in zip(sizes, apart, strict=True)
    )


def _relative(record: AcceptedQuantity, errors: Iterable[float]) -> list[float]:
    return [error / max(abs(value), record.scale) for error, value in zip(errors, record.values, strict=False)]


def median_and_largest(errors: tuple[float, ...]) -> tuple[float, float] | None:
    """Median and largest of some relative errors; None if there are none."""
    return (statistics.median(errors), max(errors)) if errors else None

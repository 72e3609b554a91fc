"""Tables of hard cases: where ladders break and with how many digits, and how well stated errors hold."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from typing import Any

import numpy as np

from cases.measurements.advice.error_maps import UNBONDED, good_range
from cases.measurements.campaigns.coefficients import coefficients
from cases.measurements.campaigns.coverage import at_90
from cases.measurements.ladders.ladders import breakdown, fewest_digits
from cases.results.records.reliability import CoverageRecord, ErrorMap, Ladder, Rung
from cases.results.records.run import CaseResult
from cases.results.status import Status
from reports.tables.table import Table, per_cent, tabulated
from reports.words.method_names import display_name
from reports.words.numbers import small

STATED = "stated error"


def ladders(case: CaseResult) -> Table | None:
    """One row a ladder and method: range, breakdown, digits, iterations, residuals."""
    return tabulated(
        case.ladders,
        {
            "ladder": lambda ladder: ladder.name,
            "method": lambda ladder: display_name(ladder.method),
            "parameter": lambda ladder: ladder.parameter,
            "walked": lambda ladder: _with_unit(
                ladder, f"{small(ladder.rungs[0].value)} .. {small(ladder.rungs[-1].value)}"
            ),
            "how far": _how_far,
            "fewest digits": lambda ladder: "" if (d := fewest_digits(ladder)) is None else f"{d:.1f}",
            "iterations": lambda ladder: f"{max(found)}" if (found := _iterations(ladder)) else "",
            "residual": lambda ladder: _largest(
                v for r in _climbed(ladder) for k, v in r.residuals.items() if k != STATED
            ),
            "stated": lambda ladder: _largest(value for name, value in _residuals(ladder) if name == STATED),
        },
        title="Breakdown rungs and digits",
        note="Digits are those that perturbed repeats share on the worst rung that was climbed. Residual: the largest "
        "of any law of mechanics there, independent answers included, and the largest error the method states. Why a "
        "method refused is said below the figures.",
        words=3,
    )


def _climbed(ladder: Ladder) -> list[Rung]:
    return [rung for rung in ladder.rungs if rung.digits is not None]


def _iterations(ladder: Ladder) -> list[int]:
    return [rung.iterations for rung in _climbed(ladder) if rung.iterations is not None]


def _residuals(ladder: Ladder) -> Iterator[tuple[str, float]]:
    return (residual for rung in _climbed(ladder) for residual in rung.residuals.items())


def _with_unit(ladder: Ladder, text: str) -> str:
    return text if ladder.unit == "1" else f"{text} {ladder.unit}"


def _how_far(ladder: Ladder) -> str:
    stop = breakdown(ladder)
    return "climbed to the end" if stop is None else _with_unit(ladder, f"{_gave_up(ladder, stop)} {small(stop)}")


def _largest(values: Iterable[float]) -> str:
    """The largest of some errors; empty where there are none."""
    found = list(values)
    return small(max(found)) if found else ""


def _gave_up(ladder: Ladder, stop: float) -> str:
    (rung,) = (rung for rung in ladder.rungs if rung.value == stop)
    return "fails at" if rung.status is Status.FAIL else "refuses"


def coverage(case: CaseResult) -> Table | None:
    """One row a method, family of scenes and quantity."""
    return tabulated(
        case.coverage,
        {
            "method": lambda record: display_name(record.method),
            "settings": lambda record: (
                ", ".join(f"{name} {value}" for name, value in record.settings.items()) or "as they come"
            ),
            "scenes": lambda record: record.family,
            "quantity": lambda record: record.quantity.replace("_", " "),
            "scenes drawn": lambda record: f"{record.scenes}",
            "refused": lambda record: f"{record.refused}",
            "answers": lambda record: f"{record.checks}",
            "covered": lambda record: per_cent(record.covered),
            "sharpness": lambda record: _largest(_sharpness([record])),
            "at 90 %": lambda record: _largest(map(at_90, _told([record]))),
        },
        title="Coverage and sharpness",
        note="Covered: share of answers whose true error lies within the stated one (with the referee's own "
        "uncertainty). Sharpness: stated over true error, in the median and at 90 % of those above the referee's "
        "uncertainty and a hundred roundings.",
        words=4,
    )


def _told(records: Iterable[CoverageRecord]) -> list[CoverageRecord]:
    """Those of which true errors could be told."""
    return [record for record in records if record.sharpness is not None]


def _sharpness(records: Iterable[CoverageRecord]) -> list[float]:
    return [record.sharpness or 0.0 for record in _told(records)]


def error_coefficients(case: CaseResult) -> Table | None:
    """One row a coefficient of the error models of all measured methods, beside the worst that it led to."""
    return tabulated(
        coefficients(case.coverage),
        {
            "coefficient": lambda found: found.name,
            "shapes": lambda found: ", ".join(q.replace("_", " ") for q in found.quantities) or "all quantities",
            "value": lambda found: ", ".join(f"{number:.3g}" for number in _numbers(found.value)),
            "rows": lambda found: f"{len(found.achieved)}",
            "least covered": lambda found: per_cent(min(r.covered for r in found.achieved)) if found.achieved else "",
            "sharpness": lambda found: _largest(_sharpness(found.achieved)),
            "at 90 %": lambda found: _largest(map(at_90, _told(found.achieved))),
        },
        title="Error coefficients and what they achieved",
        note="The least coverage and the largest sharpness, in the median and at 90 %, of the stated errors that a "
        "coefficient shapes, over so many of the rows above; empty where this study measured none of them.",
        words=2,
    )


def _numbers(value: Any) -> Iterable[float]:
    """The numbers of a coefficient: one, several, or one for each polynomial degree."""
    return map(float, np.ravel(list(value.values()) if isinstance(value, Mapping) else value))


def good_ranges(case: CaseResult) -> Table | None:
    """Where each formula or method is good to one percent, one column a map."""
    columns: dict[str, Callable[[str], str]] = {found.title: partial(_range, found) for found in case.maps}
    return tabulated(
        dict.fromkeys(row for found in case.maps for row in found.rows),
        {"layer": _layer} | columns,
        title="Range of a/h that is good to 1 %",
        note="Smallest and largest a/h of the map with an error of at most 1 %; between them a hole may lie.",
    )


def _layer(row: str) -> str:
    return row if row == UNBONDED else f"nu = {row}"


def _range(found: ErrorMap, row: str) -> str:
    good = good_range(found, row) if row in found.rows else None
    if good is None:
        return "nowhere" if row in found.rows else ""
    return f"{good[0]:.2g} .. {good[1]:.2g}"

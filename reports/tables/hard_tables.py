"""Tables of hard cases: where ladders break and with how many digits, and how well stated errors hold."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from cases.measurements.advice.error_maps import UNBONDED, good_range
from cases.measurements.campaigns.coefficients import Coefficient, coefficients
from cases.measurements.campaigns.coverage import at_90
from cases.measurements.ladders.ladders import breakdown, fewest_digits
from cases.results.records.reliability import CoverageRecord, ErrorMap, Ladder
from cases.results.records.run import CaseResult
from cases.results.status import Status
from reports.tables.table import Table
from reports.words.method_names import display_name
from reports.words.numbers import small

STATED, SECOND = "stated error", "second opinion"


def ladders(case: CaseResult) -> Table | None:
    """One row a ladder and method: range, breakdown, digits, iterations, residuals."""
    if not case.ladders:
        return None
    return Table(
        title="Breakdown rungs and digits",
        note="Digits are those that perturbed repeats share on the worst rung that was climbed. Residual: the largest "
        "of any law of mechanics there, independent answers included, and the largest error the method states. Why a "
        "method refused is said below the figures.",
        heads=(
            "ladder",
            "method",
            "parameter",
            "walked",
            "how far",
            "fewest digits",
            "iterations",
            "residual",
            "stated",
        ),
        rows=tuple(map(_ladder_row, case.ladders)),
        words=3,
    )


def _ladder_row(ladder: Ladder) -> tuple[str, ...]:
    stop, digits = breakdown(ladder), fewest_digits(ladder)
    unit = "" if ladder.unit == "1" else f" {ladder.unit}"
    climbed = [rung for rung in ladder.rungs if rung.digits is not None]
    laws = [value for rung in climbed for name, value in rung.residuals.items() if name != STATED]
    stated = [rung.residuals[STATED] for rung in climbed if STATED in rung.residuals]
    iterations = [rung.iterations for rung in climbed if rung.iterations is not None]
    return (
        ladder.name,
        display_name(ladder.method),
        ladder.parameter,
        f"{small(ladder.rungs[0].value)} .. {small(ladder.rungs[-1].value)}{unit}",
        "climbed to the end" if stop is None else f"{_gave_up(ladder, stop)} {small(stop)}{unit}",
        "" if digits is None else f"{digits:.1f}",
        f"{max(iterations)}" if iterations else "",
        small(max(laws)) if laws else "",
        small(max(stated)) if stated else "",
    )


def _gave_up(ladder: Ladder, stop: float) -> str:
    (rung,) = (rung for rung in ladder.rungs if rung.value == stop)
    return "fails at" if rung.status is Status.FAIL else "refuses"


def coverage(case: CaseResult) -> Table | None:
    """One row a method, family of scenes and quantity."""
    if not case.coverage:
        return None
    return Table(
        title="Coverage and sharpness",
        note="Covered: share of answers whose true error lies within the stated one (with the referee's own "
        "uncertainty). Sharpness: stated over true error, in the median and at 90 % of those above the referee's "
        "uncertainty and a hundred roundings.",
        heads=(
            "method",
            "settings",
            "scenes",
            "quantity",
            "scenes drawn",
            "refused",
            "answers",
            "covered",
            "sharpness",
            "at 90 %",
        ),
        rows=tuple(map(_coverage_row, case.coverage)),
        words=4,
    )


def _coverage_row(record: CoverageRecord) -> tuple[str, ...]:
    settings = ", ".join(f"{name} {value}" for name, value in record.settings.items()) or "as they come"
    return (
        display_name(record.method),
        settings,
        record.family,
        record.quantity.replace("_", " "),
        f"{record.scenes}",
        f"{record.refused}",
        f"{record.checks}",
        f"{100 * record.covered:.1f} %",
        "" if record.sharpness is None else small(record.sharpness),
        "" if record.sharpness is None else small(at_90(record)),
    )


def error_coefficients(case: CaseResult) -> Table | None:
    """One row a coefficient of the error models of all measured methods, beside the worst that it led to."""
    rows = tuple(map(_coefficient_row, coefficients(case.coverage)))
    if not rows:
        return None
    return Table(
        title="Error coefficients and what they achieved",
        note="The least coverage and the largest sharpness, in the median and at 90 %, of the stated errors that a "
        "coefficient shapes, over so many of the rows above; empty where this study measured none of them.",
        heads=("coefficient", "shapes", "value", "rows", "least covered", "sharpness", "at 90 %"),
        rows=rows,
        words=2,
    )


def _coefficient_row(found: Coefficient) -> tuple[str, ...]:
    shaped = ", ".join(quantity.replace("_", " ") for quantity in found.quantities) or "all quantities"
    head = found.name, shaped, ", ".join(f"{number:.3g}" for number in _numbers(found.value))
    if not found.achieved:
        return *head, "0", "", "", ""
    least = min(record.covered for record in found.achieved)
    sharp = [record for record in found.achieved if record.sharpness is not None]
    medians, at_most = [record.sharpness or 0.0 for record in sharp], [at_90(record) for record in sharp]
    largest = (small(max(ratios)) if ratios else "" for ratios in (medians, at_most))
    return *head, f"{len(found.achieved)}", f"{100 * least:.1f} %", *largest


def _numbers(value: Any) -> Iterable[float]:
    """The numbers of a coefficient: one, several, or one for each polynomial degree."""
    return map(float, np.ravel(list(value.values()) if isinstance(value, Mapping) else value))


def good_ranges(case: CaseResult) -> Table | None:
    """Where each formula or method is good to one percent, one column a map."""
    if not case.maps:
        return None
    rows = list(dict.fromkeys(row for found in case.maps for row in found.rows))
    return Table(
        title="Range of a/h that is good to 1 %",
        note="Smallest and largest a/h of the map with an error of at most 1 %; between them a hole may lie.",
        heads=("layer", *(found.title for found in case.maps)),
        rows=tuple((_layer(row), *(_range(found, row) for found in case.maps)) for row in rows),
    )


def _layer(row: str) -> str:
    return row if row == UNBONDED else f"nu = {row}"


def _range(found: ErrorMap, row: str) -> str:
    good = good_range(found, row) if row in found.rows else None
    if good is None:
        return "nowhere" if row in found.rows else ""
    return f"{good[0]:.2g} .. {good[1]:.2g}"

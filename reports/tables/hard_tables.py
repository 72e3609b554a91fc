"""Tables of hard cases: where ladders break and with how many digits, and how well stated errors hold."""

from collections.abc import Callable, Iterable, Iterator
from functools import partial

from cases.results.records.reliability import UNBONDED, CoverageRecord, ErrorMap, Ladder, Rung
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
            "fewest digits": lambda ladder: "" if ladder.fewest_digits is None else f"{ladder.fewest_digits:.1f}",
            "iterations": lambda ladder: f"{max(found)}" if (found := _iterations(ladder)) else "",
            "residual": lambda ladder: largest(
                v for r in _climbed(ladder) for k, v in r.residuals.items() if k != STATED
            ),
            "stated": lambda ladder: largest(value for name, value in _residuals(ladder) if name == STATED),
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
    stop = ladder.breakdown
    if stop is None:
        return "climbed to the end"
    return _with_unit(ladder, f"{'fails at' if stop.status is Status.FAIL else 'refuses'} {small(stop.value)}")


def largest(values: Iterable[float]) -> str:
    """The largest of some errors; empty where there are none."""
    found = list(values)
    return small(max(found)) if found else ""


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
            "sharpness": lambda record: largest(sharpness([record])),
            "at 90 %": lambda record: largest(r.at_90 for r in told([record])),
        },
        title="Coverage and sharpness",
        note="Covered: share of answers whose true error lies within the stated one (with the referee's own "
        "uncertainty). Sharpness: stated over true error, in the median and at 90 % of those above the referee's "
        "uncertainty and a hundred roundings.",
        words=4,
    )


def told(records: Iterable[CoverageRecord]) -> list[CoverageRecord]:
    """Those of which true errors could be told."""
    return [record for record in records if record.sharpness is not None]


def sharpness(records: Iterable[CoverageRecord]) -> list[float]:
    """Stated over true error in the median, of those of which true errors could be told."""
    return [record.sharpness or 0.0 for record in told(records)]


def good_ranges(case: CaseResult) -> Table | None:
    """Where each formula or method is good to one percent, one column a map; what friction moves, to five, too."""
    columns: dict[str, Callable[[str], str]] = {found.title: partial(_range, found) for found in case.maps}
    rubbed = (found for found in case.maps if found.name.startswith("friction"))
    columns |= {f"{found.title}, good to 5 %": partial(_range, found, limit=5e-2) for found in rubbed}
    return tabulated(
        dict.fromkeys(row for found in case.maps for row in found.rows),
        {"layer": _layer} | columns,
        title="Range of a/h that is good to 1 %",
        note="First and last a/h of each run of neighbours with errors of at most 1 %, or what its head says.",
    )


def _layer(row: str) -> str:
    return row if row == UNBONDED else f"nu = {row}"


def _range(found: ErrorMap, row: str, limit: float = 1e-2) -> str:
    if row not in found.rows:
        return ""
    good = found.good_ranges(row, limit)
    return "; ".join(f"{low:.2g} .. {high:.2g}" if low < high else f"{low:.2g}" for low, high in good) or "nowhere"

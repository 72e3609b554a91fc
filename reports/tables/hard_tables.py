"""Table of hard cases: where ladders break and with how many digits."""

from collections.abc import Iterable, Iterator

from cases.results.records.reliability import Ladder, Rung
from cases.results.records.run import CaseResult
from cases.results.status import Status
from reports.words import Table, display_name, small, tabulated

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

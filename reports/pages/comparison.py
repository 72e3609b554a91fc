"""comparison.html: two runs side by side, what ends otherwise first, then numbers by how far they moved, then times."""

from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from cases.results.compare_runs import ChangeKind, ClaimChange, NumberChange, RunComparison, TimeChange
from cases.results.files import write_whole
from cases.results.records.run import RunResult
from reports.pages.report import stamp_lines, stylesheet, template
from reports.words import Table, display_name, duration, measured, scaled_unit, small, tabulated

# Rows of a table on the page; the largest changes come first and the rest is counted.
MOST_ROWS = 400

ORDER = (ChangeKind.INCOMPARABLE, ChangeKind.BEYOND, ChangeKind.UNKNOWN, ChangeKind.WITHIN, ChangeKind.IDENTICAL)


def write_comparison(comparison: RunComparison, runs: tuple[RunResult, RunResult], page: Path) -> None:
    """Write the page of a comparison."""
    words, tone = headline(comparison)
    text = template("comparison.html").render(
        headline=words,
        tone=tone,
        stamps=[stamp_lines(run) for run in runs],
        claims=claim_table(comparison.claims),
        numbers=number_table(comparison.numbers),
        times=time_table(comparison.times),
        missing=comparison.missing,
        counts=counts_sentence(comparison),
        css=stylesheet(),
    )
    write_whole(page, text)


def headline(comparison: RunComparison) -> tuple[str, str]:
    """The result in a few words, and its tone."""
    tally = Counter(number.change for number in comparison.numbers)
    worse = sum(_got_worse(claim) for claim in comparison.claims)
    moved, total = tally[ChangeKind.BEYOND] + tally[ChangeKind.INCOMPARABLE], len(comparison.numbers)
    checks = f"{worse} check{'s'[: worse != 1]} got worse; " if worse else ""
    if not total:
        return f"{checks}no number in common", "bad"
    tone = "bad" if worse or moved else "warn" if comparison.claims or comparison.missing else "good"
    if tally[ChangeKind.IDENTICAL] == total:
        return f"{checks}all {total} numbers identical", tone
    return f"{checks}{moved} of {total} numbers moved beyond their uncertainty", tone


def counts_sentence(comparison: RunComparison) -> str:
    """How many numbers are identical, moved within their uncertainty, and so on."""
    tally = Counter(number.change for number in comparison.numbers)
    return ", ".join(f"{tally[change]} {change}" for change in ORDER if tally[change])


def _got_worse(change: ClaimChange) -> bool:
    before, after = change.statuses
    failed_before = before is not None and before.is_failure
    return (after is None or after.is_failure) and not failed_before


def claim_table(claims: tuple[ClaimChange, ...]) -> Table | None:
    """Checks that end otherwise, the worse ones first."""
    return tabulated(
        sorted(claims, key=lambda change: not _got_worse(change)),
        {
            "case": lambda change: change.case,
            "check": lambda change: change.claim,
            "scene": lambda change: change.scene,
            "methods": lambda change: " against ".join(change.methods),
            "first": lambda change: str(change.statuses[0] or "absent"),
            "second": lambda change: str(change.statuses[1] or "absent"),
            "fraction first": lambda change: _small(change.fractions[0]),
            "fraction second": lambda change: _small(change.fractions[1]),
            "seen in the second": lambda change: change.message,
        },
        title="Checks that end otherwise",
        note="Fraction: error over tolerance.",
        words=9,
    )


def _small(value: float | None) -> str:
    return "" if value is None else small(value)


def _against(methods: Iterable[str]) -> str:
    return " against ".join(dict.fromkeys(display_name(method) for method in methods))


def number_table(numbers: tuple[NumberChange, ...], most: int = MOST_ROWS) -> Table | None:
    """Every number that moved, the furthest first."""
    moved = [number for number in numbers if number.change is not ChangeKind.IDENTICAL]
    moved.sort(key=lambda number: (ORDER.index(number.change), -abs(number.difference or 0.0)))
    left_out = len(moved) - most
    rest = f" {left_out} smaller changes are not listed." if left_out > 0 else ""
    return tabulated(
        moved[:most],
        {
            "change": lambda number: str(number.change),
            "scene": lambda number: f"{number.case} / {number.scene}",
            "quantity": lambda number: number.quantity.replace("_", " "),
            "methods": lambda number: _against(number.methods),
            "first": lambda number: _value(number, 0),
            "second": lambda number: _value(number, 1),
            "difference": lambda number: _small(number.difference),
            "uncertainty": lambda number: _small(number.uncertainty),
        },
        title="Numbers that moved",
        note=f"Difference: second minus first, over the scale of the quantity, at the step where it is largest.{rest}",
        words=4,
    )


def _value(number: NumberChange, place: int) -> str:
    """One of the two values, both in the unit that fits the first."""
    if number.values is None:
        return "not comparable"
    factor, unit = scaled_unit(number.values[0], number.unit)
    uncertainty = number.uncertainties[place] if number.uncertainties else float("inf")
    return f"{measured(number.values[place] / factor, uncertainty / factor)} {unit}".strip()


def time_table(times: tuple[TimeChange, ...]) -> Table | None:
    """Seconds of both runs; a ratio, not a verdict, because nothing says that the machine was idle."""
    return tabulated(
        sorted(times, key=lambda change: -change.ratio)[:MOST_ROWS],
        {
            "case": lambda change: change.case,
            "scene": lambda change: change.scene,
            "methods": lambda change: _against(change.methods),
            "first": lambda change: duration(change.seconds[0]),
            "second": lambda change: duration(change.seconds[1]),
            "ratio": lambda change: f"{change.ratio:.2f}",
        },
        title="Times",
        note="One run each: a hint. `python -m benchmarks.race` measures times alternately and judges them.",
        words=3,
    )

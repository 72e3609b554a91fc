"""What moved since the baseline, in groups: numbers of one quantity and method that moved alike are one sentence."""

from collections import Counter
from collections.abc import Iterator, Sequence
from statistics import median

from cases.measurements.measurement import grouped
from cases.results.records.claim import Claim, Kind
from cases.results.records.run import RunResult
from cases.results.status import Status
from reports.words import display_name

# Fewer numbers than this are no group: they are counted among the rest.
FEWEST = 3
# Relative changes this near to their median, as a share of it, are one move. Chosen: two digits are shown.
ALIKE = 0.05


def moves(run: RunResult) -> list[str]:
    """One sentence for each group of accepted numbers that moved beyond their tolerance, the largest group first.

    A last sentence counts the rest by how it ended. Nothing is said of a run without failed comparisons.
    """
    compared = (claim for case in run.cases for claim in case.claims if claim.kind is Kind.REGRESSION)
    groups = grouped(compared, lambda claim: (" against ".join(map(display_name, claim.methods)), claim.quantity))
    rest = Counter(claim.status for claims in groups.values() for claim in claims if claim.status.is_failure)
    found: list[tuple[int, str]] = []
    for (method, quantity), claims in groups.items():
        for changes in _parts([change for claim in claims if (change := _change(claim)) is not None]):
            rest[Status.DIFF] -= len(changes)
            share = f"all {len(changes)}" if len(changes) == len(claims) else f"{len(changes)} of {len(claims)}"
            found.append((len(changes), f"{share} {quantity} of {method} moved by {_size(changes)} relative"))
    sentences = [sentence for _, sentence in sorted(found, key=lambda entry: -entry[0])]
    ends = ", ".join(f"{number} {status}" for status, number in rest.items() if number)
    return [*sentences, f"{'the rest' if sentences else 'no group moved alike'}: {ends}"] if ends else sentences


def _change(claim: Claim) -> float | None:
    """Relative change of a number that moved beyond its tolerance; None of one that has no accepted size."""
    if claim.status is not Status.DIFF or claim.observed is None or not claim.expected:
        return None
    return (claim.observed - claim.expected) / abs(claim.expected)


def _parts(changes: Sequence[float]) -> Iterator[Sequence[float]]:
    """The changes near their median, and the others, each as far as it is a group."""
    if changes:
        middle = median(changes)
        near = [change for change in changes if abs(change - middle) <= ALIKE * abs(middle)]
        alike = near if len(near) >= FEWEST else []
        others = [change for change in changes if change not in alike]
        yield from (part for part in (alike, others) if len(part) >= FEWEST)


def _size(changes: Sequence[float]) -> str:
    least, most = f"{min(changes):+.1e}", f"{max(changes):+.1e}"
    near = max(changes) - min(changes) <= 2 * ALIKE * abs(median(changes))
    return f"{median(changes):+.1e}" if near else f"{least} to {most}"


def baseline_sentence(run: RunResult) -> str:
    """How far this run is from the accepted one."""
    compared = [claim for case in run.cases for claim in case.claims if claim.kind is Kind.REGRESSION]
    if not compared:
        return "Not compared with a baseline."
    changed = sum(claim.status is not Status.PASS for claim in compared)
    groups = "; ".join(moves(run))
    return f"Since the baseline: {changed} of {len(compared)} numbers changed{groups and ': '}{groups}."

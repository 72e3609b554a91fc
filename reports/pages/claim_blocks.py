"""The claims of a case: one row for a claim and a method (or two compared), the worst of its scenes stands for all.

A table of scenes by claims would be wider than any page; every single check stands in the list of all checks.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from cases.measurements.measurement import grouped
from cases.results.records.claim import Claim, Kind
from cases.results.records.run import CaseResult
from cases.results.status import Status
from reports.pages.matrix import Cell, cell_of
from reports.pages.outcomes import claim_outcome, severity
from reports.words import display_name

# A relative tolerance beyond this is said beside the verdict: agreement within 5 % is another statement than AGREE.
WIDE = 1e-2


@dataclass(frozen=True, kw_only=True)
class ClaimRow:
    """A claim put to one method, or to two that are compared.

    Attributes:
        name: of the claim.
        methods: in words.
        shared: what the compared answers share, empty for independent ones.
        cell: the worst of the scenes.
        within: "within 5 %" where the tolerance is wide, and whose claim of accuracy has widened it; empty otherwise.
        scene: the worst one.
        observed: what was measured there.
        tolerance: largest permitted error.
    """

    name: str
    methods: str
    shared: str
    cell: Cell
    within: str
    scene: str
    observed: str
    tolerance: str


@dataclass(frozen=True, kw_only=True)
class ClaimBlock:
    """The claims that hold for one and the same reason."""

    kind: str
    because: str
    derived_from: str
    origin: str
    rows: tuple[ClaimRow, ...]


def claim_blocks(case: CaseResult) -> tuple[ClaimBlock, ...]:
    """The claims in the order of their kinds; the many comparisons with accepted numbers make one row a method."""
    ordered = sorted(case.claims, key=lambda claim: list(Kind).index(claim.kind))
    return tuple(_block(case.name, claims) for claims in grouped(ordered, _reason).values())


def _reason(claim: Claim) -> tuple[str, ...]:
    """What claims share that stand in one block."""
    return str(claim.kind), claim.because, *(() if _is_accepted(claim) else (claim.derived_from, claim.source))


def is_wide(claim: Claim) -> bool:
    """Whether a claim passed within a relative tolerance that is said beside its verdict.

    Orders have another unit; shares and counts (of silent failures, say) are claimed to be zero, relative to nothing. A
    limit of one or more is a factor.
    """
    counted = claim.kind is Kind.INVARIANT and claim.expected == 0.0
    relative = claim.kind is not Kind.ORDER and claim.unit == "1" and not counted
    return claim.status is Status.PASS and relative and WIDE < claim.tolerance < 1.0


def _is_accepted(claim: Claim) -> bool:
    return claim.kind is Kind.REGRESSION and claim.name.startswith("accepted ")


def _block(case: str, claims: Sequence[Claim]) -> ClaimBlock:
    first = claims[0]
    alike = grouped(claims, lambda claim: ("accepted numbers" if _is_accepted(claim) else claim.name, *claim.methods))
    return ClaimBlock(
        kind=str(first.kind),
        because=first.because,
        derived_from=first.derived_from,
        origin=f"{first.origin}: {first.source}",
        rows=tuple(_row(case, place[0], same) for place, same in alike.items()),
    )


def _within(claim: Claim) -> str:
    """What stands beside the verdict: a wide tolerance."""
    return f"within {100 * claim.tolerance:.2g} %" if is_wide(claim) else ""


def _row(case: str, name: str, same: Sequence[Claim]) -> ClaimRow:
    outcomes = {id(claim): claim_outcome(case, claim) for claim in same}
    ran = [claim for claim in same if claim.status is not Status.SKIP] or same
    worst = min(ran, key=lambda claim: severity(outcomes[id(claim)]))
    seen = outcomes[id(worst)]
    return ClaimRow(
        name=name,
        methods=" – ".join(map(display_name, worst.methods)),
        shared=", ".join(worst.shared_inputs),
        cell=cell_of(outcomes.values()),
        within=_within(worst),
        scene=worst.scene,
        observed=seen.message if worst.status is Status.SKIP else seen.observed,
        tolerance=seen.tolerance,
    )

"""The only writer of baselines, and everything it refuses."""

import math
from collections.abc import Iterator
from pathlib import Path

from cases.gate.baseline import write_baseline
from cases.gate.proposal import BaselineChange, Proposal
from cases.gate.write_permission import WriteConditions
from cases.results.records.claim import Kind
from cases.results.records.run import CaseResult, RunResult
from contact import InvalidInput


def accept(folder: Path, proposal: Proposal, run: RunResult, now: WriteConditions, *, loosen: bool = False) -> None:
    """Write the proposed baselines into ``folder``.

    Raises:
        InvalidInput: naming every reason why this may not be accepted; nothing is written then.
    """
    refused = refusals(proposal, run, now, loosen=loosen)
    if refused:
        raise InvalidInput(f"{proposal.case} is not accepted: " + "; ".join(refused))
    for baseline in proposal.baselines:
        write_baseline(folder, baseline)


def refusals(proposal: Proposal, run: RunResult, now: WriteConditions, *, loosen: bool = False) -> tuple[str, ...]:
    """Return every reason why ``proposal`` may not be accepted, each with its remedy."""
    return (
        *refusals_beforehand(proposal.case, run, now),
        *_refused_numbers(proposal),
        *(() if loosen else _loosenings(proposal)),
        *(() if proposal.reason.strip() else ("no reason is given; say why with --reason",)),
    )


def refusals_beforehand(case: str, run: RunResult, now: WriteConditions) -> tuple[str, ...]:
    """Return every reason that is known before the spread is measured."""
    return *_refused_circumstances(run, now), *_refused_run(run, run.case(case))


def _refused_circumstances(run: RunResult, now: WriteConditions) -> Iterator[str]:
    if now.in_ci:
        yield "continuous integration must not accept its own numbers; accept them by hand and commit the files"
    if now.changed:
        yield f"uncommitted changes ({', '.join(now.changed[:3])}); a baseline belongs to a commit, so commit first"
    if run.stamp.dirty:
        yield "the run was made with uncommitted changes; run again on a clean tree"
    if run.stamp.revision != now.revision:
        yield f"the run belongs to {run.stamp.revision[:12]}, the source is at {now.revision[:12]}; run again"


def _refused_run(run: RunResult, case: CaseResult) -> Iterator[str]:
    if not run.complete:
        yield "the run was interrupted; resume it first"
    for solution in case.runs:
        if solution.status.is_failure:
            yield f"{solution.method} on {solution.scene!r} ended with {solution.status}: {solution.reason}"
    for claim in case.claims:
        if claim.kind in (Kind.EXACT, Kind.ORDER) and claim.status.is_failure:
            yield f"the {claim.kind} claim {claim.name!r} ended with {claim.status}: {claim.message}"


def _refused_numbers(proposal: Proposal) -> Iterator[str]:
    for baseline in proposal.baselines:
        for record in baseline.records:
            if not all(map(math.isfinite, (*record.values, *record.uncertainty, record.spread, record.scale))):
                yield f"{record.quantity} of {record.scene!r} by {baseline.method} is not finite"


def _loosenings(proposal: Proposal) -> Iterator[str]:
    for change in proposal.changes:
        if change.loosens:
            yield f"{_loosening(change)}; find out why, then say --loosen"
    for name in proposal.lost:
        yield f"the {name} would no longer be watched; say --loosen if that is meant"


def _loosening(change: BaselineChange) -> str:
    name = f"{change.record.quantity} of {change.record.scene!r} by {change.method}"
    if change.old is None or change.new is None:
        return f"{name} would no longer be watched"
    return f"the tolerance of {name} would grow from {change.old.tolerance:.1e} to {change.new.tolerance:.1e}"

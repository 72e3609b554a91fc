"""`contact-verify gate` and `accept`: a finished run against the accepted numbers, and new numbers to accept."""

from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path

from cases.declare.case import Case
from cases.declare.foreign_methods import with_registered
from cases.declare.registry import load_cases, select
from cases.declare.selection import nightly_only
from cases.gate.accept import accept, refusals, refusals_beforehand
from cases.gate.baseline import Baseline, read_baselines
from cases.gate.gate import gate
from cases.gate.ladders import accept_ladders, ladder_claims, read_ladders
from cases.gate.proposal import BaselineChange, Proposal, propose
from cases.gate.spread import measured_spreads
from cases.gate.write_permission import write_conditions
from cases.results.files import read_run, require_run, write_verdicts
from cases.results.records.claim import Kind
from cases.results.records.run import CaseResult, RunResult
from cases.results.records.scene_run import SceneRun
from cases.results.status import ExitCode, exit_code
from cases.run.lock import locked
from cases.run.stamp import repository
from contact import InvalidInput
from reports.commands.runs import show_verdict, write_summaries
from reports.terminal import STYLES, console, show_table
from reports.words import Table, small


def run_gate(directory: Path, baselines: Path, *, methods: Collection[str], strict: bool, quiet: bool) -> int:
    """Gate the run in `directory`, write its verdicts and summaries again and return the exit code.

    Pages with figures are drawn by `contact-verify report`: a gate is asked often, and a figure takes half a second.

    Args:
        directory: of the run.
        baselines: folder of the accepted numbers.
        methods: that are gated; if none is named, those that the run was made with.
        strict: whether verdicts that stay open fail.
        quiet: whether only the verdict is shown.

    Raises:
        InvalidInput: if there is no run or no baseline.
    """
    require_run(directory)
    with locked(directory):
        run = read_run(directory)
        result = _gated(run, baselines, methods or run.methods)
        write_verdicts(result, directory)
        write_summaries(result, directory)
    show_verdict(result, directory / "summary.md", quiet=quiet)
    return exit_code(result.statuses, strict=strict) if result.complete else ExitCode.INTERRUPTED


def _gated(run: RunResult, baselines: Path, methods: Collection[str]) -> RunResult:
    accepted = [_of_methods(b, methods) for b in read_baselines(baselines) if not methods or b.method in methods]
    ladders = read_ladders(baselines)
    if not accepted and not ladders:
        raise InvalidInput(f"no baselines in {baselines}; name their folder, or accept a case first")
    library = load_cases() if run.suite != "ci" else {}
    unwatched = {(case.name, *place) for case in library.values() for place in nightly_only(case)}

    def watched(case: str, row: SceneRun) -> bool:
        return (case, row.scene, row.method) not in unwatched and (not methods or row.method in methods)

    return gate(run, accepted, ladders, watched)


def _of_methods(baseline: Baseline, methods: Collection[str]) -> Baseline:
    """The baseline without claims that need other methods than these; the whole of it if none is named.

    An order may be measured against the answer of another method, which an accepted claim does not name.
    """
    if not methods or baseline.claims is None:
        return baseline
    own = (claim for claim in baseline.claims if set(claim.methods) <= set(methods) and claim.kind is not Kind.ORDER)
    return replace(baseline, claims=tuple(own))


@dataclass(frozen=True, kw_only=True)
class AcceptRequest:
    """What the user asks for.

    Attributes:
        reason: why these numbers are right.
        run: folder of the run they come from.
        baselines: folder they are written to.
        loosen: whether a tolerance may grow or a record be withdrawn.
        write: whether to write at all.
        jobs: repetitions at a time.
    """

    reason: str
    run: Path
    baselines: Path
    loosen: bool
    write: bool
    jobs: int


def accept_cases(names: list[str], request: AcceptRequest) -> None:
    """Show for each case (all of the run if none is named) what would change; write it when told to.

    Raises:
        InvalidInput: naming every case that may not be accepted and why; the others are written all the same.
    """
    result = read_run(request.run)
    solved_by = {row.method for case in result.cases for row in case.runs}
    library = {name: with_registered(case, solved_by) for name, case in load_cases().items()}
    ran = [case.name for case in result.cases]
    refused: list[str] = []
    studies = [case for case in result.cases if case.ladders and case.name not in library]
    for study in studies:
        if not names or study.name in names:
            _accept_ladders(study, result, request)
    known = [name for name in names or ran if name not in {study.name for study in result.cases} - set(library)]
    for case in select(library, names=known) if known else ():
        if case.name not in ran:
            raise InvalidInput(f"the run in {request.run} does not have {case.name}; run it first")
        try:
            _accept_case(case, result, request)
        except InvalidInput as error:
            refused.append(str(error))
    if refused:
        raise InvalidInput("\n".join(refused))


def _accept_case(case: Case, result: RunResult, request: AcceptRequest) -> None:
    ran, now, terminal = _watched(case, result), write_conditions(repository(), request.baselines), console()
    reasons_against = refusals_beforehand(case.name, result, now)
    if reasons_against:
        raise InvalidInput(f"{case.name} is not accepted: {'; '.join(reasons_against)}")
    terminal.print(f"{case.name}: repeating every solution with inputs one unit in the last place away ...")
    spreads = measured_spreads(case, {(row.scene, row.method): row for row in ran.runs}, jobs=request.jobs)
    proposal = propose(
        ran, suites=case.suites, accepted=read_baselines(request.baselines), spreads=spreads, reason=request.reason
    )
    show_table(change_table(proposal), on=terminal)
    refused = refusals(proposal, result, now, loosen=request.loosen)
    for reason in refused:
        terminal.print(f"refused: {reason}", style=STYLES["bad"])
    if request.write:
        accept(request.baselines, proposal, result, now, loosen=request.loosen)
        terminal.print(f"{case.name}: written to {request.baselines / case.name}", style=STYLES["good"])
    else:
        terminal.print(f"{case.name}: nothing written; say --write to write it", style=STYLES["warn"])


def _accept_ladders(study: CaseResult, result: RunResult, request: AcceptRequest) -> None:
    """Accept the ladders of a study, or say which rungs would be lost."""
    now = write_conditions(repository(), request.baselines)
    reasons_against = refusals_beforehand(study.name, result, now)
    if reasons_against:
        raise InvalidInput(f"{study.name} is not accepted: {'; '.join(reasons_against)}")
    terminal = console()
    for claim in ladder_claims(study, read_ladders(request.baselines)):
        terminal.print(f"{claim.scene}, {claim.methods[0]}: {claim.message}", markup=False)
    if request.write:
        accept_ladders(request.baselines, study.ladders, loosen=request.loosen)
        terminal.print(f"{study.name}: {len(study.ladders)} ladders written", style=STYLES["good"])
    else:
        terminal.print(f"{study.name}: nothing written; say --write to write it", style=STYLES["warn"])


def _watched(case: Case, result: RunResult) -> CaseResult:
    """The case as it ran, without what only the nightly suite solves: what is accepted is that of the suite ci."""
    ran, unwatched = result.case(case.name), nightly_only(case)
    at_night = {claim.name for claim in case.claims if claim.nightly}
    claims = (claim for claim in ran.claims if claim.name not in at_night)
    return replace(
        ran,
        runs=tuple(row for row in ran.runs if (row.scene, row.method) not in unwatched),
        claims=tuple(c for c in claims if not any((c.scene, method) in unwatched for method in c.methods)),
    )


def change_table(proposal: Proposal) -> Table:
    """Old, new, the change in units of the tolerance and of U; new records are only counted."""
    changed = [change for change in proposal.changes if change.old is not None]
    new = len(proposal.changes) - len(changed)
    return Table(
        title=f"{proposal.case}: {len(changed)} changed, {new} new records",
        note="A tolerance is relative: max(10 x measured spread, 1e-12). U is the method's own numerical uncertainty.",
        heads=("method", "scene", "quantity", "old", "new", "unit", "in tolerances", "in U", "tolerance", "was"),
        rows=tuple(_row(change) for change in changed),
        words=3,
    )


def _row(change: BaselineChange) -> tuple[str, ...]:
    record, (old, new) = change.record, change.values
    return (
        change.method,
        record.scene,
        record.quantity,
        "" if old is None else f"{old:.17g}",
        "withdrawn" if change.new is None else "" if new is None else f"{new:.17g}",
        record.unit,
        _ratio(change.in_tolerances),
        _ratio(change.in_uncertainty),
        f"{small(change.new.tolerance)}{' LOOSENED' if change.loosens else ''}" if change.new else "",
        small(change.old.tolerance) if change.old else "",
    )


def _ratio(value: float | None) -> str:
    return "" if value is None else f"{value:+.3g}"

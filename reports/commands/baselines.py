"""`contact-verify gate` and `accept`: a finished run against the accepted numbers, and new numbers to accept."""

from collections.abc import Collection
from dataclasses import replace
from pathlib import Path
from typing import Any

from cases.answers import Table
from cases.case import Case
from cases.declare.registry import load_cases, select
from cases.foreign import with_registered
from cases.gate.accept import (
    Change,
    Proposal,
    accept,
    accepted_before,
    propose,
    refusals,
    refusals_beforehand,
    write_conditions,
)
from cases.gate.baseline import read_baselines, relative_tolerance
from cases.gate.gate import gate
from cases.gate.spread import measured_spreads
from cases.run.lock import locked
from cases.run.stamp import repository
from cases.runs import Run, read_run, write_run
from cases.verdicts import ExitCode, exit_code
from contact import InvalidInput
from reports import words
from reports.commands.runs import show_verdict, write_summaries
from reports.terminal import STYLES, console, progress_bar, show_table


def run_gate(directory: Path, baselines: Path, *, methods: Collection[str], strict: bool, quiet: bool) -> int:
    """Gate the run in `directory`, write its verdicts and summaries again and return the exit code.

    Pages with figures are drawn by `contact-verify report`: a gate runs often, and a figure takes half a second.

    Args:
        directory: Folder of the run.
        baselines: Folder of the accepted numbers.
        methods: Methods that are gated; if none is named, those that the run was made with.
        strict: Whether verdicts that stay open fail.
        quiet: Whether only the verdict is shown.

    Raises:
        InvalidInput: If there is no run or no baseline.
    """
    read_run(directory)
    with locked(directory), progress_bar("comparing with the accepted numbers"):
        run = read_run(directory)
        result = _gated(run, baselines, methods or run.judged.methods)
        write_run(result.judged, directory)
        write_summaries(result, directory)
    show_verdict(result, directory / "summary.md", quiet=quiet)
    return exit_code(result.statuses, strict=strict) if result.judged.complete else ExitCode.INTERRUPTED


def _gated(run: Run, baselines: Path, methods: Collection[str]) -> Run:
    """The run with verdicts against the baselines, without answers that the suite of the run need not solve."""
    accepted = read_baselines(baselines)
    if not accepted:
        raise InvalidInput(f"no baselines in {baselines}; name their folder, or accept a case first")
    unwatched = {(case.name, *place) for case in load_cases().values() for place in case.nightly_only()}
    if run.judged.suite == "nightly":
        unwatched -= {(a.case, a.scene, a.method) for baseline in accepted for a in baseline.answers}
    return gate(run, accepted, methods=methods, watched=lambda a: (a.case, a.scene, a.method) not in unwatched)


def accept_cases(*, names: list[str], directory: Path, baselines: Path, **options: Any) -> None:
    """Print the changes of the accepted numbers of each case (all of the run if none is named), and write them.

    Args:
        names: Names of cases.
        directory: Folder of the run that the numbers come from.
        baselines: Folder that they are written to.
        options: Arguments reason, loosen, write and jobs of `_accept`; nothing is written without write.

    Raises:
        InvalidInput: With every case that may not be accepted and why; the others are written all the same.
    """
    run = read_run(directory)
    solved_by = {answer.method for answer in run.answers}
    library = {name: with_registered(case, solved_by) for name, case in load_cases().items()}
    ran = [case.name for case in run.judged.cases]
    # The code verification has no accepted numbers.
    watched = {answer.case for answer in run.answers if not answer.variant}
    watched |= {test.case for test in run.judged.stress_tests}
    refused: list[str] = []
    for name in names or [name for name in ran if name in library and name in watched]:
        if name not in ran:
            raise InvalidInput(f"the run in {directory} does not have {name}; run it first")
        try:
            _accept(select(library, names=[name])[0], run, baselines, **options)
        except InvalidInput as error:
            refused.append(str(error))
    if refused:
        raise InvalidInput("\n".join(refused))


def _accept(case: Case, run: Run, baselines: Path, *, reason: str, loosen: bool, write: bool, jobs: int) -> None:
    """Accept a case; one without scenes, such as the stress tests, need not be part of a suite's runs.

    Args:
        case: Case that ran.
        run: Answers and verdicts of the case.
        baselines: Folder that its numbers are written to.
        reason: Why these numbers are right.
        loosen: Whether a tolerance may grow or a record be withdrawn.
        write: Whether to write at all.
        jobs: Repetitions at a time.
    """
    name, now, terminal = case.name, write_conditions(repository(), baselines), console()
    if reasons_against := refusals_beforehand(name, run, now):
        raise InvalidInput(f"{name} is not accepted: {'; '.join(reasons_against)}")
    terminal.print(f"{name}: repeating every solution with inputs one unit in the last place away ...")
    watched, suites = _watched(case, run), case.suites if case.scenes else ()
    with progress_bar("repeating"):
        spreads = measured_spreads(case, watched.answers, jobs=jobs)
    before = accepted_before(baselines, name)
    unsolved = case.nightly_only()
    proposal = propose(watched, name, suites=suites, before=before, spreads=spreads, reason=reason, unsolved=unsolved)
    show_table(change_table(proposal), on=terminal)
    for refusal in refusals(proposal, run, now, loosen=loosen):
        terminal.print(f"refused: {refusal}", style=STYLES["bad"])
    if write:
        accept(baselines, proposal, run, now, loosen=loosen)
        terminal.print(f"{name}: written to {baselines}", style=STYLES["good"])
    else:
        terminal.print(f"{name}: nothing written; say --write to write it", style=STYLES["warn"])


def _watched(case: Case, run: Run) -> Run:
    """The case as it ran, without what only the nightly suite solves: what is accepted is that of the suite ci."""
    unwatched = case.nightly_only()
    at_night = {claim.name for claim in case.claims if claim.nightly}
    verdicts = tuple(
        verdict
        for verdict in run.judged.verdicts
        if verdict.claim not in at_night and not any((verdict.scene, m) in unwatched for m in verdict.methods)
    )
    answers = Table(a for a in run.answers.of_case(case.name) if (a.scene, a.method) not in unwatched)
    return Run(judged=replace(run.judged, verdicts=verdicts), answers=answers)


def change_table(proposal: Proposal) -> words.Table:
    """Old and new values, and their change in units of the tolerance and of U; new records are only counted."""
    changed = [change for change in proposal.changes if change.old is not None]
    new = len(proposal.changes) - len(changed)
    return words.Table(
        title=f"{proposal.case}: {len(changed)} changed, {new} new records",
        note="A tolerance is relative: max(10 x measured spread, 1e-12). U is the method's own numerical uncertainty.",
        heads=("method", "scene", "quantity", "old", "new", "unit", "in tolerances", "in U", "tolerance", "was"),
        rows=tuple(_row(change) for change in changed),
        words=3,
    )


def _row(change: Change) -> tuple[str, ...]:
    """Row of `change_table`: the old and the new value, their difference in tolerances and in U, both tolerances."""
    (shown, *_), (old, new) = [q for q in (change.new, change.old) if q is not None], change.values
    now, was = ("" if q is None else words.small(relative_tolerance(q)) for q in (change.new, change.old))
    return (
        change.method,
        change.scene,
        change.quantity,
        "" if old is None else f"{old:.17g}",
        "withdrawn" if change.new is None else "" if new is None else f"{new:.17g}",
        shown.unit,
        _ratio(change.in_tolerances),
        _ratio(change.in_stated_errors),
        f"{now}{' LOOSENED' if change.loosens else ''}" if now else "",
        was,
    )


def _ratio(value: float | None) -> str:
    return "" if value is None else f"{value:+.3g}"

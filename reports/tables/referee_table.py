"""Solvers of others beside ours: the answer of each on a scene, its error, its own bar, and its price."""

from collections.abc import Iterator

from cases.declare.methods import REFEREES
from cases.judgement.convergence.from_refinement import ESTIMATED
from cases.results.records.claim import Claim, Kind
from cases.results.records.run import CaseResult
from cases.results.records.scene_run import SceneRun
from cases.results.status import Status
from reports.tables.case_tables import last_value
from reports.words import Table, display_name, duration, memory, small

NOTE = (
    "Errors and bars are relative. The error is that of the check against a closed form or the integral equation; the "
    "bar is the solver's own, 'estimated' where it states none and was refined twice to get one. Seconds are those of "
    "one solution, processes that a solver starts counted; memory is at most what is shown."
)


def side_by_side(case: CaseResult) -> Table | None:
    """A block of rows for each scene and quantity that a closed form or the integral equation answers, one a solver."""
    if not any(run.method in REFEREES for run in case.runs):
        return None
    judged = [claim for claim in case.claims if claim.kind is Kind.EXACT]
    runs = {(run.scene, run.method): run for run in case.runs}
    rows: list[tuple[str, ...]] = []
    for scene, quantity in dict.fromkeys((claim.scene, claim.quantity) for claim in judged):
        found = [claim for claim in judged if (claim.scene, claim.quantity) == (scene, quantity)]
        rows += [(f"{scene}: {quantity.replace('_', ' ')}",), *_rows(found, runs)]
    rows += [("skipped",), *_skipped(case)]
    heads = ("solver", "verdict", "answer", "error", "bar", "whose bar", "seconds", "processor", "memory")
    return Table(title="Side by side", note=NOTE, heads=heads, rows=tuple(rows), words=2)


def _rows(claims: list[Claim], runs: dict[tuple[str, str], SceneRun]) -> Iterator[tuple[str, ...]]:
    for claim in claims:
        run = runs[claim.scene, claim.methods[0]]
        if run.status is not Status.SKIP and claim.status is not Status.SKIP:
            yield _row(claim, run)


def _row(claim: Claim, run: SceneRun) -> tuple[str, ...]:
    """One solver; a failed one has no numbers."""
    who, cost = display_name(run.method), run.cost
    if not run.solved or cost is None:
        return who, claim.status.value, run.reason, "", "", "", "", "", ""
    bar = claim.uncertainty.get(run.method)
    estimated = any(note.startswith(ESTIMATED) for note in run.notes)
    return (
        who,
        claim.status.value,
        last_value(run.quantity(claim.quantity)),
        "" if claim.observed is None else small(abs(claim.observed)),
        "none" if bar is None else small(bar),
        "" if bar is None else "estimated" if estimated else "own",
        duration(cost.wall_seconds),
        duration(cost.cpu_seconds),
        memory(cost.peak_memory_bytes),
    )


def _skipped(case: CaseResult) -> Iterator[tuple[str, ...]]:
    """One row for each solver and reason."""
    reasons: dict[tuple[str, str], int] = {}
    for run in case.runs:
        if run.status is Status.SKIP:
            reasons[run.method, run.reason] = reasons.get((run.method, run.reason), 0) + 1
    for (method, reason), scenes in reasons.items():
        words = f"{reason} ({scenes} scene{'s' if scenes > 1 else ''})"
        yield display_name(method), "SKIP", words, "", "", "", "", "", ""

"""`gate --against REVISION`: this source raced against another revision in a worktree of its own, in one job."""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path

from cases.declare.case import Case
from cases.gate.checks.check import regression_claim
from cases.gate.race.race import PAIRS, SLOWEST, judge_race, race
from cases.gate.race.version import CannotSolve, Subject, Version, subject
from cases.gate.race.worktree import worktree
from cases.judgement.rules.judgement import nothing_compared
from cases.results.records.claim import Claim
from cases.results.records.run import RunResult
from cases.results.status import Status

# The folder that holds every package: what is raced against a revision, and what must be committed to be accepted.
SOURCE = Path(__file__).resolve().parents[3]


def with_times_against(
    run: RunResult, revision: str, cases: Iterable[Case], *, repository: Path = SOURCE, pairs: int = PAIRS
) -> RunResult:
    """Return ``run`` with a claim about the time of every method on the first scene it solved of each case.

    What the revision cannot solve yet is skipped, with its words.

    Args:
        run: finished; it says what each method solves.
        revision: what the working tree is raced against, anything git understands.
        cases: declarations of the cases to race; the run has them all.
        repository: the working tree.
        pairs: how often each is timed, at least seven.

    Raises:
        InvalidInput: if there is no such revision, or it is no source of this project.
    """
    claims: dict[str, list[Claim]] = {}
    with ExitStack() as stack:
        base = stack.enter_context(worktree(repository, revision))
        versions = [stack.enter_context(Version(folder)) for folder in (base, repository, base)]
        for what in subjects(run, cases):
            claims.setdefault(what.case, []).append(_claim(versions, what, revision, pairs))
    timed = (replace(case, claims=(*case.claims, *claims.get(case.name, ()))) for case in run.cases)
    return replace(run, cases=tuple(timed))


def subjects(run: RunResult, cases: Iterable[Case]) -> Iterator[Subject]:
    """Yield for every method of every case the first scene it solved in ``run``."""
    for case in cases:
        first = {row.method: row for row in reversed(run.case(case.name).runs) if row.solved}
        for row in reversed(first.values()):
            scene = case.scene(row.scene)
            yield subject(case, scene, case.use(scene, row.method))


def _claim(versions: Sequence[Version], what: Subject, revision: str, pairs: int) -> Claim:
    try:
        finished = race(versions, what, pairs=pairs)
        judged, limit = judge_race(finished), finished.limit
    except CannotSolve as error:
        judged, limit = nothing_compared(Status.SKIP, str(error)), SLOWEST
    return regression_claim(
        f"no slower than {revision}",
        judged,
        scene=what.scene,
        methods=(what.method,),
        quantity="cpu_seconds",
        expected=0.0,
        tolerance=limit - 1,
        source=f"revision {revision}, timed alternately in the same job",
        because="a change should not make solutions slower unnoticed",
        derived_from="max(10 %, 3 d), d from a pair of identical versions timed in the same job",
    )

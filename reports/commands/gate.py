"""`contact-verify gate`: a finished run against the accepted numbers and, if asked, against the speed of a revision."""

from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path

from cases.declare.case import Case
from cases.declare.registry import load_cases, select
from cases.declare.selection import nightly_only
from cases.gate.baseline import Baseline, read_baselines
from cases.gate.gate import gate
from cases.gate.history import read_history
from cases.gate.ladders import read_ladders
from cases.gate.race.against import with_times_against
from cases.gate.race.race import PAIRS
from cases.results.files import read_run, require_run, write_run
from cases.results.records.run import RunResult
from cases.results.records.scene_run import SceneRun
from cases.results.status import ExitCode, exit_code
from cases.run.lock import locked
from contact import InvalidInput
from reports.commands.report import write_pages
from reports.commands.run import show_verdict


@dataclass(frozen=True, kw_only=True)
class Timing:
    """What is timed: against which revision (empty: nothing), which cases of the run (empty: all), how often."""

    revision: str = ""
    cases: tuple[str, ...] = ()
    pairs: int = PAIRS


def run_gate(
    directory: Path, baselines: Path, *, methods: Collection[str], timing: Timing, strict: bool, quiet: bool
) -> int:
    """Gate the run in `directory` (only these `methods`, if any), write its pages again and return the exit code.

    Raises:
        InvalidInput: if there is no run or no baseline, or if the revision cannot be timed.
    """
    accepted = [_of_methods(b, methods) for b in read_baselines(baselines) if not methods or b.method in methods]
    ladders = read_ladders(baselines)
    if not accepted and not ladders:
        raise InvalidInput(f"no baselines in {baselines}; name their folder, or accept a case first")
    unwatched = {(case.name, *place) for case in load_cases().values() for place in nightly_only(case)}

    def watched(case: str, row: SceneRun) -> bool:
        return (case, row.scene, row.method) not in unwatched and (not methods or row.method in methods)

    require_run(directory)
    with locked(directory):
        result = gate(read_run(directory), accepted, read_history(baselines), ladders, watched)
        if timing.revision:
            result = with_times_against(result, timing.revision, _declared(result, timing.cases), pairs=timing.pairs)
        write_run(result, directory)
        write_pages(result, directory)
    show_verdict(result, directory, quiet=quiet)
    return exit_code(result.statuses, strict=strict) if result.complete else ExitCode.INTERRUPTED


def _of_methods(baseline: Baseline, methods: Collection[str]) -> Baseline:
    """The baseline without claims that need other methods than these; the whole of it if none is named."""
    if not methods or baseline.claims is None:
        return baseline
    return replace(baseline, claims=tuple(claim for claim in baseline.claims if set(claim.methods) <= set(methods)))


def _declared(result: RunResult, wanted: tuple[str, ...]) -> tuple[Case, ...]:
    """The declarations of the cases asked for, or of all the run has; one that left the library cannot be timed."""
    library, ran = load_cases(), [case.name for case in result.cases]
    missing = [name for name in wanted if name not in ran]
    if missing:
        raise InvalidInput(f"the run does not have {missing[0]}; it has {', '.join(ran)}")
    return select(library, names=wanted or [name for name in ran if name in library])

"""`contact-verify gate`: a finished run against the accepted numbers."""

from collections.abc import Collection
from dataclasses import replace
from pathlib import Path

from cases.declare.registry import load_cases
from cases.declare.selection import nightly_only
from cases.gate.baseline import Baseline, read_baselines
from cases.gate.gate import gate
from cases.gate.ladders import read_ladders
from cases.results.files import read_run, require_run, write_verdicts
from cases.results.records.claim import Kind
from cases.results.records.run import RunResult
from cases.results.records.scene_run import SceneRun
from cases.results.status import ExitCode, exit_code
from cases.run.lock import locked
from contact import InvalidInput
from reports.commands.report import write_summaries
from reports.commands.run import show_verdict


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

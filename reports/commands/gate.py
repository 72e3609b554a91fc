"""`contact-verify gate`: a finished run against the accepted numbers and, if asked, against the speed of a revision."""

from pathlib import Path

from cases.case import Case
from cases.gate.against import with_times_against
from cases.gate.baseline import read_baselines
from cases.gate.gate import gate
from cases.gate.history import read_history
from cases.gate.race import PAIRS
from cases.registry import load_cases, select
from cases.results import RunResult
from cases.results_files import read_run, write_run
from cases.status import ExitCode, exit_code
from contact import InvalidInput
from reports.commands.report import write_pages
from reports.commands.run import show_verdict


def run_gate(directory: Path, baselines: Path, *, against: str, pairs: int = PAIRS, strict: bool, quiet: bool) -> int:
    """Gate the run in `directory`, write its pages again and return the exit code.

    Raises:
        InvalidInput: if there is no run or no baseline, or if the revision cannot be timed.
    """
    accepted = read_baselines(baselines)
    if not accepted:
        raise InvalidInput(f"no baselines in {baselines}; name their folder, or accept a case first")
    result = gate(read_run(directory), accepted, read_history(baselines))
    if against:
        result = with_times_against(result, against, _declared(result), pairs=pairs)
    write_run(result, directory)
    write_pages(result, directory)
    show_verdict(result, directory, quiet=quiet)
    return exit_code(result.statuses, strict=strict) if result.complete else ExitCode.INTERRUPTED


def _declared(result: RunResult) -> tuple[Case, ...]:
    """The declarations of the cases that this run has; a case that left the library cannot be timed."""
    library = load_cases()
    return select(library, names=[case.name for case in result.cases if case.name in library])

"""`contact-verify cost`: time the settings of every method, write the folder and the page of a run."""

from dataclasses import replace

from cases.declare.case import Case
from cases.declare.methods import check_known, registered
from cases.declare.registry import load_cases, select
from cases.results.status import Status
from cases.run.lock import locked
from cases.run.runner import RunOptions, run_cases
from contact import InvalidInput
from reports.commands.report import write_pages
from reports.tables.cost_tables import shortest_times, speed_ups
from reports.terminal.progress import RunDisplay
from reports.terminal.terminal import console, show_table

FAILED = 1


def cost(names: list[str], options: RunOptions, *, methods: list[str], quiet: bool) -> int:
    """Time the work studies of cases (only these methods, if any) alone on the machine; 1 if a reference broke down.

    Raises:
        InvalidInput: if no study times such a method.
    """
    for method in methods:
        check_known(method)
    chosen = select(load_cases(), names=names, suite=options.suite)
    timed = [case for case in (_of_methods(case, methods) for case in chosen) if case.work]
    if methods and not timed:
        raise InvalidInput(f"{', '.join(case.name for case in chosen)}: nothing times {' or '.join(methods)} there")
    options = replace(options, methods=tuple(methods))
    terminal = console()
    with locked(options.out):
        with RunDisplay(terminal, quiet=quiet) as display:
            result = run_cases(timed, replace(options, only_costs=True, progress=display))
        write_pages(result, options.out)
    for table in (shortest_times(result), speed_ups(result)):
        if table is not None:
            show_table(table, on=terminal)
    terminal.print(f"report: {options.out / 'report.html'}")
    missing = [case for case in result.cases if not case.work_precision]
    return FAILED if missing or any(s is Status.INVALID for s in result.statuses) else 0


def _of_methods(case: Case, methods: list[str]) -> Case:
    """The case with the studies that time these methods, those of installed packages as they are."""
    if not methods:
        return case
    foreign = [name for name in registered() if name in methods]
    studies = (study.of_methods(methods, foreign) for study in case.work)
    return replace(case, work=tuple(study for study in studies if study.ladder))

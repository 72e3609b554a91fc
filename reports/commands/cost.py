"""`contact-verify cost`: time the settings of every method, write the folder and the page of a run."""

from dataclasses import replace

from cases.declare.case import Case
from cases.declare.foreign.settings import Settings, ladder, read_settings
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


def cost(names: list[str], options: RunOptions, *, methods: list[str], settings: list[str], quiet: bool) -> int:
    """Time the work studies of cases (only these methods, if any) alone on the machine; 1 if a reference broke down.

    A setting that is a list is a ladder of an installed package's method.

    Raises:
        InvalidInput: if no study times such a method.
    """
    for method in methods:
        check_known(method)
    chosen = select(load_cases(), names=names, suite=options.suite)
    asked = read_settings(settings, methods)
    timed = [case for case in (_of_methods(case, methods, asked) for case in chosen) if case.work]
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


def _of_methods(case: Case, methods: list[str], settings: Settings) -> Case:
    """The case with the studies that time these methods, those of installed packages with the settings asked for."""
    if not methods:
        return case
    rungs = [rung for name in registered() if name in methods for rung in ladder(name, settings.get(name, {}))]
    studies = (study.of_methods(methods, rungs) for study in case.work)
    return replace(case, work=tuple(study for study in studies if study.ladder))

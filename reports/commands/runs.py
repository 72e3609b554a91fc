"""`contact-verify run` and `report`: solve cases or list them, write results and pages, print the verdict."""

import dataclasses
import os
from collections.abc import Sequence
from pathlib import Path

from rich.padding import Padding
from rich.text import Text

from cases.declare.against import against, beside
from cases.declare.case import USUAL_SUITES, Case
from cases.declare.foreign.settings import Settings, ladder, read_settings, with_settings
from cases.declare.foreign_methods import with_registered
from cases.declare.methods import check_known, registered
from cases.declare.registry import load_cases, select
from cases.declare.selection import only_methods
from cases.measurements.ladders.ladder_study import CLIMBERS, chosen, ladder_case
from cases.measurements.ladders.ladder_table import LADDERS
from cases.measurements.suites import SuiteStudies, run_of
from cases.results.compare_runs import compare
from cases.results.files import read_run, require_run, write_whole
from cases.results.records.run import RunResult
from cases.results.status import ExitCode, Status, exit_code
from cases.run.executors import by_name
from cases.run.lock import locked
from cases.run.runner import RunOptions, run_cases
from contact import InvalidInput
from contact.records.extras import missing_extra
from reports.pages.annotations import annotation_lines
from reports.pages.junit import junit_text
from reports.pages.matrix import run_matrix
from reports.pages.moves import moves
from reports.pages.one_factor import one_factor
from reports.pages.outcomes import headline, nothing_ran, outcomes
from reports.pages.summary import summary_text
from reports.progress import RunDisplay
from reports.tables.cost_tables import shortest_times, speed_ups
from reports.tables.declaration_tables import claim_table, method_table, scene_table
from reports.terminal import STYLES, console, show_table
from reports.words import Table, display_name

# What methods of installed packages are compared with when no other method is named.
REFEREE = "mdr"
# The terminal shows so many failed checks; the page shows all.
WORST_SHOWN = 12


def run(
    names: list[str],
    *,
    methods: list[str],
    others: list[str],
    settings: list[str],
    options: RunOptions,
    executor: str,
    quiet: bool,
    strict: bool,
) -> int:
    """Run cases and return the exit code.

    Args:
        names: of cases; all of the suite if none.
        methods: that solve them; all of the project if none.
        others: methods that these are compared with, and with nothing else.
        settings: of methods of installed packages, in words or files.
        options: of the run.
        executor: where solutions are computed.
        quiet: whether only the verdict is shown.
        strict: whether verdicts that stay open fail.
    """
    foreign = bool(methods) and set(methods) <= set(registered())
    asked = read_settings(settings, methods)
    if others:
        cases = list(_against(names, methods, others, options.suite))
    elif foreign:
        cases = [beside(case, methods, REFEREE) for case in _chosen(methods, names, options.suite)]
    else:
        chosen = _chosen(methods, names, options.suite)
        # Of a suite those cases run that have one of the methods.
        solved = [case for case in chosen if not methods or any(use.label in methods for use in case.methods)]
        cases = [only_methods(case, methods) for case in ((not names and solved) or chosen)]
    cases = [with_settings(case, asked) for case in cases]
    options = dataclasses.replace(
        options, methods=tuple(dict.fromkeys((*methods, *others))), executor=by_name(executor)
    )
    studied = options.suite in USUAL_SUITES and not names and not methods
    with locked(options.out):
        result = _carried_out(cases, options, studied, quiet=quiet)
        write_pages(result, options.out)
    show_verdict(result, page_of(options.out), quiet=quiet)
    if not result.complete:
        return ExitCode.INTERRUPTED
    code = exit_code(result.statuses, strict=strict)
    return ExitCode.NOTHING_RAN if result.unjudged and code is not ExitCode.GATE_FAILED else code


def _chosen(methods: list[str], names: list[str], suite: str) -> tuple[Case, ...]:
    """The cases of a suite, open to those of the methods that are of installed packages."""
    library = {name: with_registered(case, methods) for name, case in load_cases().items()}
    return select(library, names=names, suite=suite)


def _against(names: list[str], methods: list[str], others: list[str], suite: str) -> Sequence[Case]:
    """The cases of a suite, with all their scenes, as comparisons of methods with others."""
    library = load_cases()
    chosen = [library[case.name] for case in select(library, names=names, suite=suite)]
    return against(chosen, methods, others)


def _carried_out(cases: Sequence[Case], options: RunOptions, studied: bool, *, quiet: bool) -> RunResult:
    """Run cases and, if this is a whole suite, its studies."""
    with SuiteStudies(options.suite, options.executor, options.jobs) as studies:
        solved = studies.begin if studied else options.solved
        with RunDisplay(console(), quiet=quiet) as display:
            result = run_cases(cases, dataclasses.replace(options, progress=display, solved=solved))
        return studies.join(result, options.out) if studied and result.complete else result


def show_verdict(result: RunResult, page: Path, *, quiet: bool) -> None:
    """Matrix and worst rows (unless quiet), the verdict, where the report lies, annotations for GitHub."""
    terminal = console()
    rows = outcomes(result)
    if not quiet:
        show_table(matrix_table(result), on=terminal)
    for sentence in moves(result):
        terminal.print(sentence)
    failed = [row for row in rows if row.tone == "bad"][:WORST_SHOWN]
    for row in failed:
        terminal.print(Text.assemble((row.word, STYLES["bad"]), f" {row.case}: {row.place} ({row.who}): {row.message}"))
    for sentence in one_factor(result):
        terminal.print(sentence)
    words, tone = headline(result, rows)
    terminal.print(words, style=STYLES[tone])
    terminal.print(f"report: {page}")
    if os.environ.get("GITHUB_ACTIONS") == "true":
        for line in annotation_lines(result):
            terminal.print(line, soft_wrap=True)


def matrix_table(result: RunResult) -> Table:
    """The matrix case x kind of claim as words."""
    matrix = run_matrix(result)
    rows = tuple(
        (name, *(f"{cell.word} {cell.fraction}".strip() if cell else "" for cell in cells))
        for name, cells in matrix.rows
    )
    note = "The worst check of each kind with the fraction of its tolerance."
    return Table(title="", note=note, heads=("case", *matrix.columns), rows=rows, words=1 + len(matrix.columns))


def list_cases(names: list[str], suite: str) -> None:
    """Print the cases of a suite, or all; a single named one in full.

    Raises:
        InvalidInput: naming the case and what is wrong with it.
    """
    library = {name: with_registered(case) for name, case in load_cases().items()}
    cases = select(library, names=names, suite=suite)
    if len(names) == 1:
        _show_case(*cases)
        return
    tasks = sum(1 for case in cases for _ in case.tasks())
    claims = sum(len(case.claims) for case in cases)
    table = Table(
        title="",
        note=f"{len(cases)} cases, {claims} claims, {tasks} solutions: all valid. run --list CASE shows one in full.",
        heads=("case", "suites", "methods", "scenes", "claims", "question"),
        rows=tuple(_line(case) for case in cases),
        words=6,
    )
    show_table(table, on=console())


def _line(case: Case) -> tuple[str, ...]:
    methods = ", ".join(display_name(use.label) for use in case.methods)
    return case.name, ", ".join(case.suites), methods, f"{len(case.scenes)}", f"{len(case.claims)}", case.question


def _show_case(case: Case) -> None:
    """Print a case as a short paper: question, equations, text, scenes, methods, claims."""
    terminal = console()
    terminal.print(Text(case.title, style="bold"))
    terminal.print(Text(f"{case.question}  [{', '.join(case.equations)}]\n"))
    for paragraph in case.text.split("\n\n"):
        terminal.print(Padding(Text(" ".join(paragraph.split())), (0, 0, 1, 0)))
    for table in (scene_table(case), method_table(case), claim_table(case)):
        show_table(table, on=terminal)
        terminal.print()


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
    options = dataclasses.replace(options, methods=tuple(methods))
    terminal = console()
    with locked(options.out):
        with RunDisplay(terminal, quiet=quiet) as display:
            result = run_cases(timed, dataclasses.replace(options, only_costs=True, progress=display))
        write_pages(result, options.out)
    for table in (shortest_times(result), speed_ups(result)):
        if table is not None:
            show_table(table, on=terminal)
    terminal.print(f"report: {options.out / 'report.html'}")
    missing = [case for case in result.cases if not case.work_precision]
    return ExitCode.GATE_FAILED if missing or any(s is Status.INVALID for s in result.statuses) else 0


def _of_methods(case: Case, methods: list[str], settings: Settings) -> Case:
    """The case with the studies that time these methods, those of installed packages with the settings asked for."""
    if not methods:
        return case
    rungs = [rung for name in registered() if name in methods for rung in ladder(name, settings.get(name, {}))]
    studies = (study.of_methods(methods, rungs) for study in case.work)
    return dataclasses.replace(case, work=tuple(study for study in studies if study.ladder))


def stress(names: list[str], methods: list[str], options: RunOptions, *, quiet: bool) -> int:
    """Carry out stress tests (all if none is named) by these methods, MDR if none is named; 1 if one failed."""
    plans, climbers = chosen(LADDERS, names), {name: CLIMBERS.get(name, {}) for name in methods or ["mdr"]}
    terminal = console()

    def say(line: str) -> None:
        if not quiet:
            terminal.print(line, soft_wrap=True)

    with locked(options.out):
        result = run_of((ladder_case(plans, climbers, progress=say) for _ in range(1)), options.out)
        write_pages(result, options.out)
    terminal.print(f"report: {page_of(options.out)}")
    return exit_code(result.statuses)


def rebuild(directory: Path, *, single_file: bool = False) -> int:
    """Write the pages of the run in `directory` again; return 5 if nothing ran in it, else 0."""
    require_run(directory)
    with locked(directory):
        run = read_run(directory)
        write_pages(run, directory, single_file=single_file)
    words, tone = headline(run, outcomes(run))
    console().print(words, style=STYLES[tone])
    console().print(f"report: {directory / 'report.html'}")
    return _code(run)


def _code(*runs: RunResult) -> ExitCode:
    return ExitCode.NOTHING_RAN if any(nothing_ran(run) for run in runs) else ExitCode.PASSED


# Processes that draw figures.
DRAWERS = 2


def write_pages(run: RunResult, directory: Path, *, single_file: bool = False) -> None:
    """report.html with a page for each case and figures, summary.md and junit.xml.

    Where the packages of pages are not installed, the numbers, summary and junit.xml stand without them.
    """
    try:
        from reports.pages.report import write_report  # noqa: PLC0415 - an extra brings what it draws with
    except ModuleNotFoundError as error:
        if not missing_extra(error):
            raise
        console(stderr=True).print(f"no pages: {missing_extra(error)}, then contact-verify report {directory}")
    else:
        write_report(run, directory, jobs=DRAWERS, single_file=single_file)
    write_summaries(run, directory)


def write_summaries(run: RunResult, directory: Path) -> None:
    """Write summary.md and junit.xml."""
    write_whole(directory / "summary.md", summary_text(run))
    write_whole(directory / "junit.xml", junit_text(run))


def page_of(directory: Path) -> Path:
    """Where a reader begins: the report, or the summary where no pages could be drawn."""
    report = directory / "report.html"
    return report if report.is_file() else directory / "summary.md"


# The terminal shows so many of the numbers that moved; the page shows more.
ROWS_IN_TERMINAL = 20


def compare_runs(first: Path, second: Path) -> int:
    """Compare the run in `second` with that in `first`; the page lands beside the second; 5 if nothing ran in one."""
    from reports.pages import comparison as pages  # noqa: PLC0415 - as above

    runs = read_run(first), read_run(second)
    comparison = compare(*runs)
    page = second / "comparison.html"
    pages.write_comparison(comparison, runs, page)
    words, tone = pages.headline(comparison)
    terminal = console()
    terminal.print(words, style=STYLES[tone])
    for table in (pages.claim_table(comparison.claims), pages.number_table(comparison.numbers, most=ROWS_IN_TERMINAL)):
        if table is not None:
            show_table(table, on=terminal)
    terminal.print(f"comparison: {page}")
    return _code(*runs)

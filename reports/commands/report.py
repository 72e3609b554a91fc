"""`contact-verify report`: pages from stored results, nothing computed."""

from pathlib import Path

from cases.results.compare_runs import compare
from cases.results.files import read_run, require_run, write_whole
from cases.results.records.run import RunResult
from cases.results.status import ExitCode
from cases.run.lock import locked
from contact.records.extras import missing_extra
from reports.pages.junit import junit_text
from reports.pages.summary import summary_text
from reports.terminal.terminal import STYLES, console, show_table
from reports.words import outcomes


def rebuild(directory: Path, *, single_file: bool = False) -> int:
    """Write the pages of the run in `directory` again; return 5 if nothing ran in it, else 0."""
    require_run(directory)
    with locked(directory):
        run = read_run(directory)
        write_pages(run, directory, single_file=single_file)
    words, tone = outcomes.headline(run, outcomes.outcomes(run))
    console().print(words, style=STYLES[tone])
    console().print(f"report: {directory / 'report.html'}")
    return _code(run)


def _code(*runs: RunResult) -> ExitCode:
    return ExitCode.NOTHING_RAN if any(outcomes.nothing_ran(run) for run in runs) else ExitCode.PASSED


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
    from reports.pages.comparison import claim_table, headline, number_table, write_comparison  # noqa: PLC0415 - as above

    runs = read_run(first), read_run(second)
    comparison = compare(*runs)
    page = second / "comparison.html"
    write_comparison(comparison, runs, page)
    words, tone = headline(comparison)
    terminal = console()
    terminal.print(words, style=STYLES[tone])
    for table in (claim_table(comparison.claims), number_table(comparison.numbers, most=ROWS_IN_TERMINAL)):
        if table is not None:
            show_table(table, on=terminal)
    terminal.print(f"comparison: {page}")
    return _code(*runs)

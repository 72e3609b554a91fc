"""`contact-verify run` and `report`: solve cases or list them, write results and pages, print the verdict."""

import dataclasses
import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from rich.padding import Padding
from rich.text import Text

from cases.case import Case
from cases.declare.methods import check_known, registered
from cases.declare.registry import load_cases, select
from cases.declare.settings import Settings, ladder, read_settings, with_settings
from cases.foreign import against, beside, with_registered
from cases.run.executors import by_name
from cases.run.lock import locked
from cases.run.runner import RunOptions, plan, run_cases
from cases.runs import Run, read_run
from cases.verdicts import ExitCode, Status, exit_code
from contact import InvalidInput
from contact.files.whole import write_whole
from contact.records.extras import missing_extra
from reports import comparison
from reports.book import claim_table, method_table, scene_table
from reports.ci import annotation_lines, junit_text, summary_text
from reports.findings import causes, findings, headline, tone_of, who
from reports.progress import run_progress
from reports.tables import matrix_table, shortest_times, stress_tests
from reports.terminal import STYLES, console, progress_bar, show_table
from reports.words import tabulated

# Method with which methods of installed packages are compared when no other one is named.
REFERENCE = "mdr"
# The terminal shows so many failed checks; the page shows all.
WORST_SHOWN = 12


def run(
    *,
    names: list[str],
    suite: str,
    methods: list[str],
    others: list[str],
    settings: list[str],
    executor: str,
    only: str,
    listed: bool,
    strict: bool,
    quiet: bool,
    **options: Any,
) -> int:
    """Run cases, list them, or carry out a part of a run alone, and return the exit code.

    Args:
        names: Names of cases; all of the suite if none.
        suite: Name of a suite, or empty.
        methods: Methods that solve the cases; all of the project if none.
        others: Methods that these are compared with, and with nothing else.
        settings: Settings of methods of installed packages, in words or files.
        executor: Where solutions run, in words.
        only: "cost", "stability" or empty.
        listed: Whether the cases are listed instead.
        strict: Whether verdicts that stay open fail.
        quiet: Whether the verdict alone is shown.
        options: Folder, jobs, resume, time limit and timing, as in `RunOptions`.
    """
    if listed:
        return list_cases(names, suite)
    run_options = RunOptions(suite=suite, methods=tuple(dict.fromkeys((*methods, *others))), **options)
    values = read_settings(settings, methods)
    if only:
        return measure(only, names, methods, values, run_options, quiet=quiet)
    cases = [with_settings(case, values) for case in _cases(names, methods, others, suite)]
    result = _solved(cases, dataclasses.replace(run_options, executor=by_name(executor)), quiet=quiet)
    show_verdict(result, page_of(run_options.out), quiet=quiet)
    if not result.judged.complete:
        return ExitCode.INTERRUPTED
    code = exit_code(result.statuses, strict=strict)
    return ExitCode.NOTHING_RAN if result.unjudged and code is not ExitCode.GATE_FAILED else code


def _solved(cases: Sequence[Case], options: RunOptions, *, quiet: bool) -> Run:
    """Solve and judge cases with their progress shown, and write the pages; no other run may use the folder."""
    with locked(options.out):
        with run_progress(quiet=quiet) as progress:
            result = run_cases(cases, dataclasses.replace(options, progress=progress))
        write_pages(result, options.out)
    return result


def _cases(names: list[str], methods: list[str], others: list[str], suite: str) -> Sequence[Case]:
    """The cases that are named, open to methods of installed packages."""
    library = load_cases()
    if others:
        return against([library[case.name] for case in select(library, names=names, suite=suite)], methods, others)
    cases = select({name: with_registered(case, methods) for name, case in library.items()}, names=names, suite=suite)
    if methods and set(methods) <= set(registered()):
        return [beside(case, methods, REFERENCE) for case in cases]
    # Of a suite those cases run that have one of the methods.
    solved = [case for case in cases if not methods or any(use.label in methods for use in case.methods)]
    chosen = [case.only_methods(methods) for case in ((not names and solved) or cases)]
    return [case for case in chosen if names or next(case.tasks(), None) is not None]


def show_verdict(run: Run, page: Path, *, quiet: bool) -> None:
    """Print the matrix (unless quiet), the worst findings, causes, the verdict, the page, and annotations on GitHub."""
    terminal = console()
    if not quiet:
        show_table(matrix_table(run), on=terminal)
    for finding in [finding for finding in findings(run) if finding.tone == "bad"][:WORST_SHOWN]:
        terminal.print(Text.assemble((finding.word, STYLES["bad"]), f" {finding.sentence}: {finding.message}"))
    for sentence in causes(run):
        terminal.print(sentence)
    words, tone = headline(run)
    terminal.print(words, style=STYLES[tone])
    terminal.print(f"report: {page}")
    if os.environ.get("GITHUB_ACTIONS") == "true":
        for line in annotation_lines(run):
            terminal.print(line, soft_wrap=True)


def list_cases(names: list[str], suite: str) -> int:
    """Print the cases of a suite, or all; a single named one in full. Returns the exit code.

    Raises:
        InvalidInput: With the name of the case and the mistake in it.
    """
    library = {name: with_registered(case) for name, case in load_cases().items()}
    cases = select(library, names=names, suite=suite)
    if len(names) == 1:
        _show_case(*cases)
        return ExitCode.PASSED
    with progress_bar("checking cases"):
        tasks = len(plan(cases))
    claims = sum(len(case.claims) for case in cases)
    columns: dict[str, Callable[[Case], str]] = {
        "case": lambda case: case.name,
        "suites": lambda case: ", ".join(case.suites),
        "methods": lambda case: who((use.label for use in case.methods), ", "),
        "scenes": lambda case: f"{len(case.scenes)}",
        "claims": lambda case: f"{len(case.claims)}",
        "question": lambda case: case.question,
    }
    note = f"{len(cases)} cases, {claims} claims, {tasks} solutions: all valid. run --list CASE shows one in full."
    if (table := tabulated(cases, columns, title="", note=note, words=6)) is not None:
        show_table(table, on=console())
    return ExitCode.PASSED


def _show_case(case: Case) -> None:
    """Print a case as a short paper: question, equations, text, scenes, methods, claims."""
    terminal = console()
    terminal.print(Text(case.title, style="bold"))
    terminal.print(Text(f"{case.question}  [{', '.join(case.equations)}]\n"))
    for paragraph in case.text.split("\n\n"):
        terminal.print(Padding(Text(" ".join(paragraph.split())), (0, 0, 1, 0)))
    for table in (scene_table(case), method_table(case), claim_table(case)):
        if table.rows:
            show_table(table, on=terminal)
            terminal.print()


def measure(
    only: str, names: list[str], methods: list[str], settings: Settings, options: RunOptions, *, quiet: bool
) -> int:
    """Carry out the studies of cost of cases ("cost") or stress tests ("stability"), and print their table.

    Returns:
        The exit code, 1 if a reference of a study broke down or a stress test failed.
    """
    times = only == "cost"
    cases = _timed(names, methods, settings, options.suite) if times else [_stress_tests(names, methods)]
    result = _solved(cases, dataclasses.replace(options, only_costs=times), quiet=quiet)
    if (table := shortest_times(result) if times else stress_tests(result.judged.stress_tests)) is not None:
        show_table(table, on=console())
    console().print(f"report: {page_of(options.out)}")
    if not times:
        return exit_code(result.statuses)
    missing = {case.name for case in result.judged.cases} - {cost.case for cost in result.judged.costs}
    return ExitCode.GATE_FAILED if missing or Status.INVALID in result.statuses else ExitCode.PASSED


def _timed(names: list[str], methods: list[str], settings: Settings, suite: str) -> list[Case]:
    """The cases with the studies that time these methods, all if none is named.

    A setting of an installed package's method that is a list has one value per timed setting.

    Raises:
        InvalidInput: If no study times such a method.
    """
    for method in methods:
        check_known(method)
    cases = list(select(load_cases(), names=names, suite=suite))
    if methods:
        uses = [use for name in registered() if name in methods for use in ladder(name, settings.get(name, {}))]
        studies = [[s for cost in case.costs if (s := cost.of_methods(methods, uses)).ladder] for case in cases]
        pairs = zip(cases, studies, strict=True)
        cases = [dataclasses.replace(case, claims=tuple(own), restricted=True) for case, own in pairs]
    if methods and not any(case.costs for case in cases):
        raise InvalidInput(f"{', '.join(case.name for case in cases)}: nothing times {' or '.join(methods)} there")
    return [case for case in cases if case.costs]


def _stress_tests(names: list[str], methods: list[str]) -> Case:
    """The stress tests of these names (all if none is named) by these methods, MDR if none is named.

    Raises:
        InvalidInput: If no test has such a name.
    """
    case = load_cases()["stability"].only_methods(methods or ["mdr"])
    chosen = tuple(test for test in case.claims if not names or any(name in test.name for name in names))
    if not chosen:
        raise InvalidInput(f"no stress test {names[0]!r}; there are {', '.join(test.name for test in case.claims)}")
    return dataclasses.replace(case, claims=chosen)


def report(directory: Path, other: Path | None = None, *, single_file: bool = False) -> int:
    """Write the pages of a run again, or compare a second run with it; return 5 if nothing ran in one, else 0."""
    if other is not None:
        return compare_runs(directory, other)
    read_run(directory)
    with locked(directory):
        result = read_run(directory)
        write_pages(result, directory, single_file=single_file)
    words, tone = headline(result)
    console().print(words, style=STYLES[tone])
    console().print(f"report: {page_of(directory)}")
    return _code(result)


def _code(*runs: Run) -> ExitCode:
    """NOTHING_RAN if a run has neither a check that was carried out nor a measurement, else PASSED."""
    empty = (not run.judged.costs and all(status is Status.SKIP for status in run.statuses) for run in runs)
    return ExitCode.NOTHING_RAN if any(empty) else ExitCode.PASSED


def write_pages(run: Run, directory: Path, *, single_file: bool = False) -> None:
    """report.html with a page per case and figures, summary.md and junit.xml.

    Where the packages of pages are not installed, the numbers, summary and junit.xml stand without them.
    """
    try:
        from reports.page import write_report  # noqa: PLC0415 - an extra brings what it draws with
    except ModuleNotFoundError as error:
        if not missing_extra(error):
            raise
        console(stderr=True).print(f"no pages: {missing_extra(error)}, then contact-verify report {directory}")
    else:
        with progress_bar("drawing pages"):
            write_report(run, directory, single_file=single_file)
    write_summaries(run, directory)


def write_summaries(run: Run, directory: Path) -> None:
    """Write summary.md and junit.xml."""
    write_whole(directory / "summary.md", summary_text(run))
    write_whole(directory / "junit.xml", junit_text(run))


def page_of(directory: Path) -> Path:
    """First page for a reader: the report, or the summary where no pages could be drawn."""
    report = directory / "report.html"
    return report if report.is_file() else directory / "summary.md"


def compare_runs(first: Path, second: Path) -> int:
    """Compare the second run with the first, write the page into its folder, and return 5 if nothing ran in one."""
    from reports.page import write_comparison  # noqa: PLC0415 - an extra brings what it draws with

    runs = read_run(first), read_run(second)
    claims, numbers = comparison.changed_claims(*runs), comparison.changed_numbers(*runs)
    changes = comparison.worst_first(claims + numbers)
    words, tone = comparison.headline(claims, numbers)
    write_comparison(changes, (words, tone), runs, second / "comparison.html")
    console().print(words, style=STYLES[tone])
    for verdict in changes[:WORST_SHOWN]:
        place = f"{verdict.case}: {verdict.claim} [{verdict.scene}] ({who(verdict.methods)})"
        console().print(Text.assemble((verdict.word, STYLES[tone_of(verdict.status)]), f" {place}: {verdict.message}"))
    console().print(f"comparison: {second / 'comparison.html'}")
    return _code(*runs)

"""`contact-verify run`: carry out cases, write results and pages, print the verdict, answer with the exit code."""

import dataclasses
import os
from collections.abc import Sequence
from pathlib import Path

from rich.text import Text

from cases.declare.against import against, beside
from cases.declare.case import USUAL_SUITES, Case
from cases.declare.foreign.settings import read_settings, with_settings
from cases.declare.foreign_methods import with_registered
from cases.declare.methods import registered
from cases.declare.registry import load_cases, select
from cases.declare.selection import only_methods
from cases.measurements.suites import SuiteStudies
from cases.results.records.run import RunResult
from cases.results.status import ExitCode, exit_code
from cases.run.executors import by_name
from cases.run.lock import locked
from cases.run.runner import RunOptions, run_cases
from reports.commands.report import page_of, write_pages
from reports.pages.annotations import annotation_lines
from reports.pages.matrix import run_matrix
from reports.tables.table import Table
from reports.terminal.progress import RunDisplay
from reports.terminal.terminal import STYLES, console, show_table
from reports.words.moves import moves
from reports.words.one_factor import one_factor
from reports.words.outcomes import headline, outcomes

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

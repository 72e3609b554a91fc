"""`contact-verify run`: carry out cases, write results and pages, print the verdict, answer with the exit code."""

import dataclasses
import os
from collections.abc import Collection
from pathlib import Path

from rich.text import Text

from cases.case import Case, CaseScene
from cases.claims.declared import DeclaredClaim, PerMethod
from cases.executors import by_name
from cases.registry import load_cases, select
from cases.results import RunResult
from cases.runner import RunOptions, run_cases
from cases.status import ExitCode, exit_code
from contact import InvalidInput
from reports.annotations import annotation_lines
from reports.commands.report import write_pages
from reports.matrix import run_matrix
from reports.outcomes import headline, outcomes
from reports.progress import RunDisplay
from reports.tables import Table
from reports.terminal import STYLES, console, show_table

WORST_SHOWN = 12


def run(
    names: list[str],
    *,
    methods: list[str],
    options: RunOptions,
    executor: str,
    quiet: bool,
    strict: bool,
) -> int:
    """Run cases and return the exit code."""
    chosen = select(load_cases(), names=names, suite=options.suite)
    cases = [only_methods(case.in_suite(options.suite), methods) for case in chosen]
    terminal = console()
    with RunDisplay(terminal, quiet=quiet) as display:
        result = run_cases(cases, dataclasses.replace(options, executor=by_name(executor), progress=display))
    write_pages(result, options.out)
    show_verdict(result, options.out, quiet=quiet)
    if not result.complete:
        return ExitCode.INTERRUPTED
    return exit_code(result.statuses, strict=strict)


def only_methods(case: Case, wanted: Collection[str]) -> Case:
    """The case with the methods asked for and the claims these can answer; without timings and figures of others.

    Raises:
        InvalidInput: if the case has none of the methods, or no claim is left.
    """
    if not wanted:
        return case
    methods = tuple(use for use in case.methods if use.label in wanted)
    if not methods:
        known = ", ".join(use.label for use in case.methods)
        raise InvalidInput(f"case {case.name} has no method {' or '.join(wanted)}; it has {known}")
    scenes = tuple(kept for scene in case.scenes for kept in _narrowed_scene(scene, wanted))
    names = {scene.name for scene in scenes}
    claims = tuple(kept for claim in case.claims for kept in _narrowed_claim(case, claim, wanted, names))
    return dataclasses.replace(case, methods=methods, scenes=scenes, claims=claims, work=(), figures=())


def _narrowed_scene(scene: CaseScene, wanted: Collection[str]) -> list[CaseScene]:
    """The scene with its own methods narrowed; nothing if they are all others."""
    own = tuple(use for use in scene.methods if use.label in wanted)
    return [dataclasses.replace(scene, methods=own)] if own or not scene.methods else []


def _narrowed_claim(
    case: Case, claim: DeclaredClaim, wanted: Collection[str], scenes: Collection[str]
) -> list[DeclaredClaim]:
    """The claim on the scenes left, if it needs no other method or can be narrowed to single ones; else nothing."""
    left = tuple(name for name in claim.scenes if name in scenes)
    if claim.scenes and not left:
        return []
    claim = dataclasses.replace(claim, scenes=left)
    needed = {label for scene in claim.scenes_of(case) for label in claim.labels(case, scene)}
    if needed <= set(wanted):
        return [claim]
    if not isinstance(claim, PerMethod):
        return []
    methods = tuple(label for label in claim.methods if label in wanted)
    return [dataclasses.replace(claim, methods=methods)] if methods or not claim.methods else []


def show_verdict(result: RunResult, out: Path, *, quiet: bool) -> None:
    """Matrix and worst rows (unless quiet), the verdict, where the report lies, annotations for GitHub."""
    terminal = console()
    rows = outcomes(result)
    if not quiet:
        show_table(matrix_table(result), on=terminal)
    failed = [row for row in rows if row.tone == "bad"][:WORST_SHOWN]
    for row in failed:
        terminal.print(Text.assemble((row.word, STYLES["bad"]), f" {row.case}: {row.place} ({row.who}): {row.message}"))
    words, tone = headline(result, rows)
    terminal.print(words, style=STYLES[tone])
    terminal.print(f"report: {out / 'report.html'}")
    if os.environ.get("GITHUB_ACTIONS") == "true":
        for line in annotation_lines(result):
            terminal.print(line, soft_wrap=True)


def matrix_table(result: RunResult) -> Table:
    """The matrix case x kind of claim as words."""
    matrix = run_matrix(result)
    rows = tuple(
        (name, *(f"{cell.word} {cell.fraction}".strip() if cell else "" for cell in cells))
        for name, _, cells in matrix.rows
    )
    note = "The worst check of each kind with the fraction of its tolerance."
    return Table(title="", note=note, heads=("case", *matrix.columns), rows=rows, words=1 + len(matrix.columns))

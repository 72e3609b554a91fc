"""report.html: one file that holds everything, needs no script and no network, and says the verdict first."""

import shlex
from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path

import jinja2
from markupsafe import Markup

from cases.results.files import write_whole
from cases.results.records.claim import Kind
from cases.results.records.run import Acceptance, CaseResult, RunResult
from cases.results.status import Status
from reports.figures.figure_files import FigureFolder
from reports.pages.case_view import CaseView, case_view
from reports.pages.claim_blocks import is_wide
from reports.pages.matrix import run_matrix
from reports.tables import convergence_table, cost_tables
from reports.tables.sharing_tables import shared_things
from reports.tables.table import Table, tabulated
from reports.words.file_names import file_name
from reports.words.moves import moves
from reports.words.numbers import duration, small
from reports.words.outcomes import EXPLANATIONS, counts, headline, outcomes, tone_of, value_text

# The page begins with so many of the worst checks.
ROWS_ON_FIRST_SCREEN = 5


def write_report(run: RunResult, directory: Path, jobs: int = 1) -> Path:
    """Write report.html and the figures (SVG, PNG, CSV) of `run` into `directory`; return the page's path.

    With more than one job many figures are drawn in so many processes.
    """
    folder = FigureFolder(directory)
    out = shlex.quote(str(directory))
    cases = [case_view(case, folder, f"contact-verify {_subcommand(case)} --out {out}") for case in run.cases]
    folder.draw(jobs)
    page = directory / "report.html"
    write_whole(page, render(run, directory, cases))
    return page


STUDY_COMMANDS = {
    "stability": "ladders",
    "coverage": "coverage",
    "error_maps": "maps",
    "scaling": "scaling",
    "requested_accuracy": "accuracy",
}


def _subcommand(case: CaseResult) -> str:
    """The command that makes a case's numbers again: a study's own, `cost` where nothing but times was measured."""
    if case.name in STUDY_COMMANDS:
        methods = dict.fromkeys(ladder.method for ladder in case.ladders)
        return " ".join([STUDY_COMMANDS[case.name], *(f"--method {method}" for method in methods)])
    return f"cost {case.name}" if case.work_precision and not case.runs else f"run {case.name}"


def render(run: RunResult, directory: Path, cases: Sequence[CaseView]) -> str:
    """The page as text."""
    rows = outcomes(run)
    words, tone = headline(run, rows)
    notable = [row for row in rows if row.tone != "good"]
    worst = [row for row in notable if row.tone != "skip"][:ROWS_ON_FIRST_SCREEN]
    page = template("report.html").render(
        run=run,
        headline=words,
        tone=tone,
        baseline=baseline_sentence(run),
        counts=counts(rows),
        explanations=EXPLANATIONS,
        wide=sum(is_wide(claim) for case in run.cases for claim in case.claims),
        worst=worst,
        more_failures=sum(row.tone != "skip" for row in notable) - len(worst),
        matrix=run_matrix(run) if rows else None,
        costs=cost_tables.shortest_times(run),
        speed_ups=cost_tables.speed_ups(run),
        shared=shared_things(run),
        orders=convergence_table.orders(run),
        cases=cases,
        notable=notable,
        tolerances=tolerance_history(run.acceptances),
        stamp=stamp_lines(run),
        directory=shlex.quote(str(directory)),
        css=stylesheet(),
    )
    return without_optional_end_tags(page)


def without_optional_end_tags(page: str) -> str:
    """The page without the end tags of rows and cells, which HTML lets out: a tenth of a report with many tables."""
    return page.replace("</td>", "").replace("</tr>", "").replace("</th>", "")


def baseline_sentence(run: RunResult) -> str:
    """How far this run is from the accepted one."""
    compared = [claim for case in run.cases for claim in case.claims if claim.kind is Kind.REGRESSION]
    if not compared:
        return "Not compared with a baseline."
    changed = sum(claim.status is not Status.PASS for claim in compared)
    groups = "; ".join(moves(run))
    return f"Since the baseline: {changed} of {len(compared)} numbers changed{groups and ': '}{groups}."


def tolerance_history(acceptances: Sequence[Acceptance]) -> Table | None:
    """Every accepted change of a number or a tolerance, latest first; a loosened tolerance says so."""
    return tabulated(
        sorted(acceptances, key=lambda entry: entry.date, reverse=True),
        {
            "date": lambda entry: entry.date,
            "case": lambda entry: entry.case,
            "method": lambda entry: entry.method,
            "quantity": lambda entry: entry.quantity,
            "old": lambda entry: _accepted(entry.old, entry.old_tolerance),
            "new": lambda entry: _accepted(entry.new, entry.new_tolerance),
            "old tolerance": lambda entry: _tolerance(entry.old_tolerance),
            "new tolerance": lambda entry: _tolerance(entry.new_tolerance) + " LOOSENED" * _loosened(entry),
            "reason": lambda entry: entry.reason,
            "revision": lambda entry: entry.revision[:12],
        },
        title="Accepted changes",
        note="Only `contact-verify accept` writes baselines; it loosens a tolerance only when told to.",
        words=10,
    )


def _accepted(value: float | None, tolerance: float | None) -> str:
    """An accepted value with no more digits than its relative tolerance watches."""
    return "" if value is None else value_text(value, None if tolerance is None else tolerance * abs(value))


def _tolerance(value: float | None) -> str:
    return "" if value is None else small(value)


def _loosened(entry: Acceptance) -> bool:
    return entry.old_tolerance is not None and (entry.new_tolerance or 0.0) > entry.old_tolerance


def stamp_lines(run: RunResult) -> list[tuple[str, str]]:
    """Where and with what the run was made, one line a fact."""
    stamp = run.stamp
    lines = [
        ("started", f"{stamp.started}, took {duration(stamp.wall_seconds)}"),
        ("revision", stamp.revision + (" with uncommitted changes" if stamp.dirty else "")),
        ("machine", f"{stamp.processor}, {stamp.cores} cores, {stamp.platform}"),
        ("Python", stamp.python),
        ("numerical libraries", ", ".join(f"{name} on {n} thread{'s'[: n != 1]}" for name, n in stamp.threads.items())),
        ("versions", ", ".join(f"{name} {version}" for name, version in stamp.versions.items())),
    ]
    meshes = ", ".join(f"{name}: {digest}" for name, digest in stamp.mesh_hashes.items())
    return lines + ([("meshes", meshes)] if meshes else [])


def template(name: str) -> jinja2.Template:
    """A page template of this package, with our filters."""
    return _environment().get_template(name)


def stylesheet() -> str:
    """The style sheet every page carries inside."""
    return files("reports").joinpath("templates/report.css").read_text(encoding="utf-8")


@cache
def _environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("reports"), autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True
    )
    environment.filters.update(
        anchor=file_name,
        duration=duration,
        tone=tone_of,
        sentence=lambda text: text[:1].upper() + text[1:],
        breakable=lambda name: Markup("_<wbr>").join(name.split("_")),
        paragraphs=lambda text: [part.strip() for part in text.split("\n\n") if part.strip()],
    )
    return environment

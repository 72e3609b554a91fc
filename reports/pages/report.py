"""report.html, the verdict and three answers first, and a page for each case; no script, no network."""

import shlex
from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path

import jinja2
from markupsafe import Markup

from cases.results.files import write_whole
from cases.results.records.run import CaseResult, RunResult
from reports.figures.figure_files import ROOM, FigureFolder
from reports.pages.case_view import CaseView, case_view
from reports.pages.claim_blocks import is_wide
from reports.pages.front import Answer, pairs_table, three_answers_of
from reports.pages.matrix import run_matrix
from reports.pages.moves import baseline_sentence
from reports.pages.one_factor import one_factor
from reports.pages.outcomes import EXPLANATIONS, counts, headline, outcomes, tone_of
from reports.tables import convergence_table, cost_tables
from reports.tables.sharing_tables import shared_things
from reports.words import duration, file_name

# The folder of the pages of single cases.
CASES = "cases"
# The page begins with so many of the worst checks.
ROWS_ON_FIRST_SCREEN = 5


def write_report(run: RunResult, directory: Path, jobs: int = 1, *, single_file: bool = False) -> Path:
    """Write report.html, a page for each case in cases/, and the figures (SVG, PNG, CSV) into `directory`.

    Args:
        run: what was found.
        directory: of the run.
        jobs: with more than one, many figures are drawn in so many processes.
        single_file: whether the cases stand on report.html instead, which then needs no other file; a single case
            always does.

    Returns:
        The path of report.html.
    """
    single_file = single_file or len(run.cases) == 1
    folder = FigureFolder(directory, room=ROOM if single_file else ROOM * (1 + len(run.cases)))
    out = shlex.quote(str(directory))
    answers = three_answers_of(run, folder, f"contact-verify report {out}")
    cases = [case_view(case, folder, f"contact-verify {_subcommand(case)} --out {out}") for case in run.cases]
    folder.draw(jobs)
    (directory / CASES).mkdir(exist_ok=True)
    for stale in (directory / CASES).glob("*.html"):
        stale.unlink()
    for case in () if single_file else cases:
        write_whole(directory / CASES / _page_name(case["result"].name), case_page(case, run))
    page = directory / "report.html"
    write_whole(page, render(run, directory, cases, answers, single_file=single_file))
    return page


def _page_name(case: str) -> str:
    return f"{file_name(case)}.html"


def case_page(case: CaseView, run: RunResult) -> str:
    """The page of one case as text; it links to its neighbours and to the front page."""
    own = case["result"].name
    page = template("case.html").render(
        case=case,
        names={result.name for result in run.cases},
        address=lambda name: f"#{file_name(name)}" if name == own else _page_name(name),
        css=stylesheet(),
    )
    return without_optional_end_tags(page)


STUDY_COMMANDS = {
    "stability": "ladders",
}


def _subcommand(case: CaseResult) -> str:
    """The command that makes a case's numbers again: a study's own, `cost` where nothing but times was measured."""
    if case.name in STUDY_COMMANDS:
        methods = dict.fromkeys(ladder.method for ladder in case.ladders)
        return " ".join([STUDY_COMMANDS[case.name], *(f"--method {method}" for method in methods)])
    return f"cost {case.name}" if case.work_precision and not case.runs else f"run {case.name}"


def render(
    run: RunResult,
    directory: Path,
    cases: Sequence[CaseView],
    answers: Sequence[Answer],
    *,
    single_file: bool,
) -> str:
    """The front page as text."""

    def address(case: str) -> str:
        return f"#{file_name(case)}" if single_file else f"{CASES}/{_page_name(case)}"

    rows = outcomes(run)
    words, tone = headline(run, rows)
    notable = [row for row in rows if row.tone != "good"]
    worst = [row for row in notable if row.tone != "skip"][:ROWS_ON_FIRST_SCREEN]
    page = template("report.html").render(
        run=run,
        names={case.name for case in run.cases},
        address=address,
        single_file=single_file,
        answers=answers,
        pairs=pairs_table(run, address),
        headline=words,
        tone=tone,
        baseline=baseline_sentence(run),
        counts=counts(rows),
        explanations=EXPLANATIONS,
        wide=sum(is_wide(claim) for case in run.cases for claim in case.claims),
        factors=one_factor(run),
        worst=worst,
        more_failures=sum(row.tone != "skip" for row in notable) - len(worst),
        matrix=run_matrix(run) if rows else None,
        costs=cost_tables.shortest_times(run),
        speed_ups=cost_tables.speed_ups(run),
        shared=shared_things(run),
        orders=convergence_table.orders(run),
        cases=cases,
        notable=notable,
        stamp=stamp_lines(run),
        directory=shlex.quote(str(directory)),
        css=stylesheet(),
    )
    return without_optional_end_tags(page)


def without_optional_end_tags(page: str) -> str:
    """The page without the end tags of rows and cells, which HTML lets out: a tenth of a report with many tables."""
    return page.replace("</td>", "").replace("</tr>", "").replace("</th>", "")


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

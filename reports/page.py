"""report.html, the verdict and three answers first, and a page per case; no script, no network."""

import re
import shlex
from collections import Counter
from collections.abc import Iterable, Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path
from statistics import median
from typing import Any

import jinja2
from markupsafe import Markup, escape

from cases.cost import cheapest
from cases.files import csv_text
from cases.runs import Run
from cases.verdicts import Kind, Status, Verdict, worst
from contact.files.whole import write_whole
from reports import findings, tables
from reports.charts import Picture, front, of_case
from reports.findings import grouped, severity, who
from reports.style import figure_style, svg_text
from reports.words import duration, file_name, small

# The folders of the pages of single cases, and of the pictures.
CASES, FIGURES = "cases", "figures"
QUESTIONS = ("Do the methods agree?", "What does accuracy cost?", "Where does it break?")
# The space between a number and its unit.
BEFORE_UNIT = re.compile(r"(?<=\d) (?=(?:min|%|[pnuµmkMG]?(?:s|m|N|Pa|B|J))(?!\w))")
# Letters of a word with digits that is kept on one line: longer ones are names, and columns are narrow.
LONGEST_NUMBER = 24
# Accuracies whose run times the front page states.
PRICED = (1e-4, 1e-6)


def write_report(run: Run, directory: Path, *, single_file: bool = False) -> Path:
    """Write report.html, a page per case in cases/, figures/*.svg and answers.csv into `directory`.

    Args:
        run: Answers, verdicts and studies.
        directory: Folder of the run.
        single_file: Whether the cases stand on report.html instead; a single case always does.

    Returns:
        The path of report.html.
    """
    cases = run.judged.cases
    single_file = single_file or len(cases) == 1
    (directory / CASES).mkdir(parents=True, exist_ok=True)
    (directory / FIGURES).mkdir(exist_ok=True)
    for stale in (*(directory / CASES).glob("*.html"), *(directory / FIGURES).glob("*.svg")):
        stale.unlink()
    with figure_style():
        pictures = {case.name: _placed(of_case(run, case), directory) for case in cases}
        answered = zip(QUESTIONS, (_agreement(run), _cost(run), _breakdown(run)), front(run), strict=True)
        questions = [(question, words, _placed(drawn, directory)) for question, words, drawn in answered]
    judged = grouped(run.judged.verdicts, lambda verdict: verdict.case)
    common = {"run": run, "pictures": pictures, "names": set(pictures), "judged_of": judged}
    for case in () if single_file else cases:
        text = _rendered("case.html", case=case, address=_page_name, **common)
        write_whole(directory / CASES / _page_name(case.name), text)
    common |= {"single_file": single_file, "questions": questions, "directory": shlex.quote(str(directory))}
    text = _rendered(
        "report.html",
        address=lambda name: f"#{file_name(name)}" if single_file else f"{CASES}/{_page_name(name)}",
        **common,
    )
    write_whole(directory / "report.html", text)
    rows = list(run.answers.rows())
    write_whole(directory / "answers.csv", csv_text(rows[0] if rows else (), (row.values() for row in rows)))
    return directory / "report.html"


def _page_name(case: str) -> str:
    return f"{file_name(case)}.html"


def _placed(pictures: Iterable[Picture], directory: Path) -> list[list[dict[str, Any]]]:
    """Pictures written to their files, and as parts of a page: one list for all pictures of one title."""
    drawn: list[dict[str, Any]] = [
        {"picture": picture, "svg": svg_text(picture.draw(), key=picture.name)} for picture in pictures
    ]
    for part in drawn:
        write_whole(directory / FIGURES / f"{part['picture'].name}.svg", part["svg"])
    return list(grouped(drawn, lambda part: part["picture"].title).values())


def status_of(run: Run, case: str) -> Status:
    """The status that decides for a case, of verdicts and of answers that broke down."""
    broken = [answer.status for answer in run.answers.of_case(case) if answer.status.is_failure]
    return worst([v.status for v in run.judged.verdicts if v.case == case] + broken)


def blocks(verdicts: Iterable[Verdict]) -> list[dict[str, Any]]:
    """The claims by reason in the order of their kinds: one row per claim and methods, its worst scene."""
    ordered = sorted(verdicts, key=lambda v: list(Kind).index(v.kind))
    blocks = []
    for (kind, because), same in grouped(ordered, lambda v: (v.kind, v.why.because)).items():
        rows = [
            {"worst": min(alike, key=severity), "cell": tables.cell_of(alike)}
            for alike in grouped(same, lambda v: (v.kind is Kind.REGRESSION or v.claim, v.methods)).values()
        ]
        origins = dict.fromkeys(f"{v.why.origin}: {v.why.source}; tolerance: {v.why.tolerance}" for v in same)
        block = {"kind": kind, "because": because, "origins": list(origins), "cell": tables.cell_of(same), "rows": rows}
        blocks.append(block)
    return blocks


def _agreement(run: Run) -> list[str]:
    """Sentences on the agreement of methods: number within tolerance, and median differences by pair."""
    verdicts = tables.compared(run)
    if not verdicts:
        return ["No two methods were compared in this run."]
    tally = Counter(verdict.status for verdict in verdicts)
    beyond = sum(number for status, number in tally.items() if status.is_failure)
    still_open = tally[Status.INCONCLUSIVE]
    verdict = "Yes: all" if not beyond and not still_open else f"{len(verdicts) - beyond - still_open} of"
    rest = f"; {beyond} disagree" * bool(beyond) + f"; {still_open} remain open" * bool(still_open)
    pairs = grouped(verdicts, lambda verdict: verdict.methods)
    medians = (f"{who(pair)} {small(median(map(tables.difference, same)))}" for pair, same in pairs.items())
    return [
        f"{verdict} {len(verdicts)} comparisons agree within their tolerance{rest}.",
        f"Median difference: {'; '.join(medians)}.",
    ]


def _cost(run: Run) -> list[str]:
    """Sentences on the median time of each method to the accuracies `PRICED`."""
    costs = [tables.timed_methods(cost) for cost in run.judged.costs]
    if not costs:
        return ["Nothing was timed in this run."]
    lines = [f"Median time once data are prepared, and how many of {len(costs)} timed quantities reach the accuracy."]
    for tau in PRICED:
        parts = []
        for method in dict.fromkeys(name for points in costs for name in points):
            seconds = [point.seconds for points in costs if (point := cheapest(points.get(method, ()), tau))]
            parts += [f"{who([method])} {duration(median(seconds))} ({len(seconds)})"] if seconds else []
        lines += [f"To {tables.percent(tau)}: {', '.join(parts)}."] if parts else []
    return lines


def _breakdown(run: Run) -> list[str]:
    """Sentence on the numbers of stress tests that were completed, refused or failed."""
    tests = run.judged.stress_tests
    if not tests:
        return ["No stress test was made in this run: the suite nightly does that."]
    ends = Counter(tables.end_of(test).split()[0] for test in tests)
    refused = f", {ends['refused']} end with a refusal that names its reason" * bool(ends["refused"])
    failed = f", {ends['fails']} with a wrong or missing answer" * bool(ends["fails"])
    return [f"{ends['completed']} of {len(tests)} stress tests were completed{refused}{failed}."]


def stamp_lines(run: Run) -> list[tuple[str, str]]:
    """Facts about machine, revision and versions of the run, one line per fact."""
    stamp = run.judged.stamp
    return [
        ("started", f"{stamp.started}, took {duration(stamp.wall_seconds)}"),
        ("revision", stamp.revision + (" with uncommitted changes" if stamp.dirty else "")),
        ("machine", f"{stamp.processor}, {stamp.cores} cores, {stamp.platform}"),
        ("Python", stamp.python),
        ("numerical libraries", ", ".join(f"{name} on {n} thread{'s'[: n != 1]}" for name, n in stamp.threads.items())),
        ("versions", ", ".join(f"{name} {version}" for name, version in stamp.versions.items())),
    ]


def write_comparison(changes: Sequence[Verdict], title: tuple[str, str], runs: Sequence[Run], page: Path) -> None:
    """Write the page of two runs: what differs between the second and the first."""
    write_whole(page, _rendered("comparison.html", verdicts=changes, headline=title, runs=runs))


def _rendered(template: str, **values: Any) -> str:
    """The page as text, without the end tags of rows and cells, which HTML lets out: a tenth of many tables."""
    page = _environment().get_template(template).render(**values)
    return re.sub(r"</t[dhr]>\s*", "", page)


def unbroken(text: str) -> Markup:
    """The text as HTML in which no line ends within a number or between a number and its unit."""
    words = BEFORE_UNIT.sub("\u00a0", text).split(" ")
    number = Markup("<span class=nb>{}</span>")
    parts = (
        number.format(word) if any(map(str.isdigit, word)) and len(word) <= LONGEST_NUMBER else escape(word)
        for word in words
    )
    return Markup(" ").join(parts)


@cache
def _environment() -> jinja2.Environment:
    """Templates with the functions and filters that they use."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("reports"), autoescape=True, undefined=jinja2.StrictUndefined, trim_blocks=True
    )
    css = files("reports").joinpath("templates/report.css").read_text(encoding="utf-8")
    environment.globals.update(css=css, findings=findings, tables=tables)
    environment.globals.update(blocks=blocks, status_of=status_of, stamp_lines=stamp_lines)
    environment.filters.update(
        anchor=file_name,
        duration=duration,
        in_words=findings.in_words,
        observed=lambda verdict: unbroken(findings.observed_text(verdict)),
        unbroken=unbroken,
        small=lambda value: "" if value is None else small(value),
        tone=findings.tone_of,
        worst_first=lambda verdicts: sorted(verdicts, key=severity),
        who=who,
        sentence=lambda text: text[:1].upper() + text[1:],
        breakable=lambda name: Markup("_<wbr>").join(name.split("_")),
        paragraphs=lambda text: [part.strip() for part in text.split("\n\n") if part.strip()],
        within=lambda verdict: f"within {100 * verdict.tolerance:.2g} %" if findings.is_wide(verdict) else "",
    )
    return environment

"""summary.md for the summary page of a CI job: verdict, counts, what did not pass, and the matrix."""

import html
import re
from collections.abc import Iterable, Sequence

from cases.results.records.run import RunResult
from contact.records.errors import printable
from reports.pages.matrix import Cell, run_matrix
from reports.pages.moves import baseline_sentence
from reports.pages.one_factor import one_factor
from reports.pages.outcomes import CheckOutcome, counts, headline, outcomes
from reports.words import duration

# Bytes: what a reader scrolls through. GitHub refuses a job summary above 1 MiB.
LARGEST = 64 * 1000

# What Markdown would take for a cell's end, code, a link, an address, a person, or emphasis at a word's edge.
MARKDOWN = re.compile(r"[`*~\\@]|\](?=[(\[:])|:(?=//)|(?<![^\W_])_|_(?![^\W_])")

HEAD = (
    "| verdict | case | check | method | error / tolerance | measured | tolerance | what was seen |\n"
    "|---|---|---|---|--:|---|---|---|\n"
)


def summary_text(run: RunResult, *, largest: int = LARGEST) -> str:
    """The summary in Markdown, never above `largest` bytes; what does not fit is counted, failures come first."""
    rows = outcomes(run)
    words, _ = headline(run, rows)
    tally = ", ".join(f"{number} {status}" for status, number in counts(rows))
    suite = f"Suite {run.suite}" if run.suite else "Chosen cases"
    taken = f"{suite}, revision {run.stamp.revision[:12]}, {duration(run.stamp.wall_seconds)}."
    top = f"# {_escaped(words)}\n\n{tally}. {_escaped(taken)} {_escaped(baseline_sentence(run))}\n\n"
    top += "".join(f"{_escaped(sentence)}\n\n" for sentence in one_factor(run))
    notable = [row for row in rows if row.tone != "good"]
    matrix = _matrix(run) if rows else ""
    if 2 * len(matrix.encode()) > largest:
        matrix = ""
    return top + matrix + _table(notable, largest - len((top + matrix).encode()))


def _matrix(run: RunResult) -> str:
    """The worst check of each case and kind of claim, with the fraction of its tolerance and how many there are."""
    matrix = run_matrix(run)
    head = f"| case | {' | '.join(matrix.columns)} |\n|{'---|' * (1 + len(matrix.columns))}\n"
    return (
        head
        + "".join(
            f"| {_escaped(name)} | {' | '.join(_cell(cell) for cell in cells)} |\n" for name, cells in matrix.rows
        )
        + "\n"
    )


def _cell(cell: Cell | None) -> str:
    return "" if cell is None else _escaped(" ".join(filter(None, (cell.word, cell.fraction, f"({cell.checks})"))))


def _table(rows: Sequence[CheckOutcome], room: int) -> str:
    """As many rows as fit, and how many did not."""
    if not rows:
        return "Every check ran and passed.\n"
    lines = [_line(row) for row in rows]
    fitting = _fitting(lines, room - len(HEAD.encode()) - 200)
    missing = len(lines) - fitting
    more = f"\n{missing} further rows are on the page of the report.\n" if missing else ""
    return HEAD + "".join(lines[:fitting]) + more


def _fitting(lines: Iterable[str], room: int) -> int:
    """How many lines from the front have at most `room` bytes together."""
    used = number = 0
    for number, line in enumerate(lines, start=1):
        used += len(line.encode())
        if used > room:
            return number - 1
    return number


def _line(row: CheckOutcome) -> str:
    cells = (row.word, row.case, row.place, row.who, row.fraction_text, row.observed, row.tolerance, row.message)
    word, *others = map(_escaped, cells)
    return "| " + " | ".join([f"**{word}**" if row.tone == "bad" else word, *others]) + " |\n"


def _escaped(text: str) -> str:
    """Text that shows as it stands: it ends no table cell and is neither HTML nor Markdown."""
    plain = html.escape(printable(" ".join(text.split())), quote=False)
    return MARKDOWN.sub(lambda found: f"&#{ord(found[0])};", plain).replace("|", "\\|")

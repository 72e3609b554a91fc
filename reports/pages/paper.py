"""The page `docs/paper.md`: what the paper says, what is measured, and how each statement ends."""

from collections import Counter
from collections.abc import Iterable

from cases.library._paper.statement import GOOD, SAME, Measured, Statement
from reports.words.numbers import measured, small

HEAD = """\
# What the paper says, what we measure

Written by `contact-verify paper-page`; the numbers are computed when it is written, do not edit. The paper is
F. Forsbach, Machines 11 (2023) 474; the statements are declared in `cases/library/_paper/`. Digits in brackets are the
uncertainty of the last digits; the error of a number without them is below its last digit. "Good approximation" is read
as within {good:g} %, "almost exactly" and "the same" as within {same:g} %. {count} statements: {tally}.
"""
COLUMNS = ("where", "the paper says", "printed", "measured", "value", "method", "verdict")


def paper_page(statements: Iterable[Statement]) -> str:
    """The whole page in Markdown."""
    judged = [(one, *one.judged()) for one in statements]
    tally = Counter(str(verdict) for _, _, verdict in judged)
    told = ", ".join(f"{number} {verdict}" for verdict, number in tally.most_common())
    head = HEAD.format(good=100 * GOOD, same=100 * SAME, count=len(judged), tally=told)
    rows = [_line(COLUMNS), _line(("---",) * len(COLUMNS))]
    rows += [
        _line((one.place, one.says, one.printed, one.what, _value(found), one.method, str(verdict)))
        for one, found, verdict in judged
    ]
    return head + "\n" + "".join(rows)


def _line(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cells) + " |\n"


def _value(found: Measured) -> str:
    """Three digits of a deviation and six of other numbers, or as many as the error allows."""
    digits = 3 if found.in_percent else 6
    if abs(found.value) <= 1e-9:
        return small(found.value)
    factor, unit = (100, " %") if found.in_percent else (1, "")
    if found.error > 0.5 * 10.0 ** (1 - digits) * abs(found.value):
        return measured(factor * found.value, factor * found.error) + unit
    return f"{factor * found.value:{'+' if unit else ''}.{digits}g}{unit}"

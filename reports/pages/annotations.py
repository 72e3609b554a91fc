"""`::error` lines that GitHub shows on a job: at most nine, because ten would hide the rest without a word."""

from collections.abc import Sequence

from cases.results.records.run import RunResult
from reports.pages.outcomes import CheckOutcome, outcomes

# GitHub shows ten annotations of a step and hides the rest: nine leave room for its own.
MOST = 9


def annotation_lines(run: RunResult) -> list[str]:
    """The worst failures, one line each; when there are more than nine, the ninth line counts the others."""
    failed = [row for row in outcomes(run) if row.status.is_failure]
    if len(failed) <= MOST:
        return [_line(row) for row in failed]
    rest = len(failed) - (MOST - 1)
    return [
        *(_line(row) for row in failed[: MOST - 1]),
        _annotation("more failures", f"{rest} more failures: see summary.md"),
    ]


def _line(row: CheckOutcome) -> str:
    title = f"{row.status} {row.case}: {row.place} ({row.who})"
    facts: Sequence[str] = [
        part for part in (row.message, f"measured {row.observed}, tolerance {row.tolerance}") if row.observed
    ]
    return _annotation(title, "; ".join(facts) or row.message)


def _annotation(title: str, message: str) -> str:
    return f"::error title={_escaped(title).replace(':', '%3A').replace(',', '%2C')}::{_escaped(message)}"


def _escaped(text: str) -> str:
    """A workflow command is one line; percent signs and line ends are written as their codes."""
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")

"""The matrix of a report, case x kind of claim: each cell stands for many checks by the worst of them."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from cases.results.records.claim import Kind
from cases.results.records.run import CaseResult, RunResult
from cases.results.status import Status
from reports.pages.outcomes import CheckOutcome, case_outcomes, severity


@dataclass(frozen=True, kw_only=True)
class Cell:
    """The word, the largest fraction of tolerance, how many checks ran and were skipped, colour class and reason."""

    word: str
    fraction: str
    checks: int
    skipped: int
    tone: str
    title: str


@dataclass(frozen=True, kw_only=True)
class Matrix:
    """Heads and rows; a row is the case's name and one cell (or nothing) a column."""

    columns: tuple[str, ...]
    rows: tuple[tuple[str, tuple[Cell | None, ...]], ...]


def run_matrix(run: RunResult) -> Matrix:
    """One row a case, one column a kind of claim and one for the solutions; each cell is the worst check in it."""
    kinds = [kind for kind in Kind if any(claim.kind is kind for case in run.cases for claim in case.claims)]
    rows = ((case.name, _kind_cells(case, kinds, run.methods)) for case in run.cases)
    return Matrix(columns=(*(str(kind) for kind in kinds), "solutions"), rows=tuple(rows))


def _kind_cells(case: CaseResult, kinds: Sequence[Kind], methods: Sequence[str]) -> tuple[Cell | None, ...]:
    rows = case_outcomes(case)
    parts = [[row for row in rows if row.what.startswith(f"{kind}:")] for kind in kinds]
    solved = [row for row in rows if row.what == "solution"]
    # A chosen method that was skipped everywhere is not hidden behind the solutions of others.
    silent = case.unjudged(methods)
    parts.append([row for row in solved if row.status is Status.SKIP and row.methods[0] in silent] or solved)
    return tuple(cell_of(part) if part else None for part in parts)


def cell_of(rows: Iterable[CheckOutcome]) -> Cell:
    """The worst of some checks, at least one; those that were skipped are counted apart, unless all were."""
    ordered = sorted(rows, key=severity)
    ran = [row for row in ordered if row.status is not Status.SKIP] or ordered
    worst = ran[0]
    title = f"{worst.name} ({worst.who}): {worst.message}" if worst.message else f"{worst.name} ({worst.who})"
    skipped = len(ordered) - len(ran)
    return Cell(
        word=worst.word, fraction=worst.fraction_text, checks=len(ran), skipped=skipped, tone=worst.tone, title=title
    )

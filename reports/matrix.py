"""The matrices of a report: case x kind of claim for the whole run, scene x claim for one case."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from cases.results import CaseResult, Claim, Kind, RunResult
from reports.names import file_name
from reports.outcomes import Outcome, case_outcomes, claim_outcome, severity


@dataclass(frozen=True, kw_only=True)
class Cell:
    """The word, the largest fraction of tolerance, how many checks it stands for, its colour class and reason."""

    word: str
    fraction: str
    checks: int
    tone: str
    title: str


@dataclass(frozen=True, kw_only=True)
class Matrix:
    """Heads and rows; a row is its name, its link and one cell (or nothing) a column."""

    corner: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, str, tuple[Cell | None, ...]], ...]


def run_matrix(run: RunResult) -> Matrix:
    """One row a case, one column a kind of claim and one for the solutions; each cell is the worst check in it."""
    kinds = [kind for kind in Kind if any(claim.kind is kind for case in run.cases for claim in case.claims)]
    rows = ((case.name, f"#{file_name(case.name)}", _kind_cells(case, kinds)) for case in run.cases)
    return Matrix(corner="case", columns=(*(str(kind) for kind in kinds), "solutions"), rows=tuple(rows))


def _kind_cells(case: CaseResult, kinds: Sequence[Kind]) -> tuple[Cell | None, ...]:
    rows = case_outcomes(case)
    of_kind = [[row for row in rows if row.what.startswith(f"{kind}:")] for kind in kinds]
    return (*(_cell(part) for part in of_kind), _cell([row for row in rows if row.what == "solution"]))


def case_matrix(case: CaseResult) -> Matrix:
    """One row a scene (or group of scenes), one column a claim as it is worded for that scene."""
    columns = tuple(dict.fromkeys(_column(claim) for claim in case.claims))
    scenes = dict.fromkeys(claim.scene for claim in case.claims)
    found: dict[tuple[str, str], list[Outcome]] = {}
    for claim in case.claims:
        found.setdefault((claim.scene, _column(claim)), []).append(claim_outcome(case.name, claim))
    cells = ((scene, "", tuple(_cell(found.get((scene, column), [])) for column in columns)) for scene in scenes)
    return Matrix(corner="scene", columns=columns, rows=tuple(cells))


def _column(claim: Claim) -> str:
    return f"{claim.kind} {claim.quantity.replace('_', ' ')}, {' against '.join(claim.methods)}"


def _cell(rows: Iterable[Outcome]) -> Cell | None:
    ordered = sorted(rows, key=severity)
    if not ordered:
        return None
    worst = ordered[0]
    title = f"{worst.name} ({worst.who}): {worst.message}" if worst.message else f"{worst.name} ({worst.who})"
    return Cell(word=worst.word, fraction=worst.fraction_text, checks=len(ordered), tone=worst.tone, title=title)

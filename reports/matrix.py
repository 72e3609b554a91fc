"""The matrices of a report: case x kind of claim for the whole run, scene x claim for one case."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import groupby

from cases.results import CaseResult, Claim, Kind, RunResult
from cases.status import Status
from reports.method_names import display_name
from reports.names import file_name
from reports.outcomes import Outcome, case_outcomes, claim_outcome, severity


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
    """Heads and rows; a row is its name, its link and one cell (or nothing) a column.

    `groups` stand above the columns, each with the number of columns below it; empty for plain heads.
    """

    corner: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, str, tuple[Cell | None, ...]], ...]
    groups: tuple[tuple[str, int], ...] = ()


def run_matrix(run: RunResult) -> Matrix:
    """One row a case, one column a kind of claim and one for the solutions; each cell is the worst check in it."""
    kinds = [kind for kind in Kind if any(claim.kind is kind for case in run.cases for claim in case.claims)]
    rows = ((case.name, f"#{file_name(case.name)}", _kind_cells(case, kinds)) for case in run.cases)
    return Matrix(corner="case", columns=(*(str(kind) for kind in kinds), "solutions"), rows=tuple(rows))


def _kind_cells(case: CaseResult, kinds: Sequence[Kind]) -> tuple[Cell | None, ...]:
    rows = case_outcomes(case)
    of_kind = [[row for row in rows if row.what.startswith(f"{kind}:")] for kind in kinds]
    return (*(_cell(part) for part in of_kind), _cell([row for row in rows if row.what == "solution"]))


Column = tuple[Kind, str, tuple[str, ...]]


def case_matrix(case: CaseResult) -> Matrix:
    """One row a scene (or group of scenes), one column a quantity and the methods compared, kinds above."""
    columns = sorted(
        dict.fromkeys(_column(claim) for claim in case.claims), key=lambda column: list(Kind).index(column[0])
    )
    found: dict[tuple[str, Column], list[Outcome]] = {}
    for claim in case.claims:
        found.setdefault((claim.scene, _column(claim)), []).append(claim_outcome(case.name, claim))
    cells = ((scene, "", tuple(_cell(found.get((scene, c), [])) for c in columns)) for scene in _judged_scenes(case))
    return Matrix(
        corner="scene",
        columns=tuple(f"{quantity.replace('_', ' ')}, {_names(methods)}" for _, quantity, methods in columns),
        rows=tuple(cells),
        groups=tuple((str(kind), len(list(run))) for kind, run in groupby(columns, key=lambda column: column[0])),
    )


def _judged_scenes(case: CaseResult) -> list[str]:
    """Scenes some claim speaks about: in the order of the case, then groups of scenes."""
    named = dict.fromkeys(claim.scene for claim in case.claims)
    declared = [scene.name for scene in case.scenes if scene.name in named]
    return [*declared, *(scene for scene in named if scene not in declared)]


def _column(claim: Claim) -> Column:
    return claim.kind, claim.quantity, claim.methods


def _names(methods: Iterable[str]) -> str:
    return " – ".join(display_name(method) for method in methods)


def _cell(rows: Iterable[Outcome]) -> Cell | None:
    """The worst of some checks; those that were skipped are counted apart, unless all were."""
    ordered = sorted(rows, key=severity)
    if not ordered:
        return None
    ran = [row for row in ordered if row.status is not Status.SKIP] or ordered
    worst = ran[0]
    title = f"{worst.name} ({worst.who}): {worst.message}" if worst.message else f"{worst.name} ({worst.who})"
    skipped = len(ordered) - len(ran)
    return Cell(
        word=worst.word, fraction=worst.fraction_text, checks=len(ran), skipped=skipped, tone=worst.tone, title=title
    )

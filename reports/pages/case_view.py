"""Everything a page shows of one case, in the order of the page."""

from collections.abc import Iterable
from typing import Any

from cases.results.records.cost import WorkPrecision
from cases.results.records.run import CaseResult
from reports.charts import agreement, convergence, ladder, work_precision
from reports.figures.figure import ReportFigure
from reports.figures.figure_files import FigureFolder, PlacedFigure
from reports.figures.renderer import report_figure
from reports.pages.claim_blocks import claim_blocks
from reports.pages.outcomes import case_outcomes, severity
from reports.tables import case_tables, cost_tables, hard_tables, referee_table
from reports.words import Table

CaseView = dict[str, Any]


def case_view(case: CaseResult, folder: FigureFolder, command: str) -> CaseView:
    """Draw and tabulate a case by the names of the page; `command` makes its numbers and figures again."""

    def placed(figures: Iterable[ReportFigure]) -> tuple[PlacedFigure, ...]:
        return folder.place(figures, command)

    return {
        "result": case,
        "claims": claim_blocks(case),
        "figures": placed(report_figure(figure, case.name) for figure in case.figures),
        "agreement": placed(agreement.figures(case)),
        "answers": case_tables.answers(case),
        "side_by_side": referee_table.side_by_side(case),
        "convergence": placed(convergence.figures(case)),
        "work": tuple(map(_timed, placed(work_precision.figures(case)), case.work_precision)),
        "ladders": placed(ladder.figures(case)),
        "breakdowns": hard_tables.ladders(case),
        "refusals": tuple(ladder.refusals(case)),
        "effects": case_tables.effects(case),
        "stages": case_tables.stages(case),
        "outcomes": tuple(sorted(case_outcomes(case), key=severity)),
    }


def _timed(drawn: PlacedFigure, work: WorkPrecision) -> dict[str, PlacedFigure | Table | None]:
    """Error against seconds with its tables beside it."""
    return {
        "drawn": drawn,
        "cheapest": case_tables.cheapest(work),
        "prices": case_tables.digit_prices(work),
        "settings": cost_tables.settings(work),
    }

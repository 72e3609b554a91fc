"""Everything a page shows of one case, in the order of the page."""

from dataclasses import dataclass

from cases.results.records import CaseResult, WorkPrecision
from reports.charts import agreement, convergence, coverage, error_map, ladder, scaling, work_precision
from reports.figures.figure_files import Gallery, Hung
from reports.figures.renderer import plate_of
from reports.pages.claim_blocks import ClaimBlock, claim_blocks
from reports.tables import case_tables, cost_tables, hard_tables
from reports.tables.table import Table
from reports.words.outcomes import Outcome, case_outcomes, severity


@dataclass(frozen=True, kw_only=True)
class TimedView:
    """Error against seconds with its two tables beside it."""

    drawn: Hung
    cheapest: Table
    prices: Table | None
    settings: Table | None


@dataclass(frozen=True, kw_only=True)
class CaseView:
    """A case on the page; `refusals` are sentences, `outcomes` come worst first."""

    result: CaseResult
    claims: tuple[ClaimBlock, ...]
    figures: tuple[Hung, ...]
    agreement: tuple[Hung, ...]
    answers: Table | None
    convergence: tuple[Hung, ...]
    work: tuple[TimedView, ...]
    ladders: tuple[Hung, ...]
    breakdowns: Table | None
    coverage: tuple[Hung, ...]
    covered: Table | None
    maps: tuple[Hung, ...]
    good_ranges: Table | None
    scaling: tuple[Hung, ...]
    refusals: tuple[str, ...]
    effects: Table | None
    stages: Table | None
    outcomes: tuple[Outcome, ...]


def case_view(case: CaseResult, gallery: Gallery, command: str) -> CaseView:
    """Draw and tabulate a case; `command` makes its numbers and figures again."""
    return CaseView(
        result=case,
        claims=claim_blocks(case),
        figures=gallery.hang(plate_of(figure, case=case.name, command=command) for figure in case.figures),
        agreement=gallery.hang(agreement.plates(case, command)),
        answers=case_tables.answers(case),
        convergence=gallery.hang(convergence.plates(case, command)),
        work=tuple(_timed(work, gallery, case.name, command) for work in case.work_precision),
        ladders=gallery.hang(ladder.plates(case, command)),
        breakdowns=hard_tables.ladders(case),
        coverage=gallery.hang(coverage.plates(case, command)),
        covered=hard_tables.coverage(case),
        maps=gallery.hang(error_map.plates(case, command)),
        good_ranges=hard_tables.good_ranges(case),
        scaling=gallery.hang(scaling.plates(case, command)),
        refusals=tuple(ladder.refusals(case)),
        effects=case_tables.effects(case),
        stages=case_tables.stages(case),
        outcomes=tuple(sorted(case_outcomes(case), key=severity)),
    )


def _timed(work: WorkPrecision, gallery: Gallery, case: str, command: str) -> TimedView:
    (drawn,) = gallery.hang([work_precision.plate(work, case, command)])
    return TimedView(
        drawn=drawn,
        cheapest=case_tables.cheapest(work),
        prices=case_tables.digit_prices(work),
        settings=cost_tables.settings(work),
    )

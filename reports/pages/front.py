"""The front page's three answers: do the methods agree, what does accuracy cost, where does it break."""

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from statistics import median

from markupsafe import Markup

from cases.measurements.cost.overview import methods, shortest
from cases.measurements.measurement import grouped
from cases.results.records.claim import Claim
from cases.results.records.cost import WorkPrecision
from cases.results.records.run import RunResult
from cases.results.status import Status
from reports.charts import three_answers
from reports.charts.three_answers import climbed, compared
from reports.figures.figure_files import FigureFolder, PlacedFigure
from reports.tables.cost_tables import percent
from reports.words import Table, display_name, duration, small, tabulated

# Where a case stands: its page, or its place on this one.
Address = Callable[[str], str]
# The accuracies whose price the front page tells.
TOLD = (1e-4, 1e-6)


@dataclass(frozen=True, kw_only=True)
class Answer:
    """A question a reader comes with, its answer in sentences, and the picture that shows it."""

    question: str
    sentences: tuple[str, ...]
    drawn: PlacedFigure | None


def three_answers_of(run: RunResult, folder: FigureFolder, command: str) -> tuple[Answer, ...]:
    """The three questions with their answers; the pictures are drawn with the others of the folder."""
    questions = ("Do the methods agree?", "What does accuracy cost?", "Where does it break?")
    texts = (_agreement(run), _cost(run), _breakdown(run))
    placed = [
        folder.place([figure], command)[0] if figure is not None else None for figure in three_answers.figures(run)
    ]
    return tuple(
        Answer(question=question, sentences=tuple(text), drawn=drawn)
        for question, text, drawn in zip(questions, texts, placed, strict=True)
    )


def _agreement(run: RunResult) -> list[str]:
    found = [claim for _, claim in compared(run)]
    if not found:
        return ["No two methods were compared in this run."]
    tally = Counter(claim.status for claim in found)
    beyond = sum(number for status, number in tally.items() if status.is_failure)
    still_open = tally[Status.INCONCLUSIVE]
    verdict = "Yes: all" if not beyond and not still_open else f"{len(found) - beyond - still_open} of"
    rest = f"; {beyond} disagree" * bool(beyond) + f"; {still_open} remain open" * bool(still_open)
    pairs = grouped(found, lambda claim: claim.methods)
    return [
        f"{verdict} {len(found)} comparisons agree within their tolerance{rest}.",
        "Median difference: "
        + ", ".join(
            f"{' – '.join(map(display_name, pair))} {small(median(abs(c.observed or 0.0) for c in same))}"
            for pair, same in pairs.items()
        )
        + ".",
    ]


def _cost(run: RunResult) -> list[str]:
    works = [work for case in run.cases for work in case.work_precision]
    if not works:
        return ["Nothing was timed in this run."]
    names = dict.fromkeys(method for work in works for method in methods(work))
    lines = [line for tau in TOLD if (line := _price(works, list(names), tau))]
    return [f"Median of {len(works)} timed quantities, once data are prepared.", *lines]


def _price(works: Iterable[WorkPrecision], names: Iterable[str], tau: float) -> str:
    """What each method takes for an accuracy, in the median of where it reaches it."""
    parts = []
    for name in names:
        found = [row.seconds or 0.0 for work in works if (row := shortest(work, name, tau)) and row.reached]
        if found:
            parts.append(f"{display_name(name)} {duration(median(found))}")
    return f"To {percent(tau)}: {', '.join(parts)}." if parts else ""


def _breakdown(run: RunResult) -> list[str]:
    ladders = [ladder for case in run.cases for ladder in case.ladders]
    lines = []
    if ladders:
        ends = sum(climbed(ladder) == len(ladder.rungs) for ladder in ladders)
        failed = sum(one.breakdown is not None and one.breakdown.status is Status.FAIL for one in ladders)
        refused = len(ladders) - ends - failed
        lines.append(
            f"{ends} of {len(ladders)} ladders of hard scenes are climbed to the end"
            + f", {refused} end with a refusal by name" * bool(refused)
            + f", {failed} with a wrong or missing answer" * bool(failed)
            + "."
        )
    return lines or ["No ladder was climbed in this run: the suite nightly does that."]


def pairs_table(run: RunResult, address: Address) -> Table | None:
    """Worst and median difference of each pair of methods and quantity, with the scene of the worst."""
    groups = grouped(compared(run), lambda found: (*found[1].methods, found[1].quantity))
    return tabulated(
        groups.values(),
        {
            "methods": lambda same: " – ".join(map(display_name, same[0][1].methods)),
            "quantity": lambda same: same[0][1].quantity.replace("_", " "),
            "largest at": lambda same: _where(*_worst(same), address),
            "comparisons": lambda same: f"{len(same)}",
            "median": lambda same: small(median(_difference(claim) for _, claim in same)),
            "largest": lambda same: small(_difference(_worst(same)[1])),
            "its tolerance": lambda same: small(_worst(same)[1].tolerance),
        },
        title="Relative differences by pair of methods and quantity",
        words=3,
    )


def _difference(claim: Claim) -> float:
    return abs(claim.observed or 0.0)


def _worst(same: Iterable[tuple[str, Claim]]) -> tuple[str, Claim]:
    return max(same, key=lambda found: _difference(found[1]))


def _where(case: str, claim: Claim, address: Address) -> str:
    return Markup('<a href="{}">{}</a>, {}').format(address(case), case, claim.scene)

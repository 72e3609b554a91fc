"""Differences of two methods in units of the tolerance, each with its combined uncertainty."""

import math
from collections.abc import Sequence
from functools import partial

from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure as Drawing
from matplotlib.ticker import FuncFormatter, NullLocator

from cases.results.records.claim import Claim, Kind
from cases.results.records.run import CaseResult
from reports.figures.axes_grid import numbered_parts
from reports.figures.figure import Cell, ReportFigure
from reports.pages.outcomes import tone_of
from reports.style import BLUE, GREEN, GREY, ORANGE, TINT, VERMILLION, power_of_ten
from reports.words import display_name

# A figure has so many rows of comparisons: one page.
ROWS_A_FIGURE = 40
# So many figures stand on the page; the data of the last one hold the rest as well.
MOST_FIGURES = 2
# Height of a row [inches]: labels of neighbours do not touch.
ROW_HEIGHT = 0.21  # inches
# Below this fraction of a tolerance the axis is linear.
SMALLEST = 1e-4
TONES = {"good": (BLUE, "o"), "warn": (ORANGE, "D"), "bad": (VERMILLION, "X"), "skip": (GREEN, ".")}
CAPTION = (
    "Each row is one comparison: the signed difference of the two answers, first minus second, divided by its "
    "tolerance (symbol), with the combined numerical uncertainty of both (bar). Between the lines at -1 and 1 the "
    "difference is within tolerance; a bar across them would leave the verdict open. A bar that covers 0 says that "
    "the difference is one that the methods themselves expect. Logarithmic on both sides of a linear middle."
)
COLUMNS = (
    "claim", "scene", "quantity", "methods", "status", "verdict", "observed", "tolerance", "unit",
    "uncertainty_by_method",
)  # fmt: skip


def figures(case: CaseResult) -> list[ReportFigure]:
    """The comparisons of a case: its worst eighty, forty a figure; the data hold all."""
    compared = [claim for claim in case.claims if claim.kind is Kind.AGREEMENT and claim.observed is not None]
    compared.sort(key=lambda claim: -(claim.fraction or 0.0))
    shown = list(numbered_parts(compared[: MOST_FIGURES * ROWS_A_FIGURE], ROWS_A_FIGURE))
    rest = compared[MOST_FIGURES * ROWS_A_FIGURE :]
    return [_figure(case, part, rest if number == len(shown) else [], number) for number, part in shown]


def _figure(case: CaseResult, claims: Sequence[Claim], rest: Sequence[Claim], number: int) -> ReportFigure:
    beyond = f" {len(rest)} comparisons with less of their tolerance used up are in the data only." if rest else ""
    return ReportFigure(
        name=f"{case.name}-agreement-{number}",
        title="Differences between methods, with uncertainty",
        caption=CAPTION + beyond,
        paint=partial(draw, claims),
        columns=COLUMNS,
        rows=tuple(_row(claim) for claim in (*claims, *rest)),
    )


def _row(claim: Claim) -> tuple[Cell, ...]:
    who = " against ".join(claim.methods)
    uncertain = " ".join(f"{method}={value!r}" for method, value in claim.uncertainty.items())
    words = (claim.name, claim.scene, claim.quantity, who, str(claim.status), str(claim.verdict))
    return *words, claim.observed, claim.tolerance, claim.unit, uncertain


def draw(claims: Sequence[Claim]) -> Drawing:
    """One row a claim, fraction of the tolerance on an axis that is logarithmic on both sides of zero."""
    drawing = Drawing(figsize=(10.0, 1.0 + ROW_HEIGHT * len(claims)), layout="constrained")
    axes = drawing.subplots()
    extent = max(1.0, *(abs(_fraction(claim)) + _spread(claim) for claim in claims))
    axes.set_xscale("symlog", linthresh=_linear_below(claims), linscale=0.5)
    axes.set(xlabel="difference / tolerance", xlim=(-3.0 * extent, 3.0 * extent))
    axes.axvspan(-1.0, 1.0, color=TINT, zorder=0.5)
    for side in (-1.0, 1.0):
        axes.axvline(side, color=VERMILLION, linewidth=1.2)
    for place, claim in enumerate(claims):
        _draw_row(axes, place, claim)
    axes.set_yticks(range(len(claims)), [_label(claim) for claim in claims])
    axes.set_ylim(len(claims) - 0.5, -0.5)
    axes.grid(visible=False, axis="y")
    axes.tick_params(top=True, labeltop=len(claims) > ROWS_A_FIGURE // 2)
    mark_signed_decades(axes.xaxis, smallest=_linear_below(claims), largest=3.0 * extent)
    return drawing


def _linear_below(claims: Sequence[Claim]) -> float:
    """Half-width of the linear middle: the decade below the smallest difference, within reason."""
    smallest = min((abs(_fraction(claim)) for claim in claims if claim.observed), default=1.0)
    return 10.0 ** math.floor(math.log10(min(max(smallest, SMALLEST), 0.1)))


def _draw_row(axes: Axes, place: int, claim: Claim) -> None:
    colour, marker = TONES[tone_of(claim.status)]
    middle, spread = _fraction(claim), _spread(claim)
    axes.plot([middle - spread, middle + spread], [place, place], color=GREY, linewidth=1.6, zorder=1.8)
    axes.plot([middle], [place], color=colour, marker=marker, linestyle="none")


def _fraction(claim: Claim) -> float:
    return (claim.observed or 0.0) / claim.tolerance


def _spread(claim: Claim) -> float:
    """Combined uncertainty in units of the tolerance."""
    return math.hypot(*claim.uncertainty.values()) / claim.tolerance


def _label(claim: Claim) -> str:
    return f"{claim.scene}, {claim.quantity.replace('_', ' ')}, {' – '.join(map(display_name, claim.methods))}"


def mark_signed_decades(axis: Axis, *, smallest: float, largest: float) -> None:
    """Label zero and the decades from `smallest` to `largest` on both sides of it, every second where they are many."""
    powers = range(round(math.log10(smallest)), math.floor(math.log10(largest)) + 1)
    step = 1 + len(powers) // 6
    marked = [10.0**power for power in powers if power % step == 0]
    axis.set_ticks([*(-value for value in reversed(marked)), 0.0, *marked])
    axis.set_major_formatter(FuncFormatter(_signed_power_of_ten))
    axis.set_minor_locator(NullLocator())


def _signed_power_of_ten(value: float, _position: int | None = None) -> str:
    return "0" if value == 0.0 else f"{'−' if value < 0.0 else ''}{power_of_ten(abs(value))}"

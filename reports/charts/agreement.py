"""Differences of two methods in units of the tolerance, each with its combined uncertainty."""

import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from cases.results import CaseResult, Claim, Kind
from reports.outcomes import tone_of
from reports.plates import Cell, Plate
from reports.style import BLUE, FAINT, GREEN, ORANGE, VERMILLION, mark_decades

ROWS_A_PLATE = 40
ROW_HEIGHT = 0.21  # inches
LOWEST = 1e-6  # fractions below are drawn at the left border
TONES = {"good": (BLUE, "o"), "warn": (ORANGE, "D"), "bad": (VERMILLION, "X"), "skip": (GREEN, ".")}
CAPTION = (
    "Each row is one comparison: the difference of the two answers divided by its tolerance (symbol), with the "
    "combined numerical uncertainty of both (bar). Left of the line at 1 the difference is within tolerance; a bar "
    "across it would leave the verdict open. A difference inside its own bar is what the methods themselves expect."
)
COLUMNS = (
    "claim", "scene", "quantity", "methods", "status", "verdict", "observed", "tolerance", "unit",
    "uncertainty_by_method",
)  # fmt: skip


def plates(case: CaseResult, command: str) -> list[Plate]:
    """The agreement plates of a case, worst rows first, forty rows each."""
    compared = [claim for claim in case.claims if claim.kind is Kind.AGREEMENT and claim.observed is not None]
    compared.sort(key=lambda claim: -(claim.fraction or 0.0))
    parts = [compared[i : i + ROWS_A_PLATE] for i in range(0, len(compared), ROWS_A_PLATE)]
    return [_plate(case, part, number, command) for number, part in enumerate(parts, start=1)]


def _plate(case: CaseResult, claims: Sequence[Claim], number: int, command: str) -> Plate:
    return Plate(
        name=f"{case.name}-agreement-{number}",
        title="Differences between methods, with uncertainty",
        caption=CAPTION,
        paint=lambda: draw(claims),
        columns=COLUMNS,
        rows=tuple(_row(claim) for claim in claims),
        command=command,
    )


def _row(claim: Claim) -> tuple[Cell, ...]:
    who = " against ".join(claim.methods)
    uncertain = " ".join(f"{method}={value!r}" for method, value in claim.uncertainty.items())
    words = (claim.name, claim.scene, claim.quantity, who, str(claim.status), str(claim.verdict))
    return *words, claim.observed, claim.tolerance, claim.unit, uncertain


def draw(claims: Sequence[Claim]) -> Drawing:
    """One row a claim, fraction of the tolerance on a logarithmic axis."""
    drawing = Drawing(figsize=(8.6, 0.9 + ROW_HEIGHT * len(claims)), layout="constrained")
    axes = drawing.subplots()
    axes.set(xscale="log", xlabel="difference / tolerance")
    axes.axvline(1.0, color=VERMILLION, linewidth=1.2)
    for place, claim in enumerate(claims):
        _draw_row(axes, place, claim)
    axes.set_yticks(range(len(claims)), [_label(claim) for claim in claims])
    axes.set_ylim(len(claims) - 0.5, -0.5)
    low, high = axes.get_xlim()
    axes.set_xlim(max(LOWEST, low), max(3.0, high))
    axes.grid(visible=False, axis="y")
    mark_decades(axes.xaxis)
    return drawing


def _draw_row(axes: Axes, place: int, claim: Claim) -> None:
    colour, marker = TONES[tone_of(claim.status)]
    difference = abs(claim.observed or 0.0) / claim.tolerance
    combined = math.hypot(*claim.uncertainty.values()) / claim.tolerance
    left, right = max(LOWEST, difference - combined), max(LOWEST, difference + combined)
    axes.plot([left, right], [place, place], color=FAINT, linewidth=5.0, solid_capstyle="butt", zorder=1.6)
    axes.plot([max(LOWEST, difference)], [place], color=colour, marker=marker, linestyle="none")


def _label(claim: Claim) -> str:
    return f"{claim.scene}, {claim.quantity.replace('_', ' ')}, {'/'.join(claim.methods)}"

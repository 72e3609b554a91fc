"""Stated over true errors: which share of answers lies below each ratio, one panel a family of scenes."""

from collections.abc import Sequence
from functools import partial

from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

from cases.results.records.reliability import CoverageRecord
from cases.results.records.run import CaseResult
from reports.figures.axes_grid import panel_grid
from reports.figures.figure import ReportFigure
from reports.figures.style import BLACK, look_of, mark_decades
from reports.words.method_names import display_name

COLUMNS = ("family", "method", "settings", "quantity", "share", "stated_over_true")
CAPTION = (
    "Answers whose error the referee can tell from its own uncertainty, one curve a method and quantity: what lies "
    "left of 1 is not covered. The further right a curve lies, the more is given away. The table counts all answers, "
    "those without a difference to be seen included."
)
# Ratios of stated and true error outside these are drawn at the border.
SMALLEST, LARGEST = 1e-3, 1e6


def figures(case: CaseResult) -> list[ReportFigure]:
    """One figure for all families, if anything was measured."""
    shown = [record for record in case.coverage if record.percentiles]
    drawn = ReportFigure(
        name=f"{case.name}-stated-over-true",
        title="Stated over true error",
        caption=CAPTION,
        paint=partial(draw, shown),
        columns=COLUMNS,
        rows=tuple(row for record in shown for row in _rows(record)),
    )
    return [drawn] if shown else []


def _rows(record: CoverageRecord) -> list[tuple[str | float, ...]]:
    settings = " ".join(f"{name}={value}" for name, value in record.settings.items())
    place = record.family, record.method, settings, record.quantity
    return [(*place, share, ratio) for share, ratio in zip(_shares(record), record.percentiles, strict=True)]


def _shares(record: CoverageRecord) -> list[float]:
    last = len(record.percentiles) - 1
    return [100.0 * k / last for k in range(last + 1)]


def draw(records: Sequence[CoverageRecord]) -> Drawing:
    """Panels in rows of two, a curve a method and quantity."""
    families = list(dict.fromkeys(record.family for record in records))
    drawing, all_axes = panel_grid(len(families), 2, (5.2, 3.2))
    for axes, family in zip(all_axes, families, strict=True):
        _draw_panel(axes, family, [record for record in records if record.family == family])
    return drawing


def _draw_panel(axes: Axes, family: str, records: Sequence[CoverageRecord]) -> None:
    axes.set(title=f"{family} scenes", xscale="log", xlabel="stated over true error", ylabel="share of answers [%]")
    axes.axvline(1.0, color=BLACK, linewidth=0.8)
    axes.axhline(5.0, color=BLACK, linewidth=0.6, linestyle=":")
    named: set[str] = set()
    for record in records:
        look, name = look_of(record.method), display_name(record.method)
        ratios = [min(max(ratio, SMALLEST), LARGEST) for ratio in record.percentiles]
        axes.plot(
            ratios, _shares(record), color=look.colour, linestyle=look.dash, linewidth=1.2,
            label=None if name in named else name,
        )  # fmt: skip
        named.add(name)
    axes.set_xlim(SMALLEST, LARGEST)
    axes.set_ylim(0.0, 100.0)
    mark_decades(axes.xaxis)
    axes.legend(loc="lower right")

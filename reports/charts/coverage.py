"""Stated over true errors: which share of answers lies below each ratio, one panel a family of scenes."""

from collections.abc import Iterator, Sequence

from matplotlib.axes import Axes

from cases.measurements.measurement import grouped
from cases.results.records.reliability import CoverageRecord
from cases.results.records.run import CaseResult
from reports.figures.figure import Cell, ReportFigure
from reports.figures.panel_chart import PanelChart
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
    """One figure for all families, if anything was measured: one panel a family."""
    shown = (record for record in case.coverage if record.percentiles)
    families = list(grouped(shown, lambda record: record.family).values())
    return [CHART.figure(f"{case.name}-stated-over-true", families)] if families else []


def _rows(records: Sequence[CoverageRecord]) -> Iterator[tuple[Cell, ...]]:
    for record in records:
        settings = " ".join(f"{name}={value}" for name, value in record.settings.items())
        place = record.family, record.method, settings, record.quantity
        yield from ((*place, *point) for point in zip(_shares(record), record.percentiles, strict=True))


def _shares(record: CoverageRecord) -> list[float]:
    last = len(record.percentiles) - 1
    return [100.0 * k / last for k in range(last + 1)]


def _draw_panel(axes: Axes, records: Sequence[CoverageRecord]) -> None:
    """The methods and quantities of one family of scenes, a curve each."""
    axes.set(
        title=f"{records[0].family} scenes",
        xscale="log",
        xlabel="stated over true error",
        ylabel="share of answers [%]",
    )
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


CHART = PanelChart(
    title="Stated over true error",
    caption=CAPTION,
    columns=COLUMNS,
    rows=_rows,
    panel=_draw_panel,
    size=(5.2, 3.2),
)

"""How far accepted numbers moved, one accepted run after the other."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from statistics import median

from matplotlib.axes import Axes

from cases.measurements.measurement import grouped
from cases.results.records.run import Acceptance
from reports.figures.figure import Cell, ReportFigure
from reports.figures.panel_chart import PanelChart
from reports.figures.style import look_of, mark_decades
from reports.words.method_names import display_name

COLUMNS = ("date", "revision", "method", "changed_numbers", "median_relative_change", "largest_relative_change")
CAPTION = (
    "Numbers that were accepted anew, run by run, the oldest left: relative change of each method's numbers, a marker "
    "at the median and a line up to the largest (left), and how many there were (right). New numbers do not count, "
    "but residuals and counters of work do; the reason of every change stands in the tolerance history below."
)


@dataclass(frozen=True, kw_only=True)
class AcceptedStep:
    """What one accepted run changed of one method's numbers.

    Attributes:
        run: place of the run among those that changed numbers, from 0.
        date: of the acceptance.
        revision: of the source.
        method: label.
        changes: relative, of each number that had a value before.
    """

    run: int
    date: str
    revision: str
    method: str
    changes: tuple[float, ...]


@dataclass(frozen=True, kw_only=True)
class HistoryPanel:
    """One of the two panels: what it shows of a step, and the label of its axis."""

    steps: tuple[AcceptedStep, ...]
    label: str
    draw: Callable[[Axes, AcceptedStep, str | None], None]


def figures(acceptances: Sequence[Acceptance]) -> list[ReportFigure]:
    """One figure with both panels, if any accepted number has ever changed."""
    steps = accepted_steps(acceptances)
    panels = (
        HistoryPanel(steps=steps, label="relative change", draw=_draw_changes),
        HistoryPanel(steps=steps, label="changed numbers", draw=_draw_count),
    )
    return [CHART.figure("accepted-runs", panels)] if steps else []


def accepted_steps(acceptances: Sequence[Acceptance]) -> tuple[AcceptedStep, ...]:
    """Each accepted run that changed numbers, by method, the oldest first."""
    changed = [entry for entry in acceptances if entry.new is not None and entry.old and entry.new != entry.old]
    runs = list(dict.fromkeys((entry.date, entry.revision) for entry in changed))
    groups = grouped(changed, lambda entry: (entry.date, entry.revision, entry.method))
    return tuple(
        AcceptedStep(
            run=runs.index((date, revision)),
            date=str(date),
            revision=revision[:7],
            method=method,
            changes=tuple(abs((entry.new or 0.0) / (entry.old or 1.0) - 1.0) for entry in entries),
        )
        for (date, revision, method), entries in groups.items()
    )


def _rows(panel: HistoryPanel) -> Iterator[tuple[Cell, ...]]:
    # Both panels show the same data.
    for step in panel.steps if panel.draw is _draw_changes else ():
        yield step.date, step.revision, step.method, len(step.changes), median(step.changes), max(step.changes)


def _draw_changes(axes: Axes, step: AcceptedStep, label: str | None) -> None:
    look, middle = look_of(step.method), median(step.changes)
    axes.plot([step.run, step.run], [middle, max(step.changes)], color=look.colour, linewidth=0.8)
    axes.plot([step.run], [middle], color=look.colour, marker=look.marker, linestyle="none", label=label)


def _draw_count(axes: Axes, step: AcceptedStep, label: str | None) -> None:
    look = look_of(step.method)
    axes.plot([step.run], [len(step.changes)], color=look.colour, marker=look.marker, linestyle="none", label=label)


def _draw_panel(axes: Axes, panel: HistoryPanel) -> None:
    named: set[str] = set()
    for step in panel.steps:
        name = display_name(step.method)
        panel.draw(axes, step, None if name in named else name)
        named.add(name)
    dates = {step.run: f"{step.date[5:]}\n{step.revision}" for step in panel.steps}
    axes.set(yscale="log", ylabel=panel.label, xlabel="accepted run")
    axes.set_xticks(list(dates), list(dates.values()), fontsize="small", rotation=90)
    mark_decades(axes.yaxis)
    if panel.draw is _draw_count:
        axes.legend(loc="best", fontsize="small")


CHART = PanelChart(
    title="History of accepted numbers",
    caption=CAPTION,
    columns=COLUMNS,
    rows=_rows,
    panel=_draw_panel,
    size=(4.4, 3.2),
)

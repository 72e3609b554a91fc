"""One answer as a figure: force over depth with its uncertainty, or the histories of an impact."""

import numpy as np

from cases.results.records.figure import Figure, Panel, Series
from contact import UNITS, HistoryPath, ImpactHistory, Solution
from contact.files.units import prefix_for
from reports.words.quantity_names import SYMBOLS

COLUMNS_DRAWN = {
    "force over depth": ("indentation_depth", "normal_force"),
    "contact radius over depth": ("indentation_depth", "contact_radius"),
}
HISTORIES_DRAWN = {
    "force": ("time", "normal_force"),
    "depth": ("time", "indentation_depth"),
    "contact radius": ("time", "contact_radius"),
}


def solution_figure(solution: Solution) -> Figure:
    """The figure of an answer, in units with fitting prefixes; bands where the method states an uncertainty."""
    drawn = HISTORIES_DRAWN if isinstance(solution, HistoryPath | ImpactHistory) else COLUMNS_DRAWN
    panels = tuple(_panel(solution, title, x, y) for title, (x, y) in drawn.items())
    return Figure(name="solution", title="Answer", caption="Band: uncertainty the method states.", panels=panels)


def _panel(solution: Solution, title: str, x: str, y: str) -> Panel:
    x_factor, x_prefix = prefix_for(getattr(solution, x))
    y_factor, y_prefix = prefix_for(getattr(solution, y))
    stated = y in solution.error_estimate
    half_width = np.broadcast_to(solution.uncertainty(y), len(solution)) / y_factor if stated else np.empty(0)
    series = Series(
        label=solution.method,
        method=solution.method,
        group="",
        x=tuple((getattr(solution, x) / x_factor).tolist()),
        y=tuple((getattr(solution, y) / y_factor).tolist()),
        half_width=tuple(half_width.tolist()),
        style="solid",
    )
    return Panel(title=title, x_label=_label(x, x_prefix), y_label=_label(y, y_prefix), series=(series,))


def _label(name: str, prefix: str) -> str:
    return f"{name.replace('_', ' ')} {SYMBOLS[name].replace('k_N', '$k_N$')} [{prefix}{UNITS[name]}]"

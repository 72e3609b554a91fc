"""`contact-verify sweep`: a scene over a range of one of its numbers, as table, CSV and picture."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from cases.declare.guarded_method import build_guarded
from cases.measurements.sweep import Sweep, read_range, sweep
from cases.results.records.figure import Figure, Panel, Series
from contact import InvalidInput, load_scene
from reports.bench.outputs import check_outputs, write_outputs
from reports.tables.table import Table
from reports.terminal.terminal import console, show_facts, show_table
from reports.words.numbers import measured, prefix_for


def sweep_file(
    scene_file: Path, over: str, *, method: str, outputs: Sequence[Path], progress: Callable[[int, int], None]
) -> None:
    """Sweep, print the table, and write the files.

    Raises:
        InvalidInput: For a wrong scene, range or file, or if every value is refused.
    """
    check_outputs(outputs)
    scene = load_scene(scene_file)
    found = sweep(scene, read_range(over, scene), build_guarded(method, {}), progress)
    if not found.answers:
        raise InvalidInput(f"over {over}: no value was answered; the first refusal: {found.refused[0][1]}")
    terminal = console()
    show_table(sweep_table(found), on=terminal)
    show_facts([("refused", f"{value:g}: {reason}") for value, reason in found.refused], on=terminal)
    write_outputs(outputs, found.to_csv, lambda: sweep_figure(found))


def sweep_table(found: Sweep) -> Table:
    """One row a state; quantities with their uncertainty in brackets."""
    columns = found.columns
    shown = {head: values for head, values in columns.items() if "_uncertainty" not in head}
    texts = []
    for head, values in shown.items():
        name, bracket, unit = head.partition(" [")
        spread = columns.get(f"{name}_uncertainty{bracket}{unit}", np.zeros_like(values))
        texts.append([_cell(float(v), float(u)) for v, u in zip(values, spread, strict=True)])
    note = "Digits in brackets: uncertainty of the last digits. A number without brackets is right to the digits shown."
    heads, rows = tuple(shown), tuple(zip(*texts, strict=True))
    return Table(title=f"Over {found.swept.name}", note=note, heads=heads, rows=rows, words=0)


def _cell(value: float, uncertainty: float) -> str:
    if not np.isfinite(uncertainty) or uncertainty < 0.5e-6 * abs(value) or value == 0.0:
        return f"{value:.6g}"
    return measured(value, uncertainty)


def sweep_figure(found: Sweep) -> Figure:
    """Each quantity over the varied number, a line for each state."""
    columns = found.columns
    x_head, *heads = (head for head in columns if "_uncertainty" not in head)
    values = np.unique(columns[x_head])
    states = len(columns[x_head]) // len(values)
    panels = tuple(_panel(columns[x_head], columns[head], x_head, head, states) for head in heads)
    kept = tuple(panel for panel in panels if len(set(panel.series[-1].y)) > 1)
    return Figure(name="sweep", title=f"Over {found.swept.name}", caption="One line a state.", panels=kept or panels)


def _panel(x: np.ndarray, y: np.ndarray, x_head: str, y_head: str, states: int) -> Panel:  # type: ignore[type-arg]
    x_factor, x_label = _scaled(x, x_head)
    y_factor, y_label = _scaled(y, y_head)
    series = tuple(
        Series(
            label=f"state {state + 1}",
            method="mdr",
            group=f"state {state + 1}",
            x=tuple((x[state::states] / x_factor).tolist()),
            y=tuple((y[state::states] / y_factor).tolist()),
            style="solid",
        )
        for state in range(states)
    )
    return Panel(title=y_label, x_label=x_label, y_label=y_label, series=series)


def _scaled(values: np.ndarray, head: str) -> tuple[float, str]:  # type: ignore[type-arg]
    """Factor and label with a fitting prefix."""
    name, bracket, unit = head.partition(" [")
    words = name.replace("_", " ")
    if not bracket:
        return 1.0, words
    factor, prefix = prefix_for(values.tolist())
    return factor, f"{words} [{prefix}{unit}"

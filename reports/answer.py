"""Tables of answers with error estimates, and CSV files with every digit."""

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from cases.declare.quantities import single_numbers
from cases.files import csv_text
from contact import (
    UNITS,
    ContactPath,
    ImpactHistory,
    InvalidInput,
    Layer,
    Solution,
    StageRecord,
)
from contact.answer.evidence import SYMBOLS
from contact.answer.friction import friction_notes
from contact.answer.small_strains import depth_note, depths_of
from contact.answer.solution import scene_line
from contact.records.units import prefix_for
from contact.records.validation import FloatArray, IntArray
from reports.words import (
    Table,
    display_name,
    duration,
    measured,
    memory,
    quantity_words,
    scaled_column,
    scaled_unit,
    small,
    with_article,
)

if TYPE_CHECKING:
    from cases.run.propagation import Propagated, PropagatedQuantity
    from cases.sweep import Sweep

BRACKETS = (
    "Digits in brackets: error of the last digits, stated by the method; (?) where it states none. Other numbers are "
    "right to the digits printed."
)
# Most digits of a printed number, also where its uncertainty is smaller.
DIGITS = 6
# Rows of a printed table: half as many hide a curve, twice as many push what stands above off the screen.
MOST_ROWS = 10


def solution_table(solution: Solution) -> Table:
    """At most ten states of an answer, each number with the uncertainty that the method states."""
    shown, where = _shown_rows(len(solution), "states")
    # Energies of an impact stand in files alone.
    names = [n for n in solution.ARRAYS if not (isinstance(solution, ImpactHistory) and n.endswith("energy"))]
    heads, columns = [], []
    for name in names:
        factor, prefix = prefix_for(getattr(solution, name))
        heads.append(f"{SYMBOLS[name]} [{prefix}{UNITS[name]}]")
        numbers = np.asarray(getattr(solution, name))[shown] / factor, _uncertainty(solution, name)[shown] / factor
        columns.append([_readable(float(value), float(error)) for value, error in zip(*numbers, strict=True)])
    symbols = ", ".join(f"{SYMBOLS[name]}: {quantity_words(name)}" for name in names)
    rows = tuple(zip(*columns, strict=True))
    note = f"{where}{symbols}. {_digits(rows)}"
    return Table(title=_title(solution), note=note, heads=tuple(heads), rows=rows, words=0)


def _digits(rows: Iterable[tuple[str, ...]]) -> str:
    """Sentence about the digits of a table that are right."""
    return BRACKETS if any("(" in cell for row in rows for cell in row) else "All digits printed are right."


def _shown_rows(count: int, what: str) -> tuple[IntArray, str]:
    """At most ten rows of a table, the first and the last among them, and where the others are."""
    rows = np.linspace(0, count - 1, min(count, MOST_ROWS)).round().astype(np.int64)
    return rows, f"{len(rows)} of {count} {what}; --write FILE.csv has all. " * (len(rows) < count)


def _title(solution: Solution) -> str:
    """Method, indenter, layer: "MDR: TruncatedCone on a bonded layer, nu = 0.45"."""
    effects = "".join(f", {type(effect).__name__}" for effect in solution.scene.effects)
    indenter = type(solution.scene.indenter).__name__
    return f"{display_name(solution.method)}: {indenter} on {with_article(solution.scene.layer.title)}{effects}"


def _readable(value: float, uncertainty: float) -> str:
    """The value to at most `DIGITS` digits, or with its absolute uncertainty in brackets where that allows fewer."""
    if uncertainty < 0.5 * abs(value) * 10.0**-DIGITS:
        return f"{value:.{DIGITS}g}"
    return measured(value, uncertainty)


# Arrays of an answer that the loading prescribes, and that have no error.
GIVEN = {
    "ContactRadii": ("contact_radius",),
    "IndentationDepths": ("indentation_depth",),
    "NormalForces": ("normal_force",),
    "DepthHistory": ("time", "indentation_depth"),
    "ForceHistory": ("time", "normal_force"),
    "Impact": ("time",),
    "Detachment": ("contact_radius",),
}


def _uncertainty(solution: Solution, name: str) -> FloatArray:
    """Absolute uncertainty, shape (n,): zero for what the scene prescribes, infinite where the method states none."""
    if name in GIVEN[type(solution.scene.loading).__name__]:
        return np.zeros(len(solution))
    stated = solution.stated_error(name)
    return np.full(len(solution), np.inf) if stated is None else stated


def difference_table(solution: Solution, other: Solution) -> Table:
    """The largest difference of each quantity of two answers to one scene, and the errors that both state.

    Raises:
        InvalidInput: If the answers are of another kind or have other states.
    """
    if type(other) is not type(solution) or len(other) != len(solution):
        raise InvalidInput(
            f"{solution.method} gives {len(solution)} states and {other.method} {len(other)}: they choose their states "
            "themselves; prescribe radii, depths or forces to compare them"
        )
    rows = []
    for name in solution.ARRAYS:
        values, others = getattr(solution, name), getattr(other, name)
        step = int(np.argmax(np.abs(values - others)))
        scale = float(np.max(np.abs(values))) or 1.0
        stated = np.hypot(_uncertainty(solution, name), _uncertainty(other, name))[step] / scale
        difference = float(abs(values[step] - others[step])) / scale
        rows.append((quantity_words(name), small(difference), small(stated) if np.isfinite(stated) else "(?)"))
    return Table(
        title=f"{display_name(solution.method)} against {display_name(other.method)}",
        note="Largest difference over all states, over the largest value; stated: by both methods together, there.",
        heads=("quantity", "difference", "stated"),
        rows=tuple(rows),
    )


def critical_facts(solution: Solution) -> list[tuple[str, str]]:
    """Pull-off of a detachment, restitution and peaks of an impact; nothing for a plain path."""
    return [(quantity_words(name), _critical_value(solution, name)) for name in single_numbers(solution)]


def solution_notes(solution: Solution) -> list[tuple[str, str]]:
    """Notes to read before the numbers: a warning of deep contacts, and notes that no `validity` line replaces."""
    warning = depth_note(solution.scene, depths_of(solution))
    replaced: tuple[str, ...] = ()
    if isinstance(solution.scene.layer, Layer) and isinstance(solution, ContactPath):
        replaced = friction_notes(solution.scene.layer, solution.contact_radius)
    notes = [("note", note) for note in solution.notes if note not in (warning, *replaced)]
    return [("warning", warning), *notes] if warning else notes


def solution_facts(solution: Solution) -> list[tuple[str, str]]:
    """Error estimate, cost, stages and scene of an answer."""
    worst = {name: float(np.max(error)) for name, error in solution.error_estimate.items() if np.size(error)}
    estimates = ", ".join(f"{quantity_words(name)} {small(error)}" for name, error in worst.items())
    facts = [("relative error estimate", estimates)] if estimates else []
    facts += [("cost", f"{duration(solution.cost.wall_seconds)}, {solution.cost.unknowns} unknowns")]
    facts += [("stages", ", ".join(map(_stage, solution.stages)))] if solution.stages else []
    return [*facts, ("scene", scene_line(solution.scene))]


def _critical_value(solution: Solution, name: str) -> str:
    """A single number of the answer with its stated uncertainty in brackets, and its unit."""
    value = float(getattr(solution, name))
    relative = solution.error_estimate.get(name)
    factor, unit = scaled_unit(value, UNITS[name])
    uncertainty = float("inf") if relative is None else float(np.max(relative)) * abs(value)
    return f"{_readable(value / factor, uncertainty / factor)} {unit}".strip()


def solution_csv(solution: Solution) -> str:
    """Every state in SI units with its absolute uncertainty; an uncertainty the method does not state stays empty."""
    columns: dict[str, list[float | str]] = {}
    for name in solution.ARRAYS:
        unit = UNITS[name].replace("/", "_per_")
        columns[f"{name}_{unit}"] = getattr(solution, name).tolist()
        stated = _uncertainty(solution, name).tolist()
        columns[f"{name}_uncertainty_{unit}"] = [error if np.isfinite(error) else "" for error in stated]
    return csv_text(columns, zip(*columns.values(), strict=True))


def _stage(stage: StageRecord) -> str:
    """A stage of the solution in words: name, time, number of calls and declared memory."""
    times = "" if stage.calls == 1 else f" in {stage.calls} calls"
    size = f", {memory(stage.bytes)}" if stage.bytes else ""
    return f"{quantity_words(stage.name)} {duration(stage.wall_seconds)}{times}{size}"


# Least correlation of a pair of quantities that is printed.
LEAST_CORRELATION = 0.5


def propagated_table(propagated: "Propagated") -> Table:
    """Value, numerical error, uncertainty by the inputs and the contribution of each input, at the last step."""
    names = list(propagated.quantities[0].by_input) if propagated.quantities else []
    words = [quantity_words(quantity.name) for quantity in propagated.quantities]
    note = "Standard uncertainty by the inputs at the last step, and the error of the method; "
    note += f"{propagated.solved} scenes solved{'' if names else ', by samples'}."
    if nonlinear := [word for word, q in zip(words, propagated.quantities, strict=True) if q.is_nonlinear]:
        note += f" Not linear over these uncertainties: {', '.join(nonlinear)}; --samples uses whole distributions."
    pairs = [(words[i], words[j], float(propagated.correlation[i, j])) for j in range(len(words)) for i in range(j)]
    if correlated := [f"{a} and {b} ({share:+.2f})" for a, b, share in pairs if abs(share) >= LEAST_CORRELATION]:
        note += f" Correlated: {', '.join(correlated)}."
    heads = ("quantity", "value", "numerical error", "by inputs", "relative", *names)
    rows = tuple(_row(quantity, names) for quantity in propagated.quantities)
    return Table(title="Uncertain inputs", note=note, heads=heads, rows=rows)


def _row(quantity: "PropagatedQuantity", names: list[str]) -> tuple[str, ...]:
    """Cells of a quantity at its last step: value, numerical error, uncertainty, and change by each input."""
    value, spread = float(quantity.values[-1]), float(quantity.inputs[-1])
    factor, unit = scaled_unit(value, quantity.unit)
    size = abs(value) or 1.0
    return (
        quantity_words(quantity.name),
        f"{measured(value / factor, spread / factor) if spread else f'{value / factor:.6g}'} {unit}".strip(),
        "(?)" if quantity.numerical is None else small(float(quantity.numerical[-1]) / size),
        f"{small(spread / factor)} {unit}".strip(),
        f"{100 * spread / size:.2g} %",
        *(f"{100 * float(quantity.by_input[name][-1]) / size:+.2g} %" for name in names),
    )


def sweep_table(sweep: "Sweep") -> Table:
    """At most ten rows, one per state; quantities with their uncertainty in brackets."""
    columns, texts = sweep.columns, {}
    for head, values in columns.items():
        if "_uncertainty" not in head:
            name, bracket, unit = head.partition(" [")
            errors = columns.get(f"{name}_uncertainty{bracket}{unit}", np.zeros_like(values))
            exact = ~np.isfinite(errors) | (values == 0.0)
            factor, words = scaled_column(head, values.tolist())
            numbers = zip((values / factor).tolist(), (np.where(exact, 0.0, errors) / factor).tolist(), strict=True)
            texts[words] = [f"{value:.6g}" if error == 0.0 else _readable(value, error) for value, error in numbers]
    every = list(zip(*texts.values(), strict=True))
    shown, where = _shown_rows(len(every), "rows")
    rows = tuple(every[row] for row in shown)
    title = f"Over {quantity_words(sweep.swept.name)}"
    return Table(title=title, note=f"{where}{_digits(rows)}", heads=tuple(texts), rows=rows, words=0)

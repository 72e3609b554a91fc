"""An answer as people and spreadsheets read it: tables with error bars, and CSV with every digit."""

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import numpy as np

from cases.declare.quantities import single_numbers
from cases.results.csv_table import csv_text
from contact import (
    UNITS,
    ContactPath,
    DetachmentPath,
    FrictionHistory,
    FrictionPath,
    HistoryPath,
    ImpactHistory,
    InvalidInput,
    Solution,
    StageRecord,
)
from contact.answer.evidence import SYMBOLS
from contact.answer.small_strains import depth_note, depths_of
from contact.answer.solution import scene_line
from contact.records.units import prefix_for
from contact.records.validation import FloatArray
from reports.words import Table, display_name, duration, measured, memory, scaled_unit, small

if TYPE_CHECKING:
    from cases.measurements.sweep import Sweep
    from cases.run.propagation import Propagated, PropagatedQuantity

BRACKETS = (
    "Digits in brackets: uncertainty of the last digits, as the method itself estimates it; (?) where it gives none. "
    "A number without brackets is right to the digits printed; --write FILE.csv writes all of them."
)
# Digits of a printed number whose uncertainty is beyond them: as many as anybody compares by eye.
DIGITS = 6
# Rows of a printed table; longer answers show every n-th state and the last one.
LONGEST = 40

PRINTED = {
    ContactPath: ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness"),
    DetachmentPath: ("contact_radius", "indentation_depth", "normal_force"),
    FrictionPath: ("contact_radius", "indentation_depth", "normal_force", "stick_radius", "dissipated_energy"),
    FrictionHistory: ("time", "indentation_depth", "normal_force", "contact_radius", "dissipated_energy"),
    HistoryPath: ("time", "indentation_depth", "normal_force", "contact_radius"),
    ImpactHistory: ("time", "indentation_depth", "velocity", "normal_force", "contact_radius"),
}


def solution_table(solution: Solution, longest: int = LONGEST) -> Table:
    """The states of an answer, each number with the uncertainty that the method states."""
    names = PRINTED[type(solution)]
    shown = _shown(len(solution), longest)
    factors = {name: prefix_for(getattr(solution, name)) for name in names}
    heads = tuple(f"{SYMBOLS[name]} [{factors[name][1]}{UNITS[name]}]" for name in names)
    columns = [_column(solution, name, factors[name][0], shown) for name in names]
    omitted = len(solution) - len(shown)
    skipped = f" {omitted} of {len(solution)} states are not printed." if omitted else ""
    return Table(
        title=_title(solution),
        note=f"{BRACKETS}{skipped}",
        heads=heads,
        rows=tuple(zip(*columns, strict=True)),
        words=0,
    )


def _title(solution: Solution) -> str:
    """Method, indenter, layer: "MDR: TruncatedCone on a bonded layer, nu = 0.45"."""
    effects = "".join(f", {type(effect).__name__}" for effect in solution.scene.effects)
    indenter = type(solution.scene.indenter).__name__
    return f"{display_name(solution.method)}: {indenter} on a {solution.scene.layer.title}{effects}"


def _shown(states: int, longest: int) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Indices of the printed states, first and last among them."""
    # Their distances are one at least, so that none comes twice.
    return np.linspace(0, states - 1, min(states, longest)).round().astype(np.intp)


def _column(solution: Solution, name: str, factor: float, shown: Iterable[int]) -> list[str]:
    values = np.asarray(getattr(solution, name), dtype=np.float64) / factor
    uncertain = _uncertainty(solution, name) / factor
    return [_readable(float(values[i]), float(uncertain[i])) for i in shown]


def _readable(value: float, uncertainty: float) -> str:
    """At most `DIGITS` digits; fewer where the uncertainty allows no more."""
    if uncertainty < 0.5 * abs(value) * 10.0**-DIGITS:
        return f"{value:.{DIGITS}g}"
    return measured(value, uncertainty)


def _uncertainty(solution: Solution, name: str) -> FloatArray:
    """Absolute uncertainty, shape (n,): zero for what the scene prescribes, infinite where the method states none."""
    states = (len(solution),)
    if name in _prescribed(solution):
        return np.zeros(states)
    if name not in solution.error_estimate:
        return np.full(states, np.inf)
    return np.array(np.broadcast_to(solution.uncertainty(name), states))


def _prescribed(solution: Solution) -> tuple[str, ...]:
    """What the loading gives: exact by definition."""
    given = {
        "ContactRadii": ("contact_radius",),
        "IndentationDepths": ("indentation_depth",),
        "NormalForces": ("normal_force",),
        "DepthHistory": ("time", "indentation_depth"),
        "ForceHistory": ("time", "normal_force"),
        "Impact": ("time",),
        "Detachment": ("contact_radius",),
    }
    return given[type(solution.scene.loading).__name__]


def difference_table(solution: Solution, other: Solution) -> Table:
    """The largest difference of each quantity of two answers to one scene, beside the error that both state.

    Raises:
        InvalidInput: if the answers are of another kind or have other states.
    """
    if type(other) is not type(solution) or len(other) != len(solution):
        raise InvalidInput(
            f"{solution.method} gives {len(solution)} states and {other.method} {len(other)}: they choose their states "
            "themselves; prescribe radii, depths or forces to compare them"
        )
    rows = []
    for name in PRINTED[type(solution)]:
        values, others = getattr(solution, name), getattr(other, name)
        step = int(np.argmax(np.abs(values - others)))
        scale = float(np.max(np.abs(values))) or 1.0
        stated = np.hypot(_uncertainty(solution, name), _uncertainty(other, name))[step] / scale
        difference = float(abs(values[step] - others[step])) / scale
        rows.append((name.replace("_", " "), small(difference), small(stated) if np.isfinite(stated) else "(?)"))
    return Table(
        title=f"{display_name(solution.method)} against {display_name(other.method)}",
        note="Largest difference over all states, over the largest value; stated: by both methods together, there.",
        heads=("quantity", "difference", "stated"),
        rows=tuple(rows),
    )


def solution_facts(solution: Solution) -> list[tuple[str, str]]:
    """What is said once of an answer: critical values, cost, own error estimate, notes but that on the depth."""
    facts = _critical_values(solution)
    worst = {name: float(np.max(error)) for name, error in solution.error_estimate.items() if np.size(error)}
    estimates = ", ".join(f"{name.replace('_', ' ')} {small(error)}" for name, error in worst.items())
    facts += [("relative error estimate", estimates)] if estimates else []
    facts += [("cost", f"{duration(solution.cost.wall_seconds)}, {solution.cost.unknowns} unknowns")]
    facts += [("stages", ", ".join(map(_stage, solution.stages)))] if solution.stages else []
    facts += [("scene", scene_line(solution.scene))]
    above = depth_note(solution.scene, depths_of(solution))
    return facts + [("note", note) for note in solution.notes if note != above]


def _critical_values(solution: Solution) -> list[tuple[str, str]]:
    """Pull-off of a detachment, restitution and peaks of an impact; nothing for a plain path."""
    return [(name.replace("_", " "), _critical_value(solution, name)) for name in single_numbers(solution)]


def _critical_value(solution: Solution, name: str) -> str:
    value = float(getattr(solution, name))
    relative = solution.error_estimate.get(name)
    factor, unit = scaled_unit(value, UNITS[name])
    uncertainty = float("inf") if relative is None else float(np.max(relative)) * abs(value)
    return f"{_readable(value / factor, uncertainty / factor)} {unit}".strip()


def solution_csv(solution: Solution) -> str:
    """Every state in SI units with its absolute uncertainty; an uncertainty the method does not state stays empty."""
    units = [(name, UNITS[name].replace("/", "_per_")) for name in solution.ARRAYS]
    heads = [head for name, unit in units for head in (f"{name}_{unit}", f"{name}_uncertainty_{unit}")]
    columns = [part for name in solution.ARRAYS for part in _csv_columns(solution, name)]
    return csv_text(heads, zip(*columns, strict=True))


def _csv_columns(solution: Solution, name: str) -> tuple[list[float], list[float | str]]:
    uncertain = _uncertainty(solution, name).tolist()
    return getattr(solution, name).tolist(), [u if np.isfinite(u) else "" for u in uncertain]


def _stage(stage: StageRecord) -> str:
    """The effect ledger in words: what ran, how long, how often, and the bytes it declared."""
    times = "" if stage.calls == 1 else f" in {stage.calls} calls"
    size = f", {memory(stage.bytes)}" if stage.bytes else ""
    return f"{stage.name.replace('_', ' ')} {duration(stage.wall_seconds)}{times}{size}"


# Pairs of quantities are listed where they move together at least so much.
TOGETHER = 0.5


def propagated_table(found: "Propagated") -> Table:
    """Value, numerical error, uncertainty by the inputs and what each input contributes, of the last step."""
    names = list(found.quantities[0].by_input) if found.quantities else []
    rows = tuple(_row(one, names) for one in found.quantities)
    how = f"{found.solved} scenes solved" + ("" if names else ", by samples")
    bent = [one.name.replace("_", " ") for one in found.quantities if one.bends]
    advice = (
        f" Not linear over these uncertainties: {', '.join(bent)}; --samples takes the whole of it." if bent else ""
    )
    return Table(
        title="Uncertain inputs",
        note=f"Standard uncertainty by the inputs at the last step, beside the error of the method; {how}.{advice}"
        f"{_together(found)}",
        heads=("quantity", "value", "numerical error", "by inputs", "relative", *names),
        rows=rows,
        words=1,
    )


def _row(one: "PropagatedQuantity", names: list[str]) -> tuple[str, ...]:
    value, spread = float(one.values[-1]), float(one.inputs[-1])
    numerical = None if one.numerical is None else float(one.numerical[-1])
    factor, unit = scaled_unit(value, one.unit)
    size = abs(value) or 1.0
    return (
        one.name.replace("_", " "),
        f"{measured(value / factor, spread / factor) if spread else f'{value / factor:.6g}'} {unit}".strip(),
        "(?)" if numerical is None else small(numerical / size),
        f"{small(spread / factor)} {unit}".strip(),
        f"{100 * spread / size:.2g} %",
        *(f"{100 * float(one.by_input[name][-1]) / size:+.2g} %" for name in names),
    )


def _together(found: "Propagated") -> str:
    pairs = list(_pairs(found))
    return f" Moving together: {', '.join(pairs)}." if pairs else ""


def _pairs(found: "Propagated") -> Iterator[str]:
    names = [one.name.replace("_", " ") for one in found.quantities]
    for i, j in zip(*np.triu_indices(len(names), 1), strict=True):
        share = float(found.correlation[i, j])
        if abs(share) >= TOGETHER:
            yield f"{names[i]} and {names[j]} ({share:+.2f})"


def sweep_table(found: "Sweep") -> Table:
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

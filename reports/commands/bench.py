"""`contact-verify fit` and `sweep`: read, compute, print, and write the files asked for."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cases.declare.guarded_method import build_guarded
from cases.declare.uncertain_inputs import read_inputs
from cases.measurements.sweep import read_range, sweep
from cases.measurements.uncertain_fit import fit_uncertain
from cases.results.files import write_whole
from contact import InvalidInput, load_scene
from contact.answer.small_strains import depth_note, depth_share, depths_of
from contact.files.scene_file import scene_notes, uses_units
from mdr.curves import fit_curve, fit_map, read_curve, read_map
from reports.tables.curve_tables import fit_csv, fit_table, formula_table, map_csv, map_facts, shares_table, sweep_table
from reports.terminal.terminal import console, show_facts, show_table
from reports.words.numbers import small


def fit_file(
    file: Path,
    scene_file: Path,
    also: Sequence[str],
    *,
    uncertain: str,
    number: int,
    confidence: float,
    outputs: Sequence[Path],
) -> None:
    """Fit one curve, print what was found, and write the files.

    Raises:
        InvalidInput: For a wrong scene, curve, parameter or file.
    """
    _check_outputs(outputs)
    scene, (depth, force) = load_scene(scene_file), read_curve(file, number)
    # Names that are no parameters are refused by the fit itself.
    parameters: Any = ("youngs_modulus", *also)
    terminal = console()
    if uncertain:
        inputs = read_inputs(uncertain, scene, with_units=uses_units(scene_file))
        carried = fit_uncertain(scene, depth, force, inputs, parameters=parameters, confidence=confidence)
        found = carried.fit
        show_table(fit_table(found), on=terminal)
        show_table(shares_table(carried), on=terminal)
    else:
        found = fit_curve(scene, depth, force, parameters=parameters, confidence=confidence)
        show_table(fit_table(found), on=terminal)
    show_table(formula_table(found), on=terminal)
    facts = [("numerical error", f"{small(found.numerical_error)} of E, in its interval")]
    facts += [("warning", line) for line in found.warnings] + [("note", line) for line in scene_notes(scene_file)]
    show_facts(facts, on=terminal)
    _write_outputs(outputs, lambda: fit_csv(found), "fit_figure", found)


def fit_map_file(
    file: Path,
    scene_file: Path,
    also: Sequence[str],
    *,
    confidence: float,
    outputs: Sequence[Path],
    progress: Callable[[int, int], None],
) -> None:
    """Fit every curve of a map, print a summary, and write a row for each curve.

    Raises:
        InvalidInput: For a wrong scene, map, parameter or file.
    """
    _check_outputs(outputs)
    if not set(also) <= {"contact_point", "baseline"}:
        raise InvalidInput(f"--with {', '.join(also)}: curves of a map are fitted with contact_point, and baseline")
    scene, (depth, force) = load_scene(scene_file), read_map(file)
    found = fit_map(scene, depth, force, baseline="baseline" in also, confidence=confidence, progress=progress)
    note = depth_note(scene, np.max(depth) - np.nanmin(found.contact_point))
    show_facts([("warning", note)] * bool(note) + map_facts(found), on=console())
    _write_outputs(outputs, lambda: map_csv(found), "map_figure", found)


def sweep_file(
    scene_file: Path, over: str, *, method: str, outputs: Sequence[Path], progress: Callable[[int, int], None]
) -> None:
    """Sweep, print the table, and write the files.

    Raises:
        InvalidInput: For a wrong scene, range or file, or if every value is refused.
    """
    _check_outputs(outputs)
    scene = load_scene(scene_file)
    found = sweep(
        scene, read_range(over, scene, with_units=uses_units(scene_file)), build_guarded(method, {}), progress
    )
    if not found.answers:
        raise InvalidInput(f"over {over}: no value was answered; the first refusal: {found.refused[0][1]}")
    terminal = console()
    pressed = [(answer.scene, depths_of(answer)) for _, answer in found.answers]
    note = depth_note(*max(pressed, key=lambda one: depth_share(*one)))
    show_facts([("warning", f"at its deepest, {note}")] * bool(note), on=terminal)
    show_table(sweep_table(found), on=terminal)
    show_facts([("refused", f"{value:g}: {reason}") for value, reason in found.refused], on=terminal)
    _write_outputs(outputs, found.to_csv, "sweep_figure", found)


def _check_outputs(outputs: Sequence[Path]) -> None:
    """Refuse files that cannot be written.

    Raises:
        InvalidInput: For another ending than .csv or .svg, or a folder that is not there.
    """
    for path in outputs:
        if path.suffix not in (".csv", ".svg"):
            raise InvalidInput(f"--write {path}: the ending says the format; use .csv or .svg")
        if path.is_dir() or not path.parent.is_dir():
            raise InvalidInput(f"--write {path}: no file can be there; check that the folder exists")


def _write_outputs(outputs: Sequence[Path], table: Callable[[], str], figure: str, found: object) -> None:
    """Write the table to files that end with .csv, the figure of that name in `reports.charts.curves` to the others."""
    for path in outputs:
        if path.suffix == ".csv":
            write_whole(path, table())
        else:
            # Matplotlib only where it is asked for.
            from reports.charts import curves  # noqa: PLC0415
            from reports.figures.renderer import figure_svg  # noqa: PLC0415

            write_whole(path, figure_svg(getattr(curves, figure)(found)))
        console().print(f"written: {path}")

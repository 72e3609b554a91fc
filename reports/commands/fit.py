"""`contact-verify fit`: the meaning of its options, and the tables and files of a fit."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np

from cases.declare.uncertain_inputs import read_inputs
from cases.uncertain_fit import fit_uncertain
from contact import Adhesion, InvalidInput, Scene, load_scene
from contact.files.scene_file import uses_units
from contact.records.units import read_quantity
from contact.scene.effects import Viscoelasticity
from mdr.curves import Limit, fit_curve, fit_history, fit_map
from mdr.curves.fit import DEFAULT_PARAMETERS
from mdr.curves.reading import Cantilever, Direction, Measured, load_curves, numbered
from reports.files import PICTURES, check_outputs, csv_writer, picture_writers, write_outputs
from reports.fit_tables import fit_csv, fit_table, formula_table, map_csv, map_facts, shares_table
from reports.terminal import console, progress_bar, show_facts, show_table
from reports.words import small

# Stands for all parameters that are fitted by default in addition to the modulus.
ALL = "all"


def fit_file(
    file: Path,
    scene_file: Path,
    *,
    fit: str,
    also: str,
    until: str,
    uncertain: str,
    number: int | None,
    confidence: float,
    outputs: Sequence[Path],
    **source: str,
) -> None:
    """Fit one curve of a file, or all of a map where its number is None; print the fit, and write the files.

    Raises:
        InvalidInput: For a wrong scene, curve, parameter or file.
    """
    if uncertain and (number is None or until):
        raise InvalidInput("--uncertain is for whole single curves; leave --map and --until out")
    check_outputs(outputs, {".csv": "CSV", **PICTURES})
    scene = load_scene(scene_file)
    if _relaxes(scene) and (number is None or uncertain or until):
        raise InvalidInput(
            "--map, --uncertain and --until are for scenes that do not relax; fit single curves (--curve NUMBER)"
        )
    curves = read_curves(file, scene, is_map=number is None, **source)
    options: Any = {"parameters": fitted_parameters(scene, fit, also), "confidence": confidence}
    if number is None:
        _fit_map(scene, curves, outputs, limit=read_limit(until), **options)
        return
    curve, shares = numbered(curves, number, file), []
    with progress_bar("fitting"):
        if _relaxes(scene):
            result = fit_history(scene, curve.time, curve.depth, curve.force, **options)
        elif uncertain:
            inputs = read_inputs(uncertain, scene, with_units=uses_units(scene_file))
            uncertain_fit = fit_uncertain(scene, curve.depth, curve.force, inputs, **options)
            result, shares = uncertain_fit.fit, [shares_table(uncertain_fit)]
        else:
            result = fit_curve(scene, curve.depth, curve.force, limit=read_limit(until), **options)
    # Warnings are printed first, since they are overlooked below the numbers.
    show_facts([("warning", line) for line in result.warnings], on=console())
    for table in (fit_table(result), *shares, formula_table(result)):
        show_table(table, on=console())
    facts = [("R^2 in contact", f"{result.r_squared:.6f}")]
    facts += [("numerical error", f"{small(result.numerical_error)} of the modulus, included in its interval")]
    facts += [("note", line) for line in (*result.notes, *curve.notes)]
    show_facts(facts, on=console())
    pictures = picture_writers(lambda: _figures().fit_figure(result), key="fit")
    write_outputs(outputs, {**csv_writer(lambda: fit_csv(result)), **pictures})


def _fit_map(scene: Scene, curves: list[Measured], outputs: Sequence[Path], **options: Any) -> None:
    """Fit all curves of a map, print the summary, and write the files."""
    depths, forces = ([getattr(curve, name) for curve in curves] for name in ("depth", "force"))
    positions = np.array([curve.position for curve in curves])
    with progress_bar("fitting curves") as progress:
        fits = fit_map(scene, depths, forces, positions=positions, progress=progress, **options)
    show_facts(map_facts(fits), on=console())
    pictures = picture_writers(lambda: _figures().map_figure(fits), key="fit")
    write_outputs(outputs, {**csv_writer(lambda: map_csv(fits)), **pictures})


def fitted_parameters(scene: Scene, fit: str, also: str) -> tuple[str, ...]:
    """Names of the fitted parameters; by default those of elastic or of relaxing scenes."""
    first, *others = DEFAULT_PARAMETERS
    if _relaxes(scene):
        first, others = "moduli,times", ["contact_point", "baseline"]
    names = f"{fit or first},{','.join(others) if also == ALL else also}".split(",")
    return tuple(name.strip() for name in names if name.strip())


def read_limit(until: str) -> Limit | None:
    """The largest depth, force or share of the force; None for an empty text.

    Raises:
        InvalidInput: For what is none of them.
    """
    text = until.strip()
    if not text:
        return None
    try:
        if text.endswith("%"):
            return Limit("fraction", float(text[:-1]) / 100)
        kind: Literal["depth", "force"] = "force" if text.endswith("N") else "depth"
        return Limit(kind, float(read_quantity(text, "N" if kind == "force" else "m", "--until")))
    except ValueError as error:
        raise InvalidInput(f"--until {text}: write a depth, a force or a share, 300nm, 2nN or 60% ({error})") from None


def read_curves(
    file: Path, scene: Scene, *, is_map: bool, units: str, spring_constant: str, sensitivity: str
) -> list[Measured]:
    """The curves of the file: loading, with adhesion withdrawal, of relaxing scenes all points."""
    stiffness = read_quantity(spring_constant, "N/m", "--spring-constant") if spring_constant else None
    factor = read_quantity(sensitivity.partition("/")[0], "m", "--sensitivity") if sensitivity else None
    direction: Direction = "loading" if scene.effect(Adhesion) is None else "withdrawal"
    direction = "history" if _relaxes(scene) else direction
    return load_curves(file, units=units, cantilever=Cantilever(stiffness, factor), direction=direction, is_map=is_map)


def _relaxes(scene: Scene) -> bool:
    return scene.effect(Viscoelasticity) is not None


def _figures() -> Any:
    # Matplotlib is loaded only for pictures.
    from reports import fit_figures  # noqa: PLC0415

    return fit_figures

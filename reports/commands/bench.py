"""`contact-verify fit`: read, compute, print, and write the files asked for."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np

from cases.declare.uncertain_inputs import read_inputs
from cases.files import write_whole
from cases.uncertain_fit import fit_uncertain
from contact import Adhesion, InvalidInput, Scene, load_scene
from contact.files.scene_file import scene_notes, uses_units
from contact.records.units import read_quantity
from contact.scene.effects import Viscoelasticity
from mdr.curves import Limit, fit_curve, fit_history, fit_map
from mdr.curves.fit import DEFAULT_PARAMETERS
from mdr.curves.reading import Cantilever, Direction, Measured, load_curves, read_map
from reports.files import PICTURES, check_outputs, write_picture
from reports.fit_tables import fit_csv, fit_table, formula_table, map_csv, map_facts, shares_table
from reports.terminal import console, show_facts, show_table
from reports.words import small

# Stands for all that is fitted beside by default.
ALL: Final = "all"


@dataclass(frozen=True, kw_only=True)
class FitRequest:
    """What the command line says about a fit.

    Attributes:
        fit: Names of the fitted moduli, empty for the default.
        also: Names of what is fitted beside them, or `ALL`.
        units: Of columns without their own.
        spring_constant: With its unit, or empty.
        sensitivity: With its unit, or empty.
        until: Largest depth, force or share of the force, or empty.
        number: Which curve of a file.
        confidence: Of intervals.
        outputs: Files to write.
    """

    fit: str
    also: str
    units: str
    spring_constant: str
    sensitivity: str
    until: str
    number: int
    confidence: float
    outputs: Sequence[Path]

    def parameters(self, scene: Scene) -> tuple[str, ...]:
        """Names of all that is fitted; where options name nothing, the default of elastic or of relaxing scenes."""
        first, *others = DEFAULT_PARAMETERS
        if _relaxes(scene):
            first, others = "moduli,times", ["contact_point", "baseline"]
        also = ",".join(others) if self.also == ALL else self.also
        return tuple(name.strip() for name in (*(self.fit or first).split(","), *also.split(",")) if name.strip())

    def limit(self) -> Limit | None:
        """The largest depth, force or share.

        Raises:
            InvalidInput: For what is none of them.
        """
        text = self.until.strip()
        if not text:
            return None
        try:
            if text.endswith("%"):
                return Limit("fraction", float(text[:-1]) / 100)
            kind: Literal["depth", "force"] = "force" if text.endswith("N") else "depth"
            return Limit(kind, read_quantity(text, "N" if kind == "force" else "m", "--until"))
        except ValueError as error:
            raise InvalidInput(
                f"--until {text}: write a depth, a force or a share, 300nm, 2nN or 60% ({error})"
            ) from None

    def curves(self, file: Path, scene: Scene, *, is_map: bool = False) -> list[Measured]:
        """The curves of the file: loading, with adhesion withdrawal, of relaxing scenes all points."""
        given = [
            read_quantity(text, unit, name) if text else None
            for text, unit, name in (
                (self.spring_constant, "N/m", "--spring-constant"),
                (self.sensitivity.partition("/")[0], "m", "--sensitivity"),
            )
        ]
        direction: Direction = "loading" if scene.effect(Adhesion) is None else "withdrawal"
        read = read_map if is_map else load_curves
        return read(
            file,
            units=self.units,
            cantilever=Cantilever(*given),
            direction="history" if _relaxes(scene) else direction,
        )


def _relaxes(scene: Scene) -> bool:
    return scene.effect(Viscoelasticity) is not None


def fit_file(file: Path, scene_file: Path, request: FitRequest, *, uncertain: str) -> None:
    """Fit one curve, print what was found, and write the files.

    Raises:
        InvalidInput: For a wrong scene, curve, parameter or file.
    """
    check_outputs(request.outputs, {".csv": "CSV", **PICTURES})
    scene = load_scene(scene_file)
    curves = request.curves(file, scene)
    if not 0 <= request.number < len(curves):
        raise InvalidInput(f"{file}: has no curve {request.number}; it has {len(curves)}, counted from 0")
    curve, terminal = curves[request.number], console()
    options: Any = {"parameters": request.parameters(scene), "confidence": request.confidence}
    shares = []
    if _relaxes(scene):
        if uncertain or request.until:
            raise InvalidInput("--uncertain and --until are for scenes that do not relax; leave them out")
        found = fit_history(scene, curve.time, curve.depth, curve.force, **options)
    elif uncertain:
        inputs = read_inputs(uncertain, scene, with_units=uses_units(scene_file))
        carried = fit_uncertain(scene, curve.depth, curve.force, inputs, **options)
        found, shares = carried.fit, [shares_table(carried)]
    else:
        found = fit_curve(scene, curve.depth, curve.force, limit=request.limit(), **options)
    # Warnings come first: nobody reads them below the numbers.
    show_facts([("warning", line) for line in found.warnings], on=terminal)
    for table in (fit_table(found), *shares, formula_table(found)):
        show_table(table, on=terminal)
    facts = [("R^2 in contact", f"{found.r_squared:.6f}")]
    facts += [("numerical error", f"{small(found.numerical_error)} of E, in its interval")]
    notes = (*found.notes, *curve.notes, *scene_notes(scene_file))
    show_facts(facts + [("note", line) for line in notes], on=terminal)
    _write_outputs(request.outputs, lambda: fit_csv(found), "fit_figure", found)


def fit_map_file(file: Path, scene_file: Path, request: FitRequest, *, progress: Callable[[int, int], None]) -> None:
    """Fit every curve of a map, print a summary, and write a row for each curve.

    Raises:
        InvalidInput: For a wrong scene, map, parameter or file.
    """
    check_outputs(request.outputs, {".csv": "CSV", **PICTURES})
    scene = load_scene(scene_file)
    if _relaxes(scene):
        raise InvalidInput("--map: maps are fitted for scenes that do not relax; fit single curves (--curve NUMBER)")
    curves = request.curves(file, scene, is_map=True)
    found = fit_map(
        scene,
        [one.depth for one in curves],
        [one.force for one in curves],
        parameters=request.parameters(scene),
        confidence=request.confidence,
        limit=request.limit(),
        positions=np.array([one.position for one in curves]),
        progress=progress,
    )
    show_facts(map_facts(found), on=console())
    _write_outputs(request.outputs, lambda: map_csv(found), "map_figure", found)


def _write_outputs(outputs: Sequence[Path], table: Callable[[], str], figure: str, found: object) -> None:
    """Write the table to files that end with .csv, the figure of that name in `reports.fit_figures` to the others."""
    for path in outputs:
        if path.suffix == ".csv":
            write_whole(path, table())
        else:
            # Matplotlib only where it is asked for.
            from reports import fit_figures  # noqa: PLC0415

            write_picture(path, lambda: getattr(fit_figures, figure)(found), key="fit")
        console().print(f"written: {path}")

"""`contact-verify fit`: read, compute, print, and write the files asked for."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from cases.declare.uncertain_inputs import read_inputs
from cases.measurements.uncertain_fit import fit_uncertain
from cases.results.files import write_whole
from contact import Adhesion, InvalidInput, load_scene
from contact.files.scene_file import scene_notes, uses_units
from contact.records.units import read_quantity
from mdr.curves import Limit, fit_curve, fit_map
from mdr.curves.reading import Cantilever, Measured, load_curves, read_map
from reports.files import PICTURES, check_outputs, write_picture
from reports.fit_tables import fit_csv, fit_table, formula_table, map_csv, map_facts, shares_table
from reports.terminal import console, show_facts, show_table
from reports.words import small


@dataclass(frozen=True, kw_only=True)
class FitRequest:
    """What the command line says about a fit.

    Attributes:
        fit: Names of the fitted moduli.
        also: Names of what is fitted beside them.
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

    @property
    def parameters(self) -> tuple[str, ...]:
        """Names of all that is fitted."""
        return tuple(name.strip() for name in (*self.fit.split(","), *self.also.split(",")) if name.strip())

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

    def curves(self, file: Path, scene: Any) -> list[Measured]:
        """The curves of the file; of scenes with adhesion the withdrawal."""
        given = [
            read_quantity(text, unit, name) if text else None
            for text, unit, name in (
                (self.spring_constant, "N/m", "--spring-constant"),
                (self.sensitivity.partition("/")[0], "m", "--sensitivity"),
            )
        ]
        direction: Literal["loading", "withdrawal"] = "loading" if scene.effect(Adhesion) is None else "withdrawal"
        return load_curves(file, units=self.units, cantilever=Cantilever(*given), direction=direction)


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
    options: Any = {"parameters": request.parameters, "confidence": request.confidence}
    if uncertain:
        inputs = read_inputs(uncertain, scene, with_units=uses_units(scene_file))
        carried = fit_uncertain(scene, curve.depth, curve.force, inputs, **options)
        found, shares = carried.fit, [shares_table(carried)]
    else:
        found, shares = fit_curve(scene, curve.depth, curve.force, limit=request.limit(), **options), []
    # Warnings come first: nobody reads them below the numbers.
    show_facts([("warning", line) for line in found.warnings], on=terminal)
    for table in (fit_table(found), *shares, formula_table(found)):
        show_table(table, on=terminal)
    facts = [("numerical error", f"{small(found.numerical_error)} of E, in its interval")]
    show_facts(facts + [("note", line) for line in (*curve.notes, *scene_notes(scene_file))], on=terminal)
    _write_outputs(request.outputs, lambda: fit_csv(found), "fit_figure", found)


def fit_map_file(file: Path, scene_file: Path, request: FitRequest, *, progress: Callable[[int, int], None]) -> None:
    """Fit every curve of a map, print a summary, and write a row for each curve.

    Raises:
        InvalidInput: For a wrong scene, map, parameter or file.
    """
    check_outputs(request.outputs, {".csv": "CSV", **PICTURES})
    scene = load_scene(scene_file)
    direction: Literal["loading", "withdrawal"] = "loading" if scene.effect(Adhesion) is None else "withdrawal"
    curves = read_map(file, units=request.units, direction=direction)
    found = fit_map(
        scene,
        [one.depth for one in curves],
        [one.force for one in curves],
        parameters=request.parameters,
        confidence=request.confidence,
        limit=request.limit(),
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

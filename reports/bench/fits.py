"""`contact-verify fit`: moduli from files of force curves, what formulas would have said, and pictures."""

import csv
import io
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from cases.results.records.figure import Figure, Panel, Series
from contact import InvalidInput, load_scene
from contact.files.scene_file import scene_notes
from contact.files.values import Column, in_si_units, read_columns
from contact.records.validation import FloatArray
from mdr.curves import CurveFit, MapFit, fit_curve, fit_map
from mdr.curves.fit import UNIT_OF_PARAMETER
from reports.bench.outputs import check_outputs, write_outputs
from reports.tables.table import Table
from reports.terminal.terminal import console, show_facts, show_table
from reports.words.numbers import measured, prefix_for, scaled_unit, small, with_prefix

# How the heads of columns begin, in lower case.
DEPTH_NAMES: Final = ("depth", "indentation", "delta", "tip")
FORCE_NAMES: Final = ("force", "load", "f")


def fit_file(file: Path, scene_file: Path, also: Sequence[str], *, confidence: float, outputs: Sequence[Path]) -> None:
    """Fit one curve, print what was found, and write the files.

    Raises:
        InvalidInput: For a wrong scene, curve, parameter or file.
    """
    check_outputs(outputs)
    scene, columns = load_scene(scene_file), read_columns(file)
    depth = in_si_units(_named(columns, DEPTH_NAMES, 0, file), "m", str(file))
    force = in_si_units(_named(columns, FORCE_NAMES, 1, file), "N", str(file))
    # Names that are no parameters are refused by the fit itself.
    parameters: Any = ("youngs_modulus", *also)
    found = fit_curve(scene, depth, force, parameters=parameters, confidence=confidence)
    terminal = console()
    show_table(fit_table(found), on=terminal)
    show_table(formula_table(found), on=terminal)
    facts = [("numerical error", f"{small(found.numerical_error)} of E, in its interval")]
    facts += [("warning", line) for line in found.warnings] + [("note", line) for line in scene_notes(scene_file)]
    show_facts(facts, on=terminal)
    write_outputs(outputs, lambda: fit_csv(found), lambda: fit_figure(found))


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
    check_outputs(outputs)
    if not set(also) <= {"contact_point", "baseline"}:
        raise InvalidInput(f"--with {', '.join(also)}: curves of a map are fitted with contact_point, and baseline")
    scene, columns = load_scene(scene_file), read_columns(file)
    if len(columns) < 2:
        raise InvalidInput(f"{file}: a map has depths in its first column, and forces of a curve in each other one")
    depth = in_si_units(columns[0], "m", str(file))
    force = np.stack([in_si_units(one, "N", str(file)) for one in columns[1:]])
    found = fit_map(scene, depth, force, baseline="baseline" in also, confidence=confidence, progress=progress)
    show_facts(_map_facts(found), on=console())
    write_outputs(outputs, lambda: map_csv(found), lambda: map_figure(found))


def _named(columns: Sequence[Column], names: Sequence[str], number: int, file: Path) -> Column:
    """The column whose head begins with one of the names, or else the one of this number."""
    for name in names:
        found = [one for one in columns if one.name.lower().startswith(name)]
        if found:
            return found[0]
    if number >= len(columns):
        raise InvalidInput(f"{file}: needs a column of depths and one of forces")
    return columns[number]


def fit_table(found: CurveFit) -> Table:
    """Each fitted parameter with its interval."""
    rows = []
    for name, value in found.values.items():
        factor, unit = scaled_unit(value, UNIT_OF_PARAMETER[name])
        low, high = (f"{end / factor:.5g}" for end in found.interval(name))
        text = measured(value / factor, found.standard_error[name] / factor)
        rows.append((name.replace("_", " "), text, f"{low} to {high}", unit))
    return Table(
        title=f"Fit of {found.depth.size} points",
        note="Digits in brackets: standard error from the scatter of the curve.",
        heads=("parameter", "value", f"{100 * found.confidence:g} % interval", "unit"),
        rows=tuple(rows),
    )


def formula_table(found: CurveFit) -> Table:
    """What formulas in use would have said."""
    rows = tuple(
        (fit.formula.name, with_prefix(fit.youngs_modulus, "Pa"), f"{100 * fit.bias:+.3g} %", fit.formula.source)
        for fit in found.formulas
    )
    return Table(
        title="The same curve by formulas in use" if rows else "",
        note="",
        heads=("formula", "E", "bias", "source") if rows else (),
        rows=rows,
    )


def fit_csv(found: CurveFit) -> str:
    """Depth, force, fit, half width of its band and residual of each point, SI."""
    residual = found.force - found.fitted
    return _csv(
        ("depth [m]", "force [N]", "fitted [N]", "band [N]", "residual [N]"),
        (found.depth, found.force, found.fitted, found.band, residual),
    )


def map_csv(found: MapFit) -> str:
    """One row a curve, SI; a curve without a fit has empty cells."""
    low, high = found.interval
    heads = ("youngs_modulus [Pa]", "low [Pa]", "high [Pa]", "contact_point [m]", "baseline [N]", "scatter [N]")
    columns = (found.youngs_modulus, low, high, found.contact_point, found.baseline, found.scatter)
    return _csv(heads, columns)


def _csv(heads: Sequence[str], columns: Sequence[FloatArray]) -> str:
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(heads)
    rows = zip(*(column.tolist() for column in columns), strict=True)
    writer.writerows([value if np.isfinite(value) else "" for value in row] for row in rows)
    return buffer.getvalue()


def fit_figure(found: CurveFit) -> Figure:
    """Measured curve, fit and band; residuals below in the unit of the scatter."""
    x_factor, x_prefix = prefix_for(found.depth.tolist())
    y_factor, y_prefix = prefix_for(found.force.tolist())
    order = np.argsort(found.depth)
    x = tuple((found.depth[order] / x_factor).tolist())

    def line(label: str, values: FloatArray, method: str, band: FloatArray | None = None) -> Series:
        half = () if band is None else tuple((band[order] / y_factor).tolist())
        y = tuple((values[order] / y_factor).tolist())
        style: Any = "symbols" if method == "measured" else "solid"
        return Series(label=label, method=method, group=label, x=x, y=y, half_width=half, style=style)

    modulus = with_prefix(found.youngs_modulus, "Pa")
    curves = line("measured", found.force, "measured"), line(f"fit, E = {modulus}", found.fitted, "mdr", found.band)
    left = line("residual", found.force - found.fitted, "measured")
    labels = {"x_label": f"depth [{x_prefix}m]", "y_label": f"force [{y_prefix}N]"}
    panels = Panel(title="Force curve", series=curves, **labels), Panel(title="Residual", series=(left,), **labels)
    caption = f"Band: {100 * found.confidence:g} % confidence of the fitted curve."
    return Figure(name="fit", title="Fit", caption=caption, panels=panels)


def map_figure(found: MapFit) -> Figure:
    """Share of curves below each modulus."""
    known = np.sort(found.youngs_modulus[found.converged])
    factor, prefix = prefix_for(known.tolist())
    share = 100 * np.arange(1, known.size + 1) / max(known.size, 1)
    x, y = tuple((known / factor).tolist()), tuple(share.tolist())
    series = Series(label="curves", method="mdr", group="", x=x, y=y, style="solid")
    axes = Panel(title="Moduli", x_label=f"E [{prefix}Pa]", y_label="share of curves [%]", series=(series,))
    return Figure(name="map", title="Moduli of a map", caption="Share of curves below each modulus.", panels=(axes,))


def _map_facts(found: MapFit) -> list[tuple[str, str]]:
    known = found.youngs_modulus[found.converged]
    if not known.size:
        return [("warning", "no curve could be fitted; check units, contact and scene")]
    low, middle, high = np.quantile(known, (0.05, 0.5, 0.95))
    error = float(np.median(found.standard_error[found.converged] / known))
    return [
        ("curves", f"{known.size} of {found.converged.size} fitted"),
        (
            "median E",
            f"{with_prefix(middle, 'Pa')}; nine in ten from {with_prefix(low, 'Pa')} to {with_prefix(high, 'Pa')}",
        ),
        ("standard error of E", f"{100 * error:.2g} % in the median, from the scatter of each curve"),
        ("numerical error", f"{small(found.numerical_error)} of E, in the intervals"),
    ]

"""Fits of force curves as tables and CSV files."""

import numpy as np

from cases.files import csv_text
from cases.uncertain_fit import UncertainFit
from mdr.curves import CurveFit, MapFit
from mdr.curves.families import unit_of_parameter
from reports.words import Table, measured, quantity_words, scaled_unit, small, with_prefix


def fit_table(fit: CurveFit) -> Table:
    """Each fitted parameter with its interval."""
    rows = []
    for name, value in fit.values.items():
        factor, unit = scaled_unit(value, unit_of_parameter(name))
        low, high = (f"{end / factor:.5g}" for end in fit.interval(name))
        text = measured(value / factor, fit.standard_error[name] / factor)
        rows.append((quantity_words(name), text, f"{low} to {high}", unit))
    return Table(
        title=f"Fit of {fit.depth.size} points",
        note="Digits in brackets: standard error from the scatter of the curve.",
        heads=("parameter", "value", f"{100 * fit.confidence:g} % interval", "unit"),
        rows=tuple(rows),
    )


def shares_table(uncertain: UncertainFit) -> Table:
    """Changes of each parameter by one standard deviation of each uncertain input."""
    fit, rows = uncertain.fit, []
    for name, changes in uncertain.changes.items():
        factor, unit = scaled_unit(fit.values[name], unit_of_parameter(name))
        numbers = [f"{change / factor:+.3g}" for change in changes.values()]
        scatter, inputs = (f"{errors[name] / factor:.3g}" for errors in (fit.standard_error, fit.input_error))
        rows.append((quantity_words(name), scatter, *numbers, inputs, unit))
    heads = [f"{entry.name} ({entry.in_words()})" for entry in uncertain.inputs.inputs]
    return Table(
        title="Standard uncertainties (one standard deviation)",
        note="Interval: +- sqrt(scatter^2 + inputs^2), times Student's quantile.",
        heads=("parameter", "scatter", *heads, "all inputs", "unit"),
        rows=tuple(rows),
    )


def formula_table(fit: CurveFit) -> Table:
    """Moduli of the same curve by formulas in use."""
    rows = tuple(
        (used.formula.name, with_prefix(used.youngs_modulus, "Pa"), f"{100 * used.bias:+.3g} %", used.formula.source)
        for used in fit.formulas
    )
    return Table(
        title="The same curve by formulas in use" if rows else "",
        note="",
        heads=("formula", "E", "bias", "source") if rows else (),
        rows=rows,
    )


def fit_csv(fit: CurveFit) -> str:
    """One row per point, SI: measured and fitted values, and the fitted parameters, which are equal in all rows."""
    unit = "N" if fit.response == "force" else "m"
    columns = {"time [s]": fit.time} if fit.time.size else {}
    columns |= {"depth [m]": fit.depth, "force [N]": fit.force, f"fitted [{unit}]": fit.fitted}
    columns |= {f"band [{unit}]": fit.band, f"residual [{unit}]": fit.measured - fit.fitted}
    columns |= {"modulus_at_depth [Pa]": fit.modulus_at_depth}
    for name, value in fit.values.items():
        numbers = zip(("", "_low", "_high"), (value, *fit.interval(name)), strict=True)
        columns |= {f"{name}{end} [{unit_of_parameter(name)}]": np.full(fit.depth.shape, v) for end, v in numbers}
    columns |= {"r_squared": np.full(fit.depth.shape, fit.r_squared)}
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return csv_text(columns, ([value if np.isfinite(value) else "" for value in row] for row in rows))


def map_csv(fits: MapFit) -> str:
    """One row per curve, SI: every fitted number with its interval, or the reason why there is no fit."""
    names = next((list(fit.values) for fit in fits.curves if fit is not None), ["youngs_modulus"])
    units = [unit_of_parameter(name) for name in names]
    heads = [f"{name}{end} [{u}]" for name, u in zip(names, units, strict=True) for end in ("", "_low", "_high")]
    rows = []
    for number, (fit, reason, place) in enumerate(zip(fits.curves, fits.reasons, fits.positions, strict=True)):
        cells: list[object] = [""] * (len(heads) + 2)
        if fit is not None:
            cells = [cell for name in names for cell in (fit.values[name], *fit.interval(name))]
            cells += [fit.r_squared, float(np.std(fit.measured - fit.fitted))]
        cells += [number, *(value if np.isfinite(value) else "" for value in place.tolist())]
        rows.append([*cells, reason if fit is None else "; ".join(fit.warnings)])
    return csv_text([*heads, "r_squared", "scatter [N]", "curve", "x [m]", "y [m]", "warnings"], rows)


def map_facts(fits: MapFit) -> list[tuple[str, str]]:
    """Summary of a map, by name."""
    moduli = fits.youngs_modulus[fits.converged]
    if not moduli.size:
        return [("warning", f"no curve could be fitted; the first: {fits.reasons[0]}")]
    low, middle, high = np.quantile(moduli, (0.05, 0.5, 0.95))
    error = float(np.median(fits.standard_error[fits.converged] / moduli))
    numerical_error = max(fit.numerical_error for fit in fits.curves if fit is not None)
    warned = [fit for fit in fits.curves if fit is not None and fit.warnings]
    first = next((reason for reason in fits.reasons if reason), "")
    facts = [("warning", f"{len(warned)} curves, the first: {warned[0].warnings[0]}")] if warned else []
    facts += [("not fitted", f"the first: {first}")] if first else []
    return [
        *facts,
        ("curves", f"{moduli.size} of {fits.converged.size} fitted"),
        (
            "median E",
            f"{with_prefix(middle, 'Pa')}; nine in ten from {with_prefix(low, 'Pa')} to {with_prefix(high, 'Pa')}",
        ),
        ("standard error of E", f"{100 * error:.2g} % in the median, from the scatter of each curve"),
        ("numerical error", f"{small(numerical_error)} of E, included in the intervals"),
    ]

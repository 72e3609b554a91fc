"""Fits of force curves as tables and CSV files."""

import numpy as np

from cases.files import csv_text
from cases.uncertain_fit import UncertainFit
from mdr.curves import CurveFit, MapFit
from mdr.curves.families import unit_of_parameter
from reports.words import Table, measured, quantity_words, scaled_unit, small, with_prefix


def fit_table(found: CurveFit) -> Table:
    """Each fitted parameter with its interval."""
    rows = []
    for name, value in found.values.items():
        factor, unit = scaled_unit(value, unit_of_parameter(name))
        low, high = (f"{end / factor:.5g}" for end in found.interval(name))
        text = measured(value / factor, found.standard_error[name] / factor)
        rows.append((quantity_words(name), text, f"{low} to {high}", unit))
    return Table(
        title=f"Fit of {found.depth.size} points",
        note="Digits in brackets: standard error from the scatter of the curve.",
        heads=("parameter", "value", f"{100 * found.confidence:g} % interval", "unit"),
        rows=tuple(rows),
    )


def shares_table(found: UncertainFit) -> Table:
    """What each uncertain input does to each parameter, by one standard deviation."""
    rows = []
    for name, changes in found.changes.items():
        factor, unit = scaled_unit(found.fit.values[name], unit_of_parameter(name))
        scatter, inputs = found.fit.standard_error[name], found.fit.input_error[name]
        numbers = [f"{number / factor:+.3g}" for number in changes.values()]
        rows.append((quantity_words(name), f"{scatter / factor:.3g}", *numbers, f"{inputs / factor:.3g}", unit))
    heads = [f"{one.name} ({one.in_words()})" for one in found.inputs.inputs]
    return Table(
        title="Standard uncertainties (one standard deviation)",
        note="Interval: +- sqrt(scatter^2 + inputs^2), times Student's quantile.",
        heads=("parameter", "scatter", *heads, "all inputs", "unit"),
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
    """One row per point, SI: what was measured and fitted, and in the same columns of all rows the fitted numbers."""
    unit = "N" if found.response == "force" else "m"
    columns = {"time [s]": found.time} if found.time.size else {}
    columns |= {"depth [m]": found.depth, "force [N]": found.force, f"fitted [{unit}]": found.fitted}
    columns |= {f"band [{unit}]": found.band, f"residual [{unit}]": found.measured - found.fitted}
    columns |= {"modulus_at_depth [Pa]": found.modulus_at_depth}
    for name, value in found.values.items():
        numbers = zip(("", "_low", "_high"), (value, *found.interval(name)), strict=True)
        columns |= {f"{name}{end} [{unit_of_parameter(name)}]": np.full(found.depth.shape, v) for end, v in numbers}
    columns |= {"r_squared": np.full(found.depth.shape, found.r_squared)}
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return csv_text(columns, ([value if np.isfinite(value) else "" for value in row] for row in rows))


def map_csv(found: MapFit) -> str:
    """One row per curve, SI: every fitted number with its interval, or the reason why there is no fit."""
    names = next((list(fit.values) for fit in found.curves if fit is not None), ["youngs_modulus"])
    units = [unit_of_parameter(name) for name in names]
    heads = [f"{name}{end} [{u}]" for name, u in zip(names, units, strict=True) for end in ("", "_low", "_high")]
    rows = []
    for number, (fit, reason, place) in enumerate(zip(found.curves, found.reasons, found.positions, strict=True)):
        cells: list[object] = [""] * (len(heads) + 2)
        if fit is not None:
            cells = [cell for name in names for cell in (fit.values[name], *fit.interval(name))]
            cells += [fit.r_squared, float(np.std(fit.measured - fit.fitted))]
        cells += [number, *(value if np.isfinite(value) else "" for value in place.tolist())]
        rows.append([*cells, reason if fit is None else "; ".join(fit.warnings)])
    return csv_text([*heads, "r_squared", "scatter [N]", "curve", "x [m]", "y [m]", "warnings"], rows)


def map_facts(found: MapFit) -> list[tuple[str, str]]:
    """What sums a map up."""
    known = found.youngs_modulus[found.converged]
    if not known.size:
        return [("warning", f"no curve could be fitted; the first: {found.reasons[0]}")]
    low, middle, high = np.quantile(known, (0.05, 0.5, 0.95))
    error = float(np.median(found.standard_error[found.converged] / known))
    error_of_computation = max(fit.numerical_error for fit in found.curves if fit is not None)
    warned = [fit for fit in found.curves if fit is not None and fit.warnings]
    first = next((reason for reason in found.reasons if reason), "")
    facts = [("warning", f"{len(warned)} curves, the first: {warned[0].warnings[0]}")] if warned else []
    facts += [("not fitted", f"the first: {first}")] if first else []
    return [
        *facts,
        ("curves", f"{known.size} of {found.converged.size} fitted"),
        (
            "median E",
            f"{with_prefix(middle, 'Pa')}; nine in ten from {with_prefix(low, 'Pa')} to {with_prefix(high, 'Pa')}",
        ),
        ("standard error of E", f"{100 * error:.2g} % in the median, from the scatter of each curve"),
        ("numerical error", f"{small(error_of_computation)} of E, included in the intervals"),
    ]

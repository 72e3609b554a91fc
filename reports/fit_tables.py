"""Fits of force curves as tables and CSV files."""

from collections.abc import Sequence

import numpy as np

from cases.measurements.uncertain_fit import UncertainFit
from cases.results.csv_table import csv_text
from contact.records.validation import FloatArray
from mdr.curves import CurveFit, MapFit
from mdr.curves.models import unit_of_parameter
from reports.words import Table, measured, scaled_unit, small, with_prefix


def fit_table(found: CurveFit) -> Table:
    """Each fitted parameter with its interval."""
    rows = []
    for name, value in found.values.items():
        factor, unit = scaled_unit(value, unit_of_parameter(name))
        low, high = (f"{end / factor:.5g}" for end in found.interval(name))
        text = measured(value / factor, found.standard_error[name] / factor)
        rows.append((name.replace("_", " "), text, f"{low} to {high}", unit))
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
        rows.append((name.replace("_", " "), f"{scatter / factor:.3g}", *numbers, f"{inputs / factor:.3g}", unit))
    heads = [f"{one.name} ({one.in_words()})" for one in found.inputs.inputs]
    return Table(
        title="Standard uncertainty, one deviation each",
        note="The interval holds scatter and inputs as the root of their squares, times Student's quantile.",
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
    """Depth, force, fit, half width of its band and residual of each point, SI."""
    residual = found.force - found.fitted
    return _csv(
        ("depth [m]", "force [N]", "fitted [N]", "band [N]", "residual [N]"),
        (found.depth, found.force, found.fitted, found.band, residual),
    )


def map_csv(found: MapFit) -> str:
    """One row a curve, SI; a curve without a fit has empty cells and the reason."""
    low, high = found.interval
    heads = ("youngs_modulus [Pa]", "low [Pa]", "high [Pa]", "contact_point [m]", "baseline [N]", "scatter [N]")
    columns = (found.youngs_modulus, low, high, found.contact_point, found.baseline, found.scatter)
    warnings = (
        "; ".join(fit.warnings) if fit else reason for fit, reason in zip(found.curves, found.reasons, strict=True)
    )
    rows = zip(*(column.tolist() for column in columns), strict=True)
    numbers = ([value if np.isfinite(value) else "" for value in row] for row in rows)
    return csv_text((*heads, "warnings"), ([*row, words] for row, words in zip(numbers, warnings, strict=True)))


def _csv(heads: Sequence[str], columns: Sequence[FloatArray]) -> str:
    rows = zip(*(column.tolist() for column in columns), strict=True)
    return csv_text(heads, ([value if np.isfinite(value) else "" for value in row] for row in rows))


def map_facts(found: MapFit) -> list[tuple[str, str]]:
    """What sums a map up."""
    known = found.youngs_modulus[found.converged]
    if not known.size:
        return [("warning", f"no curve could be fitted; the first: {found.reasons[0]}")]
    low, middle, high = np.quantile(known, (0.05, 0.5, 0.95))
    error = float(np.median(found.standard_error[found.converged] / known))
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
        ("numerical error", f"{small(found.numerical_error)} of E, in the intervals"),
    ]

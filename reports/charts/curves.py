"""Pictures of fits of force curves."""

from typing import Any

import numpy as np

from cases.results.records.figure import Figure, Panel, Series
from contact.records.units import prefix_for
from contact.records.validation import BoolArray, FloatArray, IntArray
from mdr.curves import CurveFit, MapFit
from reports.words import with_prefix

# Moduli at depths below this share of the largest are not drawn: forces there are lost in the scatter.
_LEAST_SHARE = 0.05

# Points of a series of symbols, of which the renderer draws all; it thins out longer ones.
_SYMBOLS = 24


def fit_figure(found: CurveFit) -> Figure:
    """Measured and fitted curve, moduli at each depth, residuals."""
    panels = (_curve_panel(found), *([_modulus_panel(found)] if found.per_modulus.size else []), _residual_panel(found))
    point = ""
    if "contact_point" in found.values:
        factor, prefix = prefix_for([found.values["contact_point"], *found.interval("contact_point")])
        ends = "{:.4g} to {:.4g}".format(*(end / factor for end in found.interval("contact_point")))
        point = f" Contact point {ends} {prefix}m."
    caption = f"Band: {100 * found.confidence:g} % confidence of the fitted curve. R^2 = {found.r_squared:.5f}.{point}"
    return Figure(name="fit", title="Fit", caption=caption, panels=panels)


def _curve_panel(found: CurveFit) -> Panel:
    modulus = with_prefix(found.youngs_modulus, "Pa")
    factor, prefix = prefix_for(found.measured.tolist())
    band = tuple((found.band[_order(found)] / factor).tolist())
    name = "E" if found.per_modulus.size else "G"
    series = [
        _line(found, "measured", found.measured / factor, "symbols"),
        _line(found, f"fit, {name} = {modulus}", found.fitted / factor, "solid", band),
    ]
    shifted, line = found.depth - found.values.get("contact_point", 0.0), found.background
    series += [
        _line(found, f"{one.formula.name}, E = {modulus}", (found.youngs_modulus * phi + line) / factor, "dashed")
        for one in found.formulas
        for phi in [one.formula.per_modulus(shifted)]
    ]
    label = f"force [{prefix}N]" if found.response == "force" else f"depth [{prefix}m]"
    return Panel(title="Force curve", x_label=_x_label(found), y_label=label, series=tuple(series))


def _modulus_panel(found: CurveFit) -> Panel:
    """The modulus of each point alone, and those that formulas take from the fitted force; the true one is level."""
    factor, prefix = prefix_for([found.youngs_modulus])
    shifted = found.depth - found.values.get("contact_point", 0.0)
    pressed = (shifted > _LEAST_SHARE * shifted.max()) & (found.per_modulus > 0.0)
    level = np.full(found.depth.shape, found.youngs_modulus / factor)
    label = f"E = {with_prefix(found.youngs_modulus, 'Pa')}"
    positive = pressed & (found.modulus_at_depth > 0.0)
    series = [
        _line(found, "measured", np.where(positive, found.modulus_at_depth, 1.0) / factor, "symbols", kept=positive),
        _line(found, f"fit, {label}", level, "solid", kept=pressed),
    ]
    for one in found.formulas:
        phi = np.where(pressed, one.formula.per_modulus(shifted), 1.0)
        apparent = (found.fitted - found.background) / (factor * phi)
        series.append(_line(found, f"{one.formula.name}, {label}", apparent, "dashed", kept=pressed))
    labels: Any = {"x_label": _x_label(found), "y_label": f"E [{prefix}Pa]"}
    return Panel(title="Modulus at each depth", y_scale="log", series=tuple(series), **labels)


def _residual_panel(found: CurveFit) -> Panel:
    residual = found.measured - found.fitted
    factor, prefix = prefix_for(residual.tolist())
    series = (_line(found, "measured", residual / factor, "symbols"),)
    unit = "N" if found.response == "force" else "m"
    labels: Any = {"x_label": _x_label(found), "y_label": f"measured - fit [{prefix}{unit}]"}
    return Panel(title="Residual", series=series, **labels)


def _line(
    found: CurveFit,
    label: str,
    values: FloatArray,
    style: Any,
    band: tuple[float, ...] = (),
    *,
    kept: BoolArray | None = None,
) -> Series:
    """Values in the order of depth or time; only some of them where `kept` says so."""
    places = found.time if found.time.size else found.depth
    factor = 1.0 if found.time.size else prefix_for(found.depth.tolist())[0]
    order = _order(found)
    order = order if kept is None else order[kept[order]]
    x, y = tuple((places[order] / factor).tolist()), tuple(values[order].tolist())
    method = {"symbols": "measured", "dashed": "formula"}.get(style, "mdr")
    return Series(label=label, method=method, group=label, x=x, y=y, half_width=band, style=style)


def _order(found: CurveFit) -> IntArray:
    return np.argsort(found.time if found.time.size else found.depth)


def _x_label(found: CurveFit) -> str:
    return "time [s]" if found.time.size else f"depth [{prefix_for(found.depth.tolist())[1]}m]"


def map_figure(found: MapFit) -> Figure:
    """Histogram of the moduli, and the moduli in x and y where the places are known."""
    known = found.youngs_modulus[found.converged]
    factor, prefix = prefix_for(known.tolist())
    panels = [_histogram(known / factor, f"E [{prefix}Pa]")] if known.size else []
    if known.size and np.isfinite(found.positions[found.converged]).all():
        panels.append(_places(found, factor, f"{prefix}Pa"))
    failed = found.converged.size - known.size
    caption = f"{known.size} curves; {failed} more have no fit. Colours: fifths of the curves by modulus."
    return Figure(name="map", title="Moduli of a map", caption=caption, panels=tuple(panels))


def _histogram(moduli: FloatArray, label: str) -> Panel:
    counts, ends = np.histogram(moduli, bins=min(40, 4 + round(np.sqrt(moduli.size))))
    x, y = np.repeat(ends, 2), np.concatenate([[0], np.repeat(counts, 2), [0]])
    series = Series(label="curves", method="mdr", group="", x=tuple(x.tolist()), y=tuple(y.tolist()), style="solid")
    return Panel(title="Histogram", x_label=label, y_label="number of curves", series=(series,))


def _places(found: MapFit, factor: float, unit: str) -> Panel:
    """Places of the curves, in five groups by their modulus."""
    places, moduli = found.positions[found.converged], found.youngs_modulus[found.converged] / factor
    scale, prefix = prefix_for(np.ravel(places).tolist())
    series = []
    for rows in np.array_split(np.argsort(moduli), min(5, moduli.size)):
        label = f"{moduli[rows].min():.3g} to {moduli[rows].max():.3g} {unit}"
        for some in np.array_split(rows, -(-rows.size // _SYMBOLS)):
            x, y = (tuple((places[some, axis] / scale).tolist()) for axis in (0, 1))
            series.append(Series(label=label, method="measured", group=label, x=x, y=y, style="symbols"))
    labels: Any = {"x_label": f"x [{prefix}m]", "y_label": f"y [{prefix}m]"}
    return Panel(title="Map", series=tuple(series), **labels)

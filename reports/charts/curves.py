"""Pictures of fits of force curves."""

from typing import Any

import numpy as np

from cases.results.records.figure import Figure, Panel, Series
from contact.records.units import prefix_for
from contact.records.validation import BoolArray, FloatArray
from mdr.curves import CurveFit, MapFit
from reports.words import with_prefix

# Moduli at depths below this share of the largest are not drawn: forces there are lost in the scatter.
_LEAST_SHARE = 0.05


def fit_figure(found: CurveFit) -> Figure:
    """Measured curve with fit and formulas of the same modulus, moduli by formulas at each depth, residuals."""
    panels = (_curve_panel(found), *([_apparent_panel(found)] if found.formulas else []), _residual_panel(found))
    caption = f"Band: {100 * found.confidence:g} % confidence of the fitted curve."
    return Figure(name="fit", title="Fit", caption=caption, panels=panels)


def _curve_panel(found: CurveFit) -> Panel:
    modulus = with_prefix(found.youngs_modulus, "Pa")
    factor, prefix = prefix_for(found.force.tolist())
    order = np.argsort(found.depth)
    band = tuple((found.band[order] / factor).tolist())
    series = [
        _line(found, "measured", found.force / factor, "symbols"),
        _line(found, f"fit, E = {modulus}", found.fitted / factor, "solid", band),
    ]
    shifted, line = found.depth - found.values.get("contact_point", 0.0), found.background
    series += [
        _line(found, f"{one.formula.name}, E = {modulus}", (found.youngs_modulus * phi + line) / factor, "dashed")
        for one in found.formulas
        for phi in [one.formula.per_modulus(shifted)]
    ]
    return Panel(title="Force curve", x_label=_depth_label(found), y_label=f"force [{prefix}N]", series=tuple(series))


def _apparent_panel(found: CurveFit) -> Panel:
    """The modulus that a formula takes from the fitted force at each depth; the true one is level."""
    factor, prefix = prefix_for([found.youngs_modulus])
    shifted = found.depth - found.values.get("contact_point", 0.0)
    pressed = shifted > _LEAST_SHARE * shifted.max()
    level = np.full(found.depth.shape, found.youngs_modulus / factor)
    series = [_line(found, f"fit, E = {with_prefix(found.youngs_modulus, 'Pa')}", level, "solid", kept=pressed)]
    for one in found.formulas:
        phi = np.where(pressed, one.formula.per_modulus(shifted), 1.0)
        label = f"{one.formula.name}, E = {with_prefix(found.youngs_modulus, 'Pa')}"
        series.append(_line(found, label, (found.fitted - found.background) / (factor * phi), "dashed", kept=pressed))
    labels: Any = {"x_label": _depth_label(found), "y_label": f"E by a formula [{prefix}Pa]"}
    return Panel(title="Modulus by a formula at each depth", y_scale="log", series=tuple(series), **labels)


def _residual_panel(found: CurveFit) -> Panel:
    left = found.force - found.fitted
    factor, prefix = prefix_for(left.tolist())
    series = (_line(found, "measured", left / factor, "symbols"),)
    labels: Any = {"x_label": _depth_label(found), "y_label": f"measured - fit [{prefix}N]"}
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
    """Values in the order of depth; only some of them where `kept` says so."""
    factor, _ = prefix_for(found.depth.tolist())
    order = np.argsort(found.depth)
    order = order if kept is None else order[kept[order]]
    x, y = tuple((found.depth[order] / factor).tolist()), tuple(values[order].tolist())
    method = {"symbols": "measured", "dashed": "formula"}.get(style, "mdr")
    return Series(label=label, method=method, group=label, x=x, y=y, half_width=band, style=style)


def _depth_label(found: CurveFit) -> str:
    return f"depth [{prefix_for(found.depth.tolist())[1]}m]"


def map_figure(found: MapFit) -> Figure:
    """Share of curves below each modulus."""
    known = np.sort(found.youngs_modulus[found.converged])
    factor, prefix = prefix_for(known.tolist())
    share = 100 * np.arange(1, known.size + 1) / max(known.size, 1)
    x, y = tuple((known / factor).tolist()), tuple(share.tolist())
    series = Series(label="curves", method="mdr", group="", x=x, y=y, style="solid")
    axes = Panel(title="Moduli", x_label=f"E [{prefix}Pa]", y_label="share of curves [%]", series=(series,))
    return Figure(name="map", title="Moduli of a map", caption="Share of curves below each modulus.", panels=(axes,))

"""Pictures of fits of force curves."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contact.records.units import prefix_for
from contact.records.validation import FloatArray, IntArray
from mdr.curves import CurveFit, MapFit
from reports.style import BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILLION, line_with_band, mark_decades, panels
from reports.words import with_prefix

# Moduli at depths below this share of the largest are not drawn: forces there are lost in the scatter.
LEAST_SHARE = 0.05
# Colours of formulas, in their order.
COLOURS = (VERMILLION, GREEN, ORANGE, PURPLE)


def fit_figure(found: CurveFit) -> Figure:
    """Measured curve with fit and formulas of the same modulus, moduli by formulas at each depth, residuals."""
    drawing, (curve, *apparent, residual) = panels(3 if found.formulas else 2, size=(4.0, 3.1))
    order = np.argsort(found.depth)
    factor, prefix = prefix_for(found.depth.tolist())
    for axes in (curve, *apparent, residual):
        axes.set_xlabel(f"depth [{prefix}m]")
    _draw_curve(curve, found, order, found.depth[order] / factor)
    for axes in apparent:
        _draw_moduli(axes, found, order, found.depth[order] / factor)
    left = (found.force - found.fitted)[order]
    size, unit = prefix_for(left.tolist())
    residual.plot(found.depth[order] / factor, left / size, "o", color=GREY, markersize=3.0, markerfacecolor="none")
    residual.set(title="Residual", ylabel=f"measured - fit [{unit}N]")
    drawing.legend(*curve.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return drawing


def _draw_curve(axes: Axes, found: CurveFit, order: IntArray, x: FloatArray) -> None:
    modulus = with_prefix(found.youngs_modulus, "Pa")
    factor, prefix = prefix_for(found.force.tolist())
    axes.set(title="Force curve", ylabel=f"force [{prefix}N]")
    axes.plot(x, found.force[order] / factor, "o", color=GREY, markersize=3.0, markerfacecolor="none", label="measured")
    band = found.band[order] / factor
    line_with_band(axes, x, found.fitted[order] / factor, band, color=BLUE, label=f"fit, E = {modulus}")
    for one, colour in zip(found.formulas, COLOURS, strict=False):
        shifted = found.depth - found.values.get("contact_point", 0.0)
        force = found.youngs_modulus * one.formula.per_modulus(shifted) + found.background
        axes.plot(
            x, force[order] / factor, "--", color=colour, linewidth=1.0, label=f"{one.formula.name}, E = {modulus}"
        )


def _draw_moduli(axes: Axes, found: CurveFit, order: IntArray, x: FloatArray) -> None:
    """The modulus that a formula takes from the fitted force at each depth; the true one is level."""
    factor, prefix = prefix_for([found.youngs_modulus])
    shifted = (found.depth - found.values.get("contact_point", 0.0))[order]
    pressed = shifted > LEAST_SHARE * shifted.max()
    axes.set(title="Modulus by a formula at each depth", yscale="log", ylabel=f"E by a formula [{prefix}Pa]")
    axes.axhline(found.youngs_modulus / factor, color=BLUE)
    force = (found.fitted - found.background)[order][pressed]
    for one, colour in zip(found.formulas, COLOURS, strict=False):
        moduli = force / one.formula.per_modulus(shifted[pressed])
        axes.plot(x[pressed], moduli / factor, "--", color=colour, linewidth=1.0)
    mark_decades(axes.yaxis)


def map_figure(found: MapFit) -> Figure:
    """Share of curves below each modulus."""
    known = np.sort(found.youngs_modulus[found.converged])
    factor, prefix = prefix_for(known.tolist())
    drawing, (axes,) = panels(1, size=(5.6, 3.9))
    axes.plot(known / factor, 100 * np.arange(1, known.size + 1) / max(known.size, 1), color=BLUE)
    axes.set(title="Moduli", xlabel=f"E [{prefix}Pa]", ylabel="share of curves [%]")
    return drawing

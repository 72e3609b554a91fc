"""Pictures of fits of force curves and of maps of them."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from contact.records.units import prefix_for
from contact.records.validation import FloatArray
from mdr.curves import CurveFit, MapFit
from reports.style import BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILLION, line_with_band, mark_decades, panels
from reports.words import with_prefix

# Moduli at depths below this share of the largest are not drawn: forces there are lost in the scatter.
LEAST_SHARE = 0.05
# Colours of formulas, in their order.
COLOURS = (VERMILLION, GREEN, ORANGE, PURPLE)


def fit_figure(fit: CurveFit) -> Figure:
    """Measured and fitted curve with formulas of the same modulus, moduli at each depth, residuals."""
    in_time = bool(fit.time.size)
    drawing, (curve, *modulus, residual) = panels(2 if in_time else 3, size=(4.0, 3.1))
    factor, prefix = (1.0, "") if in_time else prefix_for(fit.depth.tolist())
    x = (fit.time if in_time else fit.depth) / factor
    _draw_curve(curve, fit, x)
    for axes in modulus:
        _draw_moduli(axes, fit, x)
    misfit = fit.measured - fit.fitted
    factor, unit_prefix = prefix_for(misfit.tolist())
    _measured(residual, x, misfit / factor)
    residual.set(title="Residual", ylabel=f"measured - fit [{unit_prefix}{'N' if fit.response == 'force' else 'm'}]")
    for axes in (curve, *modulus, residual):
        axes.set_xlabel("time [s]" if in_time else f"depth [{prefix}m]")
    drawing.legend(*curve.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return drawing


def _measured(axes: Axes, x: FloatArray, y: FloatArray) -> None:
    axes.plot(x, y, "o", color=GREY, markersize=3.0, markerfacecolor="none", label="measured")


def _draw_curve(axes: Axes, fit: CurveFit, x: FloatArray) -> None:
    """Measured points, fitted curve with its band, and forces of formulas with the fitted modulus."""
    modulus, order = with_prefix(fit.youngs_modulus, "Pa"), np.argsort(x)
    factor, prefix = prefix_for(fit.measured.tolist())
    axes.set(title="Force curve", ylabel=f"force [{prefix}N]" if fit.response == "force" else f"depth [{prefix}m]")
    _measured(axes, x, fit.measured / factor)
    label, band = f"fit, {'G' if fit.time.size else 'E'} = {modulus}", fit.band[order] / factor
    line_with_band(axes, x[order], fit.fitted[order] / factor, band, color=BLUE, label=label)
    for by_formula, colour in zip(fit.formulas, COLOURS, strict=False):
        force = fit.youngs_modulus * by_formula.formula.per_modulus(fit.indentation) + fit.background
        label = f"{by_formula.formula.name} with this E"
        axes.plot(x[order], force[order] / factor, "--", color=colour, linewidth=1.0, label=label)


def _draw_moduli(axes: Axes, fit: CurveFit, x: FloatArray) -> None:
    """Draw moduli by each measured point and by formulas from the fitted force, and the fitted modulus as a line."""
    factor, prefix = prefix_for([fit.youngs_modulus])
    pressed = (fit.indentation > LEAST_SHARE * fit.indentation.max()) & np.isfinite(fit.modulus_at_depth)
    positive = pressed & (fit.modulus_at_depth > 0.0)
    axes.set(title="Modulus at each depth", yscale="log", ylabel=f"E [{prefix}Pa]")
    _measured(axes, x[positive], fit.modulus_at_depth[positive] / factor)
    axes.axhline(fit.youngs_modulus / factor, color=BLUE)
    order = np.flatnonzero(pressed)[np.argsort(x[pressed])]
    for by_formula, colour in zip(fit.formulas, COLOURS, strict=False):
        moduli = (fit.fitted - fit.background)[order] / by_formula.formula.per_modulus(fit.indentation[order])
        axes.plot(x[order], moduli / factor, "--", color=colour, linewidth=1.0)
    mark_decades(axes.yaxis)


def map_figure(fit: MapFit) -> Figure:
    """Histogram of the moduli, and the moduli in x and y where the places are known."""
    moduli, places = fit.youngs_modulus[fit.converged], fit.positions[fit.converged]
    factor, prefix = prefix_for(moduli.tolist())
    placed = bool(moduli.size) and bool(np.isfinite(places).all())
    drawing, (histogram, *maps) = panels(2 if placed else 1, size=(4.6, 3.6))
    if moduli.size:
        histogram.hist(moduli / factor, bins=min(40, 4 + round(np.sqrt(moduli.size))), color=BLUE)
    failed = fit.converged.size - moduli.size
    title = f"Histogram of {moduli.size} curves" + f", {failed} more have no fit" * bool(failed)
    histogram.set(title=title, xlabel=f"E [{prefix}Pa]", ylabel="number of curves")
    for axes in maps:
        size, unit = prefix_for(np.ravel(places).tolist())
        x, y = places.T[:2] / size
        shown = axes.scatter(x, y, c=moduli / factor, cmap="cividis", s=18.0)
        drawing.colorbar(shown, label=f"E [{prefix}Pa]")
        axes.set(title="Map", xlabel=f"x [{unit}m]", ylabel=f"y [{unit}m]", aspect="equal")
    return drawing

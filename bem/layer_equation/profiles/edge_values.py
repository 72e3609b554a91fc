"""MDR profile of a layer from the factor of its integral equation: ``g = yg/y1`` with ``yg = C^-1 g_hs``.

Inside each panel of the factor the edge value at x is

    yg(x) = g_hs(x) + S(x) + int_X^x G(x, t) [g_hs(t) + S(t)] dt,    X the panel's start,

S being what the panel inherits from the earlier ones: a polynomial, while g_hs has a kink's square root. So S goes
through the factor's own matrices, and the integral over g_hs is taken piece by piece of the mapped grid.
All lengths in units of the layer thickness; the grid counts from the indenter's flat radius b.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bem.layer_equation.one_factorisation import VolterraFactor
from bem.layer_equation.profiles.cut_pieces import WHOLE, own_integrals
from bem.polynomials.gauss_panels import gauss_nodes, lagrange_matrix
from bem.polynomials.mapped import MappedFunction, MappedGrid
from contact.records.validation import FloatArray


def edge_values(factor: VolterraFactor, load: MappedFunction, flat_radius: float) -> FloatArray:
    """C^-1 of a load that is zero within the flat radius.

    Args:
        factor: Factor of the layer; its panels' ends inside the grid are piece ends.
        load: W on a grid with as many nodes on a piece as the factor has on a panel.
        flat_radius: b, in units of the thickness.

    Returns:
        Values at the nodes of the load's grid, shape (q, m).
    """
    grid = load.grid
    panel, whole = filled_panels(factor, grid, flat_radius)
    position = factor.position(grid.nodes + flat_radius, panel[:, None])
    widths = factor.widths(panel[-1] + 1)
    averages = panel_averages(load, panel, position, widths)
    # By moments, a width that is off by e would cost e over the last Gauss weight.
    averages[panel[whole]] = load.node_values[whole]
    _, inherited = factor.eliminate(averages)
    # These are right as they stand where a piece fills its panel.
    values = factor.edge_values(averages + inherited)[panel]
    polynomial = factor.edge_values(inherited)
    cut = np.flatnonzero(~whole)
    at_edges = lagrange_matrix(factor.count, position[cut])
    smooth = (at_edges @ polynomial[panel[cut]][..., None])[..., 0]
    resolvent = at_edges @ factor.resolvent[panel[cut]]
    own = own_integrals(load, panel, position, factor.widths(panel[-1] + 1), cut=cut, resolvent=resolvent)
    values[cut] = load.node_values[cut] + smooth + own
    return values


def filled_panels(
    factor: VolterraFactor, grid: MappedGrid, flat_radius: float
) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """The panel that each piece of a grid lies in, and whether the piece fills it, shape (q,) each."""
    panel = factor.panel_of(grid.nodes[:, 0] + flat_radius)
    whole = (grid.power == 1) & np.isclose(grid.width, factor.widths(panel[-1] + 1)[panel], rtol=WHOLE, atol=0.0)
    # Values near first touch are tiny and keep their relative accuracy only if integrated by themselves.
    whole[0] = False
    return panel, whole


def gain_within(profile: MappedFunction, excess: FloatArray, step: float | FloatArray) -> FloatArray:
    """Share of g, in [0, 1], that a profile gains on the last step before each excess, up to all of it at the rim."""
    value = profile(np.maximum(excess, 0.0))
    before = profile(np.maximum(excess - step, 0.0))
    gain = np.abs(np.divide(value - before, value, out=np.ones_like(value), where=value != 0.0))
    return np.asarray(np.minimum(gain, 1.0))


def contact_averages(factor: VolterraFactor, load: MappedFunction, flat_radius: float) -> FloatArray:
    """Averages of a load on the panels that cover the contact [0, b + end of the grid], the last ending there."""
    grid = load.grid
    ratio = flat_radius + grid.end
    # A piece of one rounding, between the end of a panel and that of the contact, lies in that panel.
    panel = np.minimum(factor.panel_of(grid.nodes[:, 0] + flat_radius), factor.panels_to(ratio) - 1)
    starts, widths = factor.starts(panel[-1] + 1), factor.widths(panel[-1] + 1).copy()
    widths[-1] = ratio - starts[-1]
    position = (grid.nodes + flat_radius - starts[panel][:, None]) / widths[panel][:, None]
    return panel_averages(load, panel, position, widths)


def panel_averages(
    load: MappedFunction, panel: NDArray[np.intp], position: FloatArray, widths: FloatArray
) -> FloatArray:
    """int l_j W dt / w_j on each panel, shape (panels, m).

    Args:
        load: W.
        panel: Number of the panel that each piece lies in, shape (q,).
        position: The grid's nodes relative to their panels, shape (q, m).
        widths: Of the panels, shape (panels,).
    """
    weighted = load.node_values * load.grid.weights
    moments = (weighted[:, None, :] @ lagrange_matrix(load.grid.count, position))[:, 0]
    averages = np.zeros((len(widths), load.grid.count))
    np.add.at(averages, panel, moments)
    return averages / (widths[:, None] * gauss_nodes(load.grid.count)[1])

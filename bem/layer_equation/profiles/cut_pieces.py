"""Integrals of a panel's resolvent over pieces of a profile that do not fill the panel."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bem.polynomials.gauss_panels import gauss_nodes, lagrange_terms
from bem.polynomials.mapped import MappedFunction
from contact.records.validation import FloatArray

# Relative difference that rounding may make between the width of a piece that fills its panel and the panel's.
WHOLE = 1e-12


def own_integrals(
    load: MappedFunction,
    panel: NDArray[np.intp],
    position: FloatArray,
    widths: FloatArray,
    *,
    cut: NDArray[np.intp],
    resolvent: FloatArray,
) -> FloatArray:
    """int_X^x G(x, t) W(t) dt for the nodes x of some pieces: whole pieces before each, and its own part up to x.

    Args:
        load: W.
        panel: Number of the panel that each piece lies in, shape (q,).
        position: The grid's nodes relative to their panels, shape (q, m).
        widths: Of the panels, shape (panels,).
        cut: Numbers of the pieces, shape (c,).
        resolvent: G(x, t) at t/x = tau_j relative to their panels, shape (c, m, m).
    """
    grid, (u, omega) = load.grid, gauss_nodes(load.grid.count)
    inner, power = np.multiply.outer(u, u), grid.power[cut, None, None]
    stretch = grid.width[cut] / widths[panel[cut]]
    origin = position[cut, 0] - stretch * u[0] ** grid.power[cut]
    weights = grid.width[cut, None, None] * power * inner ** (power - 1) * np.multiply.outer(u, omega)
    moved = resolvent.copy()
    # Where a plain piece begins its panel, its nodes are the resolvent's own.
    inside = (grid.power[cut] > 1) | (np.abs(origin) > WHOLE * stretch)
    if inside.any():
        points = origin[inside, None, None] + stretch[inside, None, None] * inner ** power[inside]
        moved[inside] = _at_points(resolvent[inside], position[cut[inside]], np.maximum(points, 0.0))
    values = np.sum(moved * weights * load.within_nodes(cut), axis=2)
    masses = (load.node_values * grid.weights).reshape(-1, 1)
    for number, piece in enumerate(cut):
        before = slice(int(panel.searchsorted(panel[piece])), int(piece))
        if before.start < before.stop:
            points = np.broadcast_to(position[before].ravel(), (grid.count, position[before].size))
            G = _at_points(resolvent[number], position[piece], points)
            values[number] += (G @ masses[before.start * grid.count : before.stop * grid.count])[:, 0]
    return np.asarray(values)


def _at_points(resolvent: FloatArray, edge: FloatArray, points: FloatArray) -> FloatArray:
    """G(x, t) at points t, shape (.., m, l), from its values at t/x = tau_j, by barycentric sums.

    Args:
        resolvent: Values, shape (.., m, m).
        edge: x, shape (.., m).
        points: t, shape (.., m, l).
    """
    count, edges = resolvent.shape[-1], np.broadcast_to(edge[..., None], points.shape)
    # At a panel's start the edges are rounding errors or zero.
    share = np.minimum(np.divide(points, edges, out=np.zeros(points.shape), where=edges > 0.0), 1.0)
    terms = lagrange_terms(count, share)
    sums: FloatArray = terms @ np.stack([resolvent, np.ones_like(resolvent)], axis=-1)
    return np.asarray(sums[..., 0] / sums[..., 1])

"""The density of a pressure made of flat punches: that of springs which are not in equilibrium with an indenter.

Springs that carry f(x) within a radius a are flat punches of all radii (Eq. 12), whose densities are known:

    phi(t) = f(a) phi_1(t; a) - int_t^a phi_1(t; x) f'(x) dx,    phi_1(t; t) = y_1(t).

What the layer adds to a punch's density is a sum of waves, so that with ``p_1(k; x) = int_0^x phi_1 cos(kt) dt``

    phi'(t) = y_1(t) f'(t) - (2/pi) int (1 - chi) k sin(kt) [f(a) p_1(k; a) - int_t^a p_1(k; x) f'(x) dx] dk.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.layer_equation.flat_punch_solution import IntegralEquationSolution
from bem.layer_equation.half_space import HalfSpaceFlatPunch
from bem.layer_equation.inside.density import Density, Piece
from bem.layer_equation.one_radius import layer_waves
from bem.layer_equation.protocol import FlatPunchSolution
from bem.polynomials.chebyshev import piecewise_sum
from bem.polynomials.gauss_panels import (
    PANEL_NODES,
    chebyshev_from_nodes,
    gauss_nodes,
    lagrange_matrix,
    partial_panel_interpolation,
)
from bem.polynomials.mapped import MappedGrid
from contact import ElasticLayer, InvalidInput
from contact.records.validation import FloatArray


@dataclass(frozen=True)
class SpringForces:
    """f(x) on [0, a] over E*, lengths in one unit.

    Attributes:
        pieces: From the axis to the edge, shape (P,).
        slopes: df/du at the Gauss nodes of ``x = start + length u^power``, shape (P, m).
        edge_value: f(a).
    """

    pieces: tuple[Piece, ...]
    slopes: FloatArray
    edge_value: float

    @property
    def radius(self) -> float:
        """a."""
        return self.pieces[-1].start + self.pieces[-1].length


def density_of_springs(layer: ElasticLayer, flat_punch: FlatPunchSolution, forces: SpringForces) -> Density:
    """phi, lengths in the unit of the forces: the layer's thickness, any on a half-space.

    Raises:
        InvalidInput: If the flat punches' densities are not known.
    """
    if isinstance(flat_punch, HalfSpaceFlatPunch):
        return _density(forces, forces.slopes, forces.edge_value)
    if not isinstance(flat_punch, IntegralEquationSolution):
        raise InvalidInput(
            f"{type(flat_punch).__name__}: fields inside under a history need densities of flat punches; use the "
            "integral equation, and a stack in place of a graded layer"
        )
    start, length, power = (
        np.array([getattr(piece, name) for piece in forces.pieces])[:, None] for name in ("start", "length", "power")
    )
    u, _ = gauss_nodes(forces.slopes.shape[1])
    x, stretch = start + length * u**power, length * power * u ** (power - 1.0)
    added = stretch * _slope_of_layer(layer, flat_punch, forces, x)
    slopes = flat_punch.edge_density(x) * forces.slopes + added
    edge = float(flat_punch.edge_density(forces.radius)) * forces.edge_value
    return _density(forces, slopes, edge)


def _density(forces: SpringForces, slopes: FloatArray, edge: float) -> Density:
    """From dphi/du at the nodes of all pieces."""
    starts = np.array([piece.start for piece in forces.pieces])
    coefficients = slopes @ chebyshev_from_nodes(slopes.shape[1]).T

    def slope(piece: Piece, offset: FloatArray) -> FloatArray:
        """phi'."""
        number = np.full(offset.shape, int(np.argmin(np.abs(starts - piece.start))))
        u = np.minimum(offset / piece.length, 1.0) ** (1.0 / piece.power)
        total = piecewise_sum(coefficients, number, 2.0 * u - 1.0) / (piece.length * piece.power)
        return np.asarray(total / u ** (piece.power - 1.0)) if piece.power > 1.0 else total

    return Density(forces.radius, edge, forces.pieces, slope, 1.0)


def _slope_of_layer(
    layer: ElasticLayer, flat_punch: IntegralEquationSolution, forces: SpringForces, x: FloatArray
) -> FloatArray:
    """What waves add to phi' at the nodes x of all pieces, shape (P, m)."""
    k, weights = layer_waves(layer, 2.0 * forces.radius)
    count = x.shape[1]
    _, omega = gauss_nodes(count)
    before = np.einsum("ijk,j->ik", partial_panel_interpolation(count), omega) * gauss_nodes(count)[0][:, None]
    pressed = _transforms(flat_punch, k, x.ravel()).reshape(*x.shape, k.size)
    weighted = -pressed * forces.slopes[..., None]
    whole = omega @ weighted
    beyond = np.cumsum(whole[::-1], axis=0)[::-1] - whole
    rest = whole[:, None] - before @ weighted + beyond[:, None]
    if forces.edge_value:
        rest += forces.edge_value * _transform(flat_punch, k, forces.radius)
    return np.asarray(-2.0 / math.pi * np.einsum("pmk,pmk->pm", np.sin(np.multiply.outer(x, k)) * (weights * k), rest))


def _transforms(flat_punch: IntegralEquationSolution, k: FloatArray, x: FloatArray) -> FloatArray:
    """p_1(k; x), shape (n, k): between radii on panels of at most a thickness by polynomials."""
    count = PANEL_NODES
    grid = MappedGrid.equal(float(x.max()), math.ceil(float(x.max())), count)
    known = np.array([_transform(flat_punch, k, float(one)) for one in grid.nodes.ravel()])
    piece, u = grid.locate(x)
    return np.asarray(np.einsum("nm,nmk->nk", lagrange_matrix(count, u), known.reshape(-1, count, k.size)[piece]))


def _transform(flat_punch: IntegralEquationSolution, k: FloatArray, radius: float) -> FloatArray:
    density = flat_punch.density(radius)
    mass = ((density.load + density.psi.node_values) * density.psi.grid.weights).ravel()
    return np.asarray(np.cos(np.multiply.outer(k, density.psi.grid.nodes.ravel())) @ mass)

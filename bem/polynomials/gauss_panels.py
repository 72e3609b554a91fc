"""Gauss panels: nodes, weights and polynomial interpolation on [0, 1]."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from bem.polynomials.gauss import legendre_rule
from contact.records.validation import FloatArray

# Usual number of nodes on a panel. A function that is analytic within half a panel's length beside it is left with
# (1 + sqrt 2)^-40 = 5e-16 of itself by a Gauss rule of 20 nodes, and a wave that turns twice on the panel with less.
PANEL_NODES = 20


@cache
def gauss_nodes(count: int) -> tuple[FloatArray, FloatArray]:
    """Gauss-Legendre nodes and weights on [0, 1], each of shape (count,), read-only."""
    nodes, weights = legendre_rule(count)
    return _frozen((1 + nodes) / 2), _frozen(weights / 2)


def lagrange_matrix(count: int, points: FloatArray) -> FloatArray:
    """Matrix that takes values at `gauss_nodes(count)` to values of their interpolating polynomial.

    Args:
        count: Number m of Gauss nodes.
        points: Points of [0, 1], any shape.

    Returns:
        Matrix of shape (*points.shape, m), each row adding up to 1.
    """
    terms = lagrange_terms(count, points)
    terms /= terms.sum(axis=-1, keepdims=True)
    return terms


def lagrange_terms(count: int, points: FloatArray) -> FloatArray:
    """Rows of that matrix before they are divided by their sums."""
    nodes, _ = gauss_nodes(count)
    distance = points[..., None] - nodes
    # At a point that is a node its own term dominates, and may be multiplied by any value.
    distance[distance == 0] = np.sqrt(np.finfo(float).tiny)
    terms: FloatArray = np.divide(_barycentric_weights(count), distance, out=distance)
    return terms


@cache
def _barycentric_weights(count: int) -> FloatArray:
    """(-1)^j sqrt(tau_j (1 - tau_j) w_j), Salzer's weights of the Gauss-Legendre nodes."""
    nodes, weights = gauss_nodes(count)
    return _frozen((-1.0) ** np.arange(count) * np.sqrt(nodes * (1 - nodes) * weights))


@cache
def chebyshev_from_nodes(count: int) -> FloatArray:
    """Matrix that takes values at `gauss_nodes(count)` to Chebyshev coefficients on [0, 1]."""
    nodes, _ = gauss_nodes(count)
    return _frozen(np.linalg.inv(chebyshev.chebvander(2 * nodes - 1, count - 1)))


@cache
def partial_panel_interpolation(count: int) -> FloatArray:
    """Values at the nodes scaled into [0, tau_i], for every node tau_i.

    Returns:
        Tensor E of shape (i, j, k): the polynomial through values v_k has the value sum_k E_ijk v_k at tau_i tau_j.
    """
    nodes, _ = gauss_nodes(count)
    return _frozen(lagrange_matrix(count, np.multiply.outer(nodes, nodes)))


def _frozen(values: Any) -> FloatArray:
    frozen = np.array(values, dtype=np.float64)
    frozen.setflags(write=False)
    return frozen

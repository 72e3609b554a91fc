"""One Cholesky factorisation that answers the layer's integral equation for every contact radius.

With lengths in units of the thickness, and W the half-space transform of the surface displacement, the density phi of
the pressure under a contact of radius a solves

    phi(x) - int_0^a K(x, t) phi(t) dt = W(x),    K = (2/pi) L,  L(x, t) = [N(x - t) + N(x + t)]/2,  0 <= x <= a.

Write A_a for the operator on [0, a]. All smaller radii are leading sections of it, so its triangular factor C
(A = C C^T) is the same for all. What the method of dimensionality reduction asks for is the *edge value*

    y(x) = phi(x; a = x) = (C^-1 W)(x)

as a function of x. The equation is discretised on equal panels with Gauss nodes. At the panels' ends the discrete
factor is spectrally accurate as it stands. Inside a panel [X, X + H] the earlier panels are eliminated exactly (block
elimination). What is left is an equation on [X, x] with the smooth Schur kernel K~, known at the panel's own nodes and
interpolated from there: an edge x inside the panel costs one system with as many unknowns as a panel has nodes.

A load W need not be smooth. It enters by its averages over the panels' Lagrange basis, ``int l_j W dt / w_j``, which
are the values W(t_j) themselves where W is a polynomial.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bem.layer_equation.factors.blocks import BlockLower, block_factor
from bem.layer_equation.factors.dense import DenseLower, dense_factor
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.polynomials.gauss_panels import chebyshev_from_nodes, gauss_nodes, partial_panel_interpolation
from bem.polynomials.truncation import integrated, orders_beyond, rate_of_decay
from contact.records.validation import FloatArray

# The kernel's half of the strip around the real axis where it is analytic: it is a transform of exp(-2k) times powers.
STRIP = 2.0
# Unknowns up to which the factor is one dense matrix; chosen: with 24 nodes on a panel up to a/h = 40, where blocks
# would save little.
DENSE = 1024
# Panels whose resolvents are made at a time: of 24 nodes they take 15 MB; chosen.
TOGETHER = 32


@dataclass(frozen=True)
class VolterraFactor:
    """The factor C of one layer on [0, P H], P panels of m nodes, lengths in units of the thickness.

    Attributes:
        panel_width: H.
        lower: Cholesky factor of I - sqrt(w) K sqrt(w) of P m unknowns.
        schur: K~ at each panel's own nodes, shape (P, m, m).
        resolvent: G of each panel, shape (P, i, j): the edge value at node tau_i is the load there plus the integral of
            G times the load inside the panel; j counts the nodes tau_i tau_j of that integral.
    """

    panel_width: float
    lower: DenseLower | BlockLower
    schur: FloatArray
    resolvent: FloatArray

    @classmethod
    def of_kernel(cls, kernel: FredholmKernel, panels: int, panel_width: float, count: int) -> VolterraFactor:
        """Factorise on [0, panels panel_width] with `count` nodes on each panel.

        Raises:
            NotConvergedError: If the matrix is not positive definite in double precision.
        """
        factor = dense_factor if panels * count <= DENSE else block_factor
        lower, schur = factor(kernel, panels, panel_width, count)
        return cls(panel_width, lower, schur, edge_resolvents(schur, panel_width))

    @property
    def panels(self) -> int:
        """P."""
        return int(self.schur.shape[0])

    @property
    def count(self) -> int:
        """Nodes of a panel, m."""
        return int(self.schur.shape[1])

    @property
    def reach(self) -> float:
        """Where the last panel ends."""
        return self.panels * self.panel_width

    @property
    def all_ends(self) -> FloatArray:
        """Of the panels, from zero on."""
        return self.panel_width * np.arange(self.panels + 1.0)

    def widths(self, panels: int) -> FloatArray:
        """Of the first panels."""
        return np.full(panels, self.panel_width)

    def starts(self, panels: int) -> FloatArray:
        """Where the first panels begin."""
        return self.panel_width * np.arange(panels, dtype=np.float64)

    def panel_of(self, x: FloatArray) -> NDArray[np.intp]:
        """Number of the panel that a point inside one lies in."""
        return np.asarray(np.floor(x / self.panel_width).astype(np.intp))

    def position(self, x: FloatArray, panel: NDArray[np.intp]) -> FloatArray:
        """Of points relative to their panels."""
        return x / self.panel_width - panel

    def panels_to(self, x: float) -> int:
        """How many panels cover [0, x]."""
        return int(np.ceil(x / self.panel_width))

    def root_weights(self, panels: int) -> FloatArray:
        """Square roots of the weights of the first panels, shape (m,) or (panels, m)."""
        return np.sqrt(self.weights)

    @property
    def weights(self) -> FloatArray:
        """Gauss weights of one panel, shape (m,)."""
        return self.panel_width * gauss_nodes(self.count)[1]

    def eliminate(self, load: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Forward elimination of a load, panel after panel.

        Args:
            load: Averages of W on the first q panels, shape (q, m).

        Returns:
            z = C^-1 (sqrt(w) load), shape (q m,), and what each panel inherits from the earlier ones, K A^-1 W at its
            nodes, shape (q, m).
        """
        root = self.root_weights(len(load))
        z = self.lower.solve((root * load).ravel())
        inherited = -self.lower.from_earlier(z, self.count) / root
        return z, inherited

    def edge_values(self, values: FloatArray) -> FloatArray:
        """What each panel's own equation makes of a polynomial load: edge values at its nodes, shape (q, m).

        Args:
            values: Load plus inheritance at the nodes, shape (q, m).
        """
        edge: FloatArray = (self.edge_matrix[: len(values)] @ values[..., None])[..., 0]
        return edge

    @cached_property
    def truncation(self) -> FloatArray:
        """Error of the edge values at each panel's nodes, relative, from the orders that K~ has there; shape (P,).

        K~(x, t) is interpolated in both variables. Each leaves out a_m P_m, which the integral over part of the panel
        reduces to a_m int P_m. The kernel is analytic within two thicknesses of the real axis.
        """
        to_orders = chebyshev_from_nodes(self.count)
        orders = np.abs(to_orders @ self.schur @ to_orders.T).max(axis=1)
        beyond = orders_beyond(orders, rate_of_decay(2 * STRIP / self.panel_width))
        left_out: FloatArray = 2 * self.panel_width * integrated(self.count) * beyond
        return left_out

    @cached_property
    def edge_matrix(self) -> FloatArray:
        """From a load and what is inherited at a panel's nodes to edge values there, shape (P, m, m)."""
        tau, omega = gauss_nodes(self.count)
        weights = self.panel_width * np.multiply.outer(tau, omega)
        E = partial_panel_interpolation(self.count)
        matrix: FloatArray = np.eye(self.count) + np.einsum("pij,ijk->pik", self.resolvent * weights, E)
        return matrix


def edge_resolvents(schur: FloatArray, widths: float | FloatArray) -> FloatArray:
    """Resolvent of every panel for an edge at each of its nodes: (I - K~ w) G = K~(., edge) on [X, X + H tau_i]."""
    widths = np.broadcast_to(widths, len(schur))
    blocks = [slice(start, start + TOGETHER) for start in range(0, len(schur), TOGETHER)]
    return np.concatenate([_edge_resolvents(schur[block], widths[block]) for block in blocks])


def _edge_resolvents(schur: FloatArray, widths: FloatArray) -> FloatArray:
    """Of some panels."""
    count = schur.shape[1]
    tau, omega = gauss_nodes(count)
    E = partial_panel_interpolation(count)
    # K~ between partial nodes and panel nodes.
    half = np.einsum("ijk,pkl->pijl", E, schur, optimize=True)
    kernel = half @ E.swapaxes(1, 2)
    weights = np.multiply.outer(widths, np.multiply.outer(tau, omega)).reshape(-1, count, 1, count)
    to_edge = np.einsum("piji->pij", half)
    resolvent: FloatArray = np.linalg.solve(np.eye(count) - kernel * weights, to_edge[..., None])[..., 0]
    return resolvent

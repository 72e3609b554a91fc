"""One contact of each of many profiles or layers: what its radius makes of a load, by weights that no load changes.

The edge value and the moment of a load W under a contact of radius x are linear in it,

    yW(x) = W(x) + int_0^x R(x, t) W(t) dt,        M(x) = 2 int_0^x phi_1(t; x) W(t) dt    (Betti),

with the resolvent R and the density phi_1 of the unit flat punch. Both are polynomials on each panel of the factor, the
last panel ending at x. A curve over all radii costs a system for each piece of its profile, these two one for each x.
All lengths in units of the layer thickness.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from bem.layer_equation.one_factorisation import VolterraFactor
from bem.polynomials.gauss_panels import chebyshev_from_nodes, gauss_nodes, lagrange_matrix
from contact.records.validation import FloatArray


@dataclass(frozen=True, eq=False)
class RadiusWeights:
    """Weights of one layer for contacts that end in the same panel.

    Attributes:
        factor: Factor of the layer on equal panels.
    """

    factor: VolterraFactor
    _inheritances: dict[int, FloatArray] = field(default_factory=dict)

    def of_edge(self, panel: int, position: FloatArray) -> FloatArray:
        """R(x, t) by Chebyshev coefficients on each panel, the last one ending at x, shape (n, panel + 1, m).

        Args:
            panel: The panel that all radii lie in.
            position: Of the radii in that panel, relative to its width, shape (n,).
        """
        factor, m = self.factor, self.factor.count
        at_edge = lagrange_matrix(m, position)
        own = at_edge @ factor.resolvent[panel]
        earlier = (at_edge @ factor.edge_matrix[panel]) @ self._inheritance(panel)
        return _coefficients(earlier.reshape(len(own), panel, m) / factor.weights, own)

    def of_density(self, panel: int, position: FloatArray) -> FloatArray:
        """phi_1(t; x) likewise: on the last panel from its Schur system, before it by back-substitution."""
        factor, m = self.factor, self.factor.count
        tau, omega = gauss_nodes(m)
        E = lagrange_matrix(m, np.multiply.outer(position, tau))
        weights = factor.panel_width * np.multiply.outer(position, omega)
        schur = E @ factor.schur[panel] @ E.swapaxes(1, 2)
        inheritance = self._inheritance(panel)
        load = 1.0 + E @ inheritance.sum(axis=1)
        own = np.linalg.solve(np.eye(m) - schur * weights[:, None, :], load[..., None])[..., 0]
        moments = (E.swapaxes(1, 2) @ (weights * own)[..., None])[..., 0]
        earlier = (moments @ inheritance).reshape(len(own), panel, m) / factor.weights
        return _coefficients(self._whole_panels(panel) + earlier, own)

    def _inheritance(self, panel: int) -> FloatArray:
        """What a panel's nodes inherit from a load's averages on the earlier panels, shape (m, panel m)."""
        if panel not in self._inheritances:
            m, before = self.factor.count, panel * self.factor.count
            row, root = self.factor.lower.row(before, before + m), np.tile(self.factor.root_weights(1), panel)
            solved = self.factor.lower.solve(row.T, transposed=True).T
            self._inheritances[panel] = -solved * root / self.factor.root_weights(1)[:, None]
        return self._inheritances[panel]

    def _whole_panels(self, panel: int) -> FloatArray:
        """phi_1 of the contact that ends where a panel begins, shape (panel, m)."""
        root, lower = np.tile(self.factor.root_weights(1), panel), self.factor.lower
        phi = lower.solve(lower.solve(root), transposed=True) / root
        return phi.reshape(panel, self.factor.count)


def _coefficients(earlier: FloatArray, own: FloatArray) -> FloatArray:
    """Chebyshev coefficients from values at the nodes of the earlier panels and of the last one."""
    values = np.concatenate([earlier, own[:, None]], axis=1)
    return np.asarray(values @ chebyshev_from_nodes(own.shape[1]).T)

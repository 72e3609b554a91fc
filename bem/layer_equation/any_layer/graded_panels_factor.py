"""The factor of any layer, on panels that shrink towards the axis, and what it says of flat punches.

Under small contacts a stiff film on a soft base answers like no layer of one material: the edge value y(x) changes over
a small share 1/|N(0)| of the film's thickness, while the kernel itself stays smooth. So the kernel is evaluated on
equal panels and interpolated to panels that halve towards the axis.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.layer_equation.error_model import FACTOR
from bem.layer_equation.flat_punch_solution import EPS, IntegralEquationSolution, polynomial_truncation
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.layer_equation.one_factorisation import (
    STRIP,
    VolterraFactor,
    edge_resolvents,
    schur_kernels,
)
from bem.layer_equation.triangular import equation_factor
from bem.polynomials.gauss_panels import (
    chebyshev_from_nodes,
    gauss_nodes,
    lagrange_matrix,
    partial_panel_interpolation,
)
from bem.polynomials.mapped import MappedFunction
from bem.polynomials.truncation import integrated, orders_beyond, rate_of_decay
from contact.records.validation import FloatArray

# The first panel is at most this share of the length 1/K(0, 0) on which edge values begin to change.
FIRST_SHARE: Final = 1.0
# Multiplies the coefficients of K left out on the first equal panel, and gives its error at the nodes of its parts. It
# changes sign between them. On 120 random stacks of 1 to 3 layers with 8 to 12 nodes, 0.3 covers 98 % of the errors and
# states 15 times of them in the median, 0.15 covers 96 % at 10 times (four profiles, seed 21, 2026-11-22).
INTERPOLATED_SHARE: Final = 0.2
# Halvings of the first panel in any case, since edge values change over a part of the thickness on every layer.
LEAST_HALVINGS: Final = 2


@dataclass(frozen=True)
class GradedFactor(VolterraFactor):
    """The factor on unequal panels.

    Attributes:
        ends: Panel ends, shape (P + 1,).
        kernel_error: What polynomials on the first equal panel leave of K at the nodes of its parts.
    """

    ends: FloatArray
    kernel_error: float

    @classmethod
    def of_any(cls, kernel: FredholmKernel, panels: int, panel_width: float, count: int) -> GradedFactor:
        """Factorise on [0, panels panel_width], the first panel halved towards the axis.

        Raises:
            NotConvergedError: If the matrix is not positive definite in double precision.
        """
        steepness = abs(float(kernel(0.0))) * 2 / np.pi * panel_width / FIRST_SHARE
        halvings = max(LEAST_HALVINGS, int(np.ceil(np.log2(max(steepness, 1.0)))))
        first = panel_width * np.append(0.0, 2.0 ** np.arange(-halvings, 1.0))
        ends = np.append(first, panel_width * np.arange(2.0, panels + 1))
        equal = kernel.panel_matrix(panels, panel_width, count)
        missed = _interpolation_error(2 / np.pi * equal[:count, :count], panel_width)
        K = _split_first(equal, first / panel_width, count)
        starts = range(0, len(K), count)
        own = 2 / np.pi * np.array([K[s : s + count, s : s + count] for s in starts])
        root = np.sqrt(np.multiply.outer(np.diff(ends), gauss_nodes(count)[1]).ravel())
        lower = equation_factor(K, root, panels * panel_width)
        schur = schur_kernels(own, lower, root)
        return cls(panel_width, lower, schur, edge_resolvents(schur, np.diff(ends)), ends, missed)

    @property
    def reach(self) -> float:
        """Where the last panel ends."""
        return float(self.ends[-1])

    @property
    def all_ends(self) -> FloatArray:
        """Of the panels, from zero on."""
        return self.ends

    def widths(self, panels: int) -> FloatArray:
        """Of the first panels."""
        return np.diff(self.ends[: panels + 1])

    def starts(self, panels: int) -> FloatArray:
        """Where the first panels begin."""
        return self.ends[:panels].copy()

    def panel_of(self, x: FloatArray) -> NDArray[np.intp]:
        """Number of the panel that a point inside one lies in."""
        return np.clip(np.searchsorted(self.ends, x, side="right") - 1, 0, self.panels - 1)

    def position(self, x: FloatArray, panel: NDArray[np.intp]) -> FloatArray:
        """Of points relative to their panels."""
        return np.asarray((x - self.ends[panel]) / np.diff(self.ends)[panel])

    def panels_to(self, x: float) -> int:
        """How many panels cover [0, x]."""
        return max(int(np.searchsorted(self.ends, x, side="left")), 1)

    def root_weights(self, panels: int) -> FloatArray:
        """Square roots of the weights of the first panels, shape (panels, m)."""
        return np.sqrt(np.multiply.outer(self.widths(panels), gauss_nodes(self.count)[1]))

    @cached_property
    def truncation(self) -> FloatArray:
        """Error of the edge values at each panel's nodes, relative, from the orders that K~ has there.

        On the parts of the first panel K itself is interpolated, and its error adds up over the contact.
        """
        to_orders, widths = chebyshev_from_nodes(self.count), np.diff(self.ends)
        orders = np.abs(to_orders @ self.schur @ to_orders.T).max(axis=1)
        rates = np.array([rate_of_decay(2 * STRIP / width) for width in widths])
        beyond = np.array([orders_beyond(row, rate) for row, rate in zip(orders, rates, strict=True)])
        parts = self.ends[1:] <= self.panel_width
        inherited = np.where(parts, self.kernel_error * self.ends[1:], 0.0)
        return np.asarray(2 * widths * integrated(self.count) * beyond + inherited)

    @cached_property
    def _edge_matrix(self) -> FloatArray:
        tau, omega = gauss_nodes(self.count)
        weights = np.diff(self.ends)[:, None, None] * np.multiply.outer(tau, omega)
        E = partial_panel_interpolation(self.count)
        matrix: FloatArray = np.eye(self.count) + np.einsum("pij,ijk->pik", self.resolvent * weights, E)
        return matrix


def _interpolation_error(K: FloatArray, panel_width: float) -> float:
    """What polynomials through K at the nodes of one panel leave of it between the nodes, in both variables."""
    count = len(K)
    to_orders = chebyshev_from_nodes(count)
    orders = np.abs(to_orders @ K @ to_orders.T).max(axis=0)
    return float(INTERPOLATED_SHARE * orders_beyond(orders, rate_of_decay(2 * STRIP / panel_width)))


def _split_first(K: FloatArray, ends: FloatArray, count: int) -> FloatArray:
    """The kernel at the nodes of parts of the first panel, by its polynomials, and at the other panels' own nodes."""
    nodes = (ends[:-1, None] + np.diff(ends)[:, None] * gauss_nodes(count)[0]).ravel()
    E = lagrange_matrix(count, nodes)
    n = nodes.size
    split = np.empty((n + len(K) - count, n + len(K) - count))
    split[n:, n:] = K[count:, count:]
    split[:n, :n] = E @ K[:count, :count] @ E.T
    split[:n, n:] = E @ K[:count, count:]
    split[n:, :n] = split[:n, n:].T
    return split


@dataclass(frozen=True)
class AnyLayerSolution(IntegralEquationSolution):
    """The flat punch on a layer of any kind, lengths in units of the thickness of its surface material."""

    factor: GradedFactor

    def relative_error(self, ratio: ArrayLike) -> FloatArray:
        """Error of k_bar, relative: what the panels before leave in the integral over c_bar, and rounding."""
        ratio = self._covered(ratio)
        k = self.normalized_contact_stiffness(ratio)
        length = np.maximum(ratio, np.finfo(float).tiny)
        truncated = polynomial_truncation(self._contact_stiffness, ratio) / k + self._before(length) / (length * k)
        return FACTOR.stiffness_safety * truncated + EPS * (FACTOR.rounded + FACTOR.stiffness_growth * k)

    def panel_ends(self, ratio: float) -> FloatArray:
        """Of the factor's panels."""
        inner = self.factor.ends[1:-1]
        return inner[inner < ratio]

    @cached_property
    def panel_error(self) -> float:
        """The largest `spring_error` at ends and middles of all panels."""
        ends = self.factor.ends
        return float(self.spring_error(np.concatenate([ends[1:], (ends[1:] + ends[:-1]) / 2])).max())

    def _before(self, ratio: FloatArray) -> FloatArray:
        """Error of int c_bar up to a ratio: of each panel before it, and of its own up to there."""
        ends = self.factor.ends
        middles = (ends[1:] + ends[:-1]) / 2
        density = self._spring_truncation(middles) * self.normalized_spring_stiffness(middles)
        each = FACTOR.own_panel * density * np.diff(ends)
        panel, _ = self._panels.locate(ratio)
        earlier = np.append(0.0, np.cumsum(each))[panel]
        own = np.minimum(each[panel], density[panel] * ratio)
        return np.asarray(earlier + own)

    @cached_property
    def _contact_stiffness(self) -> MappedFunction:
        """k_bar at every node, as for equal panels."""
        tau, omega = gauss_nodes(self.factor.count)
        widths, starts = np.diff(self.factor.ends)[:, None], self.factor.ends[:-1, None]
        x = starts + widths * tau
        y = self._edge_density(x)
        partial = widths * tau * ((partial_panel_interpolation(tau.size) @ y[:, None, :, None])[..., 0] ** 2 @ omega)
        full = np.concatenate([[0.0], np.cumsum(widths[:, 0] * (y**2 @ omega))[:-1]])
        return MappedFunction(self._panels, (full[:, None] + partial) / x, 0.0)

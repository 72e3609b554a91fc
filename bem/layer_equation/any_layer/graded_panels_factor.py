"""The factor of any layer, on panels that shrink towards the axis, and what it says of flat punches.

Under small contacts a stiff film on a soft base answers like no layer of one material: the edge value y(x) changes over
a small share 1/|N(0)| of the film's thickness, while the kernel itself stays smooth. So panels halve towards the axis.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Final

import numpy as np
from numpy.typing import NDArray

from bem.layer_equation.error_model import STACK_FACTOR, FactorCoefficients
from bem.layer_equation.factors.dense import factor_of_matrix
from bem.layer_equation.flat_punch_solution import EPS, IntegralEquationSolution, of_density
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.layer_equation.one_factorisation import (
    STRIP,
    VolterraFactor,
    edge_resolvents,
)
from bem.layer_equation.profiles.edge_values import filled_panels, gain_within
from bem.polynomials.gauss_panels import (
    chebyshev_from_nodes,
    gauss_nodes,
    lagrange_matrix,
    partial_panel_interpolation,
)
from bem.polynomials.mapped import MappedFunction
from bem.polynomials.truncation import integrated, orders_beyond, rate_of_decay
from contact.records.validation import FloatArray

# Coefficients of N on the first equal panel below this share are left out: a rounding, and four digits for how much N
# grows towards the ends of the strip.
FULLY: Final = 1e-20
# Halvings of the first panel in any case, since edge values change over a part of the thickness on every layer.
LEAST_HALVINGS: Final = 2

# Of the error of y1 by its polynomials, what is left in g where g is known at their nodes; and the same of the kernel,
# over the resolvent, where a piece ends inside a panel. 98 and 99 of 100 true errors are covered with these (60 random
# stacks, moduli e^-4 to e^4, four profiles, 3 241 radii, 8 to 12 nodes, seed 5), and so are those of a sheet ten
# thousand times as stiff as an incompressible layer, whose resolvent is 3.5 (2026-11-22).
FILLED_OWN: Final = 0.1
CUT_KERNEL: Final = 0.3
# Times the share of a punch's force that an error of g adds to the slopes under a contact: its part of the pressure in
# the norm. That was 0.9 to 2.6 of it for 90 of 100 contacts, 1.5 in the median, because k_N g is 1.2 to 3 times their
# force (600 scenes of `random_scene`, 12 to 16 nodes, seeds 302 and 303, 2026-11-23).
FORCE_SHARE: Final = 3.0


@dataclass(frozen=True)
class GradedFactor(VolterraFactor):
    """The factor on unequal panels.

    Attributes:
        ends: Panel ends, shape (P + 1,).
    """

    ends: FloatArray

    @classmethod
    def of_any(cls, kernel: FredholmKernel, panels: int, panel_width: float, count: int) -> GradedFactor:
        """Factorise on [0, panels panel_width], the first panel halved towards the axis.

        It becomes at most as wide as the length 1/K(0, 0) on which edge values begin to change.

        Raises:
            NotConvergedError: If the matrix is not positive definite in double precision.
        """
        steepness = abs(float(kernel(0.0))) * 2 / np.pi * panel_width
        halvings = max(LEAST_HALVINGS, int(np.ceil(np.log2(max(steepness, 1.0)))))
        first = panel_width * np.append(0.0, 2.0 ** np.arange(-halvings, 1.0))
        ends = np.append(first, panel_width * np.arange(2.0, panels + 1))
        K = _with_parts(kernel, kernel.panel_matrix(panels, panel_width, count), first, count)
        root = np.sqrt(np.multiply.outer(np.diff(ends), gauss_nodes(count)[1]).ravel())
        lower, schur = factor_of_matrix(K, root, count, panels * panel_width)
        return cls(panel_width, lower, schur, edge_resolvents(schur, np.diff(ends)), ends)

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
        return self._all_widths[:panels]

    @cached_property
    def _all_widths(self) -> FloatArray:
        """Shape (P,), read-only."""
        widths = np.diff(self.ends)
        widths.setflags(write=False)
        return widths

    @cached_property
    def _all_roots(self) -> FloatArray:
        """Square roots of all weights, shape (P, m), read-only."""
        roots = np.sqrt(np.multiply.outer(self._all_widths, gauss_nodes(self.count)[1]))
        roots.setflags(write=False)
        return roots

    def starts(self, panels: int) -> FloatArray:
        """Where the first panels begin."""
        return self.ends[:panels].copy()

    def panel_of(self, x: FloatArray) -> NDArray[np.intp]:
        """Number of the panel that a point inside one lies in."""
        return np.clip(np.searchsorted(self.ends, x, side="right") - 1, 0, self.panels - 1)

    def position(self, x: FloatArray, panel: NDArray[np.intp]) -> FloatArray:
        """Of points relative to their panels."""
        return np.asarray((x - self.ends[panel]) / self._all_widths[panel])

    def panels_to(self, x: float) -> int:
        """How many panels cover [0, x]."""
        return max(int(np.searchsorted(self.ends, x, side="left")), 1)

    def root_weights(self, panels: int) -> FloatArray:
        """Square roots of the weights of the first panels, shape (panels, m)."""
        return self._all_roots[:panels]

    @cached_property
    def truncation(self) -> FloatArray:
        """Error of the edge values at each panel's nodes, relative, from the orders that K~ has there."""
        to_orders, widths = chebyshev_from_nodes(self.count), np.diff(self.ends)
        orders = np.abs(to_orders @ self.schur @ to_orders.T).max(axis=1)
        rates = np.array([rate_of_decay(2 * STRIP / width) for width in widths])
        beyond = np.array([orders_beyond(row, rate) for row, rate in zip(orders, rates, strict=True)])
        return np.asarray(2 * widths * integrated(self.count) * beyond)

    @cached_property
    def edge_matrix(self) -> FloatArray:
        """From a load and what is inherited at a panel's nodes to edge values there, shape (P, m, m)."""
        tau, omega = gauss_nodes(self.count)
        weights = np.diff(self.ends)[:, None, None] * np.multiply.outer(tau, omega)
        E = partial_panel_interpolation(self.count)
        matrix: FloatArray = np.eye(self.count) + np.einsum("pij,ijk->pik", self.resolvent * weights, E)
        return matrix


def _with_parts(kernel: FredholmKernel, equal: FloatArray, ends: FloatArray, count: int) -> FloatArray:
    """K on equal panels with the first one cut at `ends`: there by sums of products of exponentials, too.

    Args:
        kernel: N.
        equal: On the equal panels.
        ends: Of the first one's parts, from zero to its width.
        count: Nodes of a panel and of a part.
    """
    tau, width = gauss_nodes(count)[0], float(ends[-1])
    nodes = (ends[:-1, None] + np.diff(ends)[:, None] * tau).ravel()
    further = (width * np.arange(len(equal) // count)[:, None] + width * tau).ravel()[count:]
    n = nodes.size
    K = np.empty((n + further.size, n + further.size))
    K[n:, n:] = equal[count:, count:]
    K[:n, :n] = (kernel.products(nodes, nodes) + _between(kernel, nodes, width)) / 2
    K[:n, n:] = (kernel.products(nodes, further) + kernel.products(width - nodes, further - width)) / 2
    K[n:, :n] = K[:n, n:].T
    return K


def _between(kernel: FredholmKernel, x: FloatArray, width: float) -> FloatArray:
    """N(x_i - x_j) between points of [0, width] by one polynomial, of the degree that its decay to rounding takes."""
    nodes = int(np.ceil(np.log(FULLY) / np.log(rate_of_decay(2 * STRIP / width))))
    values = kernel(width * gauss_nodes(nodes)[0])
    return np.asarray(lagrange_matrix(nodes, np.abs(x[:, None] - x) / width) @ values)


@dataclass(frozen=True)
class AnyLayerSolution(IntegralEquationSolution):
    """The flat punch on a layer of any kind, lengths in units of the thickness of its surface material.

    Attributes:
        largest_compliance: sup chi, by which roundings of 1 - chi grow under a stiff film on a soft base.
    """

    factor: GradedFactor
    largest_compliance: float = 1.0
    shares: ClassVar[FactorCoefficients] = STACK_FACTOR

    @property
    def _roundings(self) -> float:
        return self.shares.rounded * self.largest_compliance

    def ending_at(self, ratio: float) -> None:
        """None: its panels are graded to the edges of films."""

    def panel_ends(self, ratio: float) -> FloatArray:
        """Of the factor's panels."""
        inner = self.factor.ends[1:-1]
        return inner[inner < ratio]

    def error_of_profile(self, ratio: FloatArray, profile: MappedFunction, flat_radius: float) -> FloatArray:
        """Relative error of g = yg/y1, whose kernel errs in the contact's density alone.

        A kernel that is wrong by K' moves g y1 by the integral of phi_1(t) K'(t, s) phi(s), phi the density under the
        depth g: what it does to yg and y1 in proportion cancels. phi vanishes at the edge with the slope -g' y1 and
        K' goes with P_m(s), so that of the error of y1 there is left what phi, over g y1, gains in half a wave of P_m.
        Where a piece of the profile fills no panel, polynomials take yg and y1 between nodes in two ways, and half is
        left, or all where the resolvent of the panel is large; there y1 is interpolated, too, and so is what yg
        inherits, all of it at the panel's start, with the opposite sign.
        """
        panel, whole, gain = self._gained(ratio, profile, flat_radius, 1.0 / (2 * self.nodes))
        start = np.where(panel > 0, 1.0 - self._panels.locate(ratio)[1], 0.0)
        own = np.where(whole, FILLED_OWN, 0.5 * (1.0 + start))
        left = np.clip(CUT_KERNEL * self._resolvent[panel], 0.5, 1.0)
        return self._edge_error(self._covered(ratio), own, np.where(whole, gain, left))

    def _gained(
        self, ratio: FloatArray, profile: MappedFunction, flat_radius: float, share: float
    ) -> tuple[NDArray[np.intp], NDArray[np.bool_], FloatArray]:
        """The panel of each edge, whether its piece fills it, and what g gains on the last share of its width."""
        panel, filled = filled_panels(self.factor, profile.grid, flat_radius)
        excess = np.maximum(ratio - flat_radius, 0.0)
        piece, _ = profile.grid.locate(excess)
        own = panel[piece]
        return own, filled[piece], gain_within(profile, excess, share * self.factor.widths(panel[-1] + 1)[own])

    @cached_property
    def _resolvent(self) -> FloatArray:
        """The largest G of each panel times its width."""
        return np.asarray(np.abs(self.factor.resolvent).max(axis=(1, 2)) * self.factor.widths(self.factor.panels))

    def contact_pressure_error(self, ratio: FloatArray, depth_error: FloatArray) -> FloatArray:
        """An error of g adds that share of a punch, whose slope carries k_bar - y1 of its force k_bar.

        The contact's own force is a half to a third of k_N g. Where a stiff film leaves little of k_bar, psi takes away
        most of the half-space's pressure, and the roundings of its slope count against the rest.
        """
        k = self.normalized_contact_stiffness(ratio)
        moved = FORCE_SHARE * np.abs(1.0 - self.edge_density(ratio) / k) * depth_error
        rounded = 4.0 * EPS * self._roundings / np.minimum(k, 1.0)
        return np.asarray(np.hypot(moved, self._slope_truncation(ratio)) + rounded)

    def punch_pressure_error(self, ratio: FloatArray) -> FloatArray:
        """The edge value errs however small a punch is, and of its pressure, k_bar in all, a stiff film leaves little.

        The density does not fall towards the edge, so that all that is left of slopes counts; where little is left of a
        density of one, roundings have grown by as much already.
        """
        panels, _ = self._panels.locate(ratio)
        least = np.minimum(self.normalized_contact_stiffness(ratio), 1.0)
        edge = 2 * self.factor.truncation[panels] + self.stiffness_rounding(ratio) / least
        return np.asarray(np.hypot(edge, super()._slope_truncation(ratio)) / least)

    def contact_density_error(self, ratio: FloatArray, depth_error: FloatArray) -> FloatArray:
        """Of a unit punch's density psi is k_bar - 1 in the mean, which may vanish, and y1 - 1 at the edge."""
        k = self.normalized_contact_stiffness(ratio)
        psi = np.maximum(np.abs(k - 1.0), np.abs(self.edge_density(ratio) - 1.0))
        return of_density(psi / k, ratio, depth_error)

    def _slope_truncation(self, ratio: FloatArray) -> FloatArray:
        """Where edges are near: counts half the share of the area that their panel and half the one before have."""
        panels, _ = self._panels.locate(ratio)
        start = (self._panels.left[panels] + self._panels.left[np.maximum(panels - 1, 0)]) / 2
        inner = np.divide(start, ratio, out=np.zeros_like(ratio), where=ratio > 0.0)
        return np.asarray(super()._slope_truncation(ratio) * (1.0 - inner**2) / 2)

    def kernel_errors(self, ratio: FloatArray) -> FloatArray:
        """None: `error_of_profile` tells already that most of it cancels in g, and an edge that hangs has all of it."""
        return np.zeros((2, *np.shape(ratio)))

    def error_at_depth(
        self,
        ratio: FloatArray,
        profile: MappedFunction,
        flat_radius: float,
        *,
        stiffness: FloatArray,
        depth: FloatArray,
        spread: FloatArray,
    ) -> FloatArray:
        """A wrong kernel K' moves F by <phi_1, K' phi> and k_N by <phi_1, K' phi_1>, where phi <= g phi_1.

        What interpolation leaves of it goes with P_m on the edge's panel, against which full panels are orthogonal, and
        falls away from that panel: of phi/(g phi_1) counts what g gains on the last panel's width. Roundings count
        everywhere.
        """
        gain = self._gained(ratio, profile, flat_radius, 1.0)[-1]
        rounded = np.minimum(self.stiffness_rounding(ratio), stiffness)
        return np.asarray(spread * (rounded + gain * (stiffness - rounded)))

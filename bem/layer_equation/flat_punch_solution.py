"""What one factorisation of the layer's equation says of flat punches of all radii."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bem.layer_equation.contact_density import ContactDensity
from bem.layer_equation.error_model import FACTOR, FactorCoefficients
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.layer_equation.one_factorisation import VolterraFactor
from bem.layer_equation.profiles.at_radii import RadiusWeights
from bem.layer_equation.profiles.edge_values import contact_averages, edge_values
from bem.layer_equation.protocol import FlatPunchSolution
from bem.polynomials.gauss_panels import gauss_nodes
from bem.polynomials.mapped import MappedFunction, MappedGrid
from bem.polynomials.truncation import integrated, integrated_share
from contact.records.errors import InvalidInput
from contact.records.validation import FloatArray
from contact.scene.profiles import Profile

EPS = float(np.finfo(float).eps)
# By this much, relative, the last panel reaches beyond the radius at which it ends, so that rounding takes no further.
BEYOND = 4.0 * EPS
# Nodes on a panel of data to find radii with: the kernel is known to 8^-8 = 6e-8 on panels of one thickness.
COARSE_NODES = 8


@dataclass(frozen=True)
class IntegralEquationSolution(FlatPunchSolution):
    """The flat punch on one layer, every radius up to `max_ratio`.

    Attributes:
        kernel: Kernel of the layer's equation.
        factor: Its factor.
        shares: Coefficients that shape its stated errors.
    """

    kernel: FredholmKernel
    factor: VolterraFactor
    shares: ClassVar[FactorCoefficients] = FACTOR
    displacement_known: ClassVar[bool] = True

    @property
    def max_ratio(self) -> float:
        """Largest a/h that is covered."""
        return self.factor.reach

    @property
    def unknowns(self) -> int:
        """Size of the system that was factorised."""
        return len(self.factor.lower)

    def normalized_contact_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """k_bar = (1/ratio) int_0^ratio c_bar dx, Eqs. (6) and (10)."""
        return 1 + self._stiffness_share(self._covered(ratio))

    def normalized_spring_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """c_bar = y1^2, y1 the edge value of the density under a unit displacement."""
        return self.edge_density(ratio) ** 2

    def edge_density(self, ratio: ArrayLike) -> FloatArray:
        """y1(x) = phi(x; a = x) of a flat punch pressed in by 1."""
        return 1 + self._edge_share(self._covered(ratio))

    def smooth_pressure(self, rho: ArrayLike, ratio: ArrayLike) -> FloatArray:
        """q = p_bar sqrt(1 - rho^2) from the density, one solution for each different ratio."""
        rho, ratio = np.broadcast_arrays(np.asarray(rho, dtype=float), self._covered(ratio))
        q = np.empty(rho.shape)
        for a in sorted(set(ratio.ravel().tolist())):
            q[ratio == a] = self._smooth_pressure(rho[ratio == a], float(a))
        return q

    def density(self, ratio: float, load: FloatArray | None = None) -> ContactDensity:
        """Density under a contact of radius a = ratio h.

        Args:
            ratio: a/h.
            load: Averages of W as in `ContactDensity`; by default W = 1, the flat punch.
        """
        panels = self.factor.panels_to(ratio)
        unit = np.ones((panels, self.factor.count))
        return ContactDensity.of_load(self.kernel, self.factor, ratio, unit if load is None else load)

    def _smooth_pressure(self, rho: FloatArray, ratio: float) -> FloatArray:
        density = self.density(ratio)
        edge = np.sqrt((1 - rho) * (1 + rho)) * ratio
        inner = 1 + density.edge_value - edge * density.abel_integral(ratio * rho)
        return inner / (2 * self.normalized_contact_stiffness(ratio))  # Eq. (10)

    def relative_error(self, ratio: ArrayLike) -> FloatArray:
        """Error of k_bar, relative: orders left out, and rounding times condition.

        An error of c_bar counts in k_bar = (1/x) int c_bar dx by its panel's share of x, and oscillates within it.
        Close to the axis it grows with x, so that half of it is its mean.
        """
        ratio = self._covered(ratio)
        k = self.normalized_contact_stiffness(ratio)
        panels, _ = self._panels.locate(ratio)
        share = self.factor.widths(self.factor.panels)[panels] / np.maximum(ratio, np.finfo(float).tiny)
        own, of_kernel = self._spring_truncation(ratio)
        springs = np.minimum(0.5, integrated(self.nodes) * share) * own
        springs += np.minimum(0.5, self.shares.own_panel * share) * of_kernel
        truncated = self._left_out(self._stiffness_share, ratio) / k + springs
        return self.shares.stiffness_safety * truncated + self.stiffness_rounding(ratio)

    @property
    def _roundings(self) -> float:
        """Roundings of values that are of order one."""
        return self.shares.rounded

    def stiffness_rounding(self, ratio: FloatArray) -> FloatArray:
        """What of the relative error of k_bar is rounding times condition."""
        k = self.normalized_contact_stiffness(ratio)
        return np.asarray(EPS * (self._roundings + self.shares.stiffness_growth * k))

    def spring_error(self, ratio: ArrayLike) -> FloatArray:
        """Error of c_bar, relative, made likewise."""
        return self._edge_error(self._covered(ratio), 1.0, self.shares.spring_safety)

    def profile_error(self, ratio: ArrayLike, start: ArrayLike = 0.0) -> FloatArray:
        """In g = yg/y1 the kernel errs alike in both edge values, by half of what it does in c_bar = y1^2 each.

        yg is not interpolated between the nodes of a panel, or less of it is than of y1, so that the orders that
        polynomials leave out of y1 count once.
        """
        return self._edge_error(self._covered(ratio), 0.5, self.shares.profile_safety)

    def kernel_errors(self, ratio: FloatArray) -> FloatArray:
        """The kernel errs alike in the edge values of all densities, and on the first panel so do their polynomials.

        There errors of g are -n/(n + 1) times those of y1 under a power n, as a wrong kernel makes them: -0.52 and
        -0.72 under cones and paraboloids (12 nodes, 2026-11-22).
        """
        own, of_kernel = self._spring_truncation(self._covered(ratio))
        first = own * (np.asarray(ratio) <= self._panels.width[0])
        return np.stack([FACTOR.spring_safety * of_kernel + first, FACTOR.profile_safety * of_kernel + 0.5 * first])

    def error_steepness(self, ratio: FloatArray) -> FloatArray:
        """On a panel errors go with P_m, whose slope is bounded by Bernstein and Markov; on the first with x too."""
        panels, s = self._panels.locate(self._covered(ratio))
        m, tiny = self.nodes, np.finfo(float).tiny
        inside = m / np.maximum(2.0 * np.sqrt(s * (1.0 - s)), 2.0 / (m + 1))
        return np.asarray(2.0 / self._panels.width[panels] * inside + (panels == 0) / np.maximum(ratio, tiny))

    def sketch(
        self, load: Callable[[FloatArray], FloatArray], ratio: float
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """At the nodes of panels, as if the load were a polynomial on each."""
        panels = self.factor.panels_to(ratio)
        x = self._panels.nodes[:panels]
        values = load(x)
        _, inherited = self.factor.eliminate(values)
        profile = self.factor.edge_values(values + inherited) / (1 + self._edge_share.node_values[:panels])
        stiffness = 2 * x * (1 + self._stiffness_share.node_values[:panels])
        return x.ravel(), profile.ravel(), stiffness.ravel()

    @property
    def nodes(self) -> int:
        """As many as the factor has on a panel, since loads go through its matrices."""
        return self.factor.count

    def panel_ends(self, ratio: float) -> FloatArray:
        """Of the factor's panels."""
        return self.factor.panel_width * np.arange(1.0, np.ceil(ratio / self.factor.panel_width))

    def profile_of(
        self, indenter: Profile, unit: float, load: MappedFunction, springs: FloatArray
    ) -> tuple[MappedFunction, float]:
        """g = yg/y1 from the edge values of the densities under g_hs and under 1, Eq. (8)."""
        edge = edge_values(self.factor, load, indenter.flat_radius / unit)
        return MappedFunction(load.grid, edge / np.sqrt(springs), load.lead), 0.0

    def contact_density(
        self, load: MappedFunction | None, flat_radius: float, ratio: float, depth: float
    ) -> ContactDensity:
        """Solved for under W = delta - g_hs."""
        if load is None:
            return self.density(ratio, np.full((self.factor.panels_to(ratio), self.factor.count), depth))
        averages = depth - contact_averages(self.factor, load, flat_radius)
        return self.density(ratio, averages)

    @cached_property
    def at_radii(self) -> RadiusWeights:
        """Of its factor."""
        return RadiusWeights(self.factor)

    def coarse(self, ratio: float) -> IntegralEquationSolution:
        """On panels of `COARSE_NODES`."""
        width = self.factor.panel_width
        factor = VolterraFactor.of_kernel(self.kernel, int(np.ceil(ratio / width)), width, COARSE_NODES)
        return IntegralEquationSolution(self.kernel, factor)

    def ending_at(self, ratio: float) -> IntegralEquationSolution | None:
        """Made anew, with as many nodes a panel."""
        panels = self.factor.panels_to(ratio)
        width = ratio / panels * (1.0 + BEYOND)
        return IntegralEquationSolution(self.kernel, VolterraFactor.of_kernel(self.kernel, panels, width, self.nodes))

    def contact_pressure_error(self, ratio: FloatArray, depth_error: FloatArray) -> FloatArray:
        """From the relative errors of the depth and of the density that is solved for, and from what is left of slopes.

        psi, the layer's share of the density, is even and varies over a thickness: for small ratios a/h its slope,
        which alone presses, is (a/h)^2 times psi itself, and psi is about k_bar - 1 of all. Polynomials through the
        nodes are not even, so what they leave of the slope is not as small. Both oscillate along the radius with
        different phases, so that they add up like independent errors.
        """
        return np.hypot(self.contact_density_error(ratio, depth_error), self._slope_truncation(ratio))

    def contact_density_error(self, ratio: FloatArray, depth_error: FloatArray) -> FloatArray:
        """The same without what polynomials lose of the slope."""
        share = np.abs(1 - 1 / self.normalized_contact_stiffness(ratio))
        return of_density(share, ratio, depth_error)

    def punch_pressure_error(self, ratio: FloatArray) -> FloatArray:
        """Solved for without polynomials in the contact radius: those between the kernel's nodes, and roundings."""
        panels, _ = self._panels.locate(ratio)
        rounded = 4 * self._roundings + self.shares.spring_growth * self.normalized_contact_stiffness(ratio)
        return self.contact_pressure_error(ratio, 2 * self.factor.truncation[panels] + EPS * rounded)

    def _slope_truncation(self, ratio: FloatArray) -> FloatArray:
        """What the kernel's polynomials on the panel that the edge lies on leave of the pressure.

        An order A P_m that they leave out makes an error A H int P_m of edge values, which is known. Pressures are half
        a derivative of the density in t^2, so that it becomes sqrt(pi m)/2 A there.
        """
        panels, _ = self._panels.locate(ratio)
        beyond = self.factor.truncation[panels] / (2 * self._panels.width[panels] * integrated(self.nodes))
        return np.asarray(self.shares.slope_share * np.sqrt(np.pi * self.nodes) / 2 * beyond)

    def panel_error(self, ratio: float) -> float:
        """The largest `spring_error` at ends and middles of all panels up to a ratio, and there."""
        ratios, errors = self._errors_of_panels
        return float(np.append(errors[ratios < ratio], self.spring_error(np.array([ratio]))).max())

    @cached_property
    def _errors_of_panels(self) -> tuple[FloatArray, FloatArray]:
        """Ends and middles of all panels, and `spring_error` there."""
        ends = self._panels.ends
        ratios = np.concatenate([ends[1:], (ends[1:] + ends[:-1]) / 2])
        return ratios, self.spring_error(ratios)

    def _edge_error(
        self, ratio: FloatArray, own_share: float | FloatArray, kernel_share: float | FloatArray
    ) -> FloatArray:
        own, of_kernel = self._spring_truncation(ratio)
        rounded = 2 * self._roundings + self.shares.spring_growth * self.normalized_contact_stiffness(ratio)
        return own_share * own + kernel_share * of_kernel + EPS * rounded

    def _spring_truncation(self, ratio: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Of c_bar = y1^2, relative: orders of y1 left out, and of the kernel that gives its values at the nodes."""
        panels, s = self._panels.locate(ratio)
        of_kernel = self.factor.truncation[panels] * np.where(panels == 0, integrated_share(self.nodes, s), 1.0)
        return 2 * self._left_out(self._edge_share, ratio) / self.edge_density(ratio), 2 * of_kernel

    def _left_out(self, function: MappedFunction, ratio: FloatArray) -> FloatArray:
        """By its polynomials, with their safety beyond the first panel."""
        return np.asarray(
            np.where(ratio <= self._panels.width[0], 1.0, self.shares.own_safety) * function.left_out(ratio)
        )

    def _covered(self, ratio: ArrayLike) -> FloatArray:
        ratio = np.asarray(ratio, dtype=float)
        if not np.all((ratio >= 0) & (ratio <= self.max_ratio)):
            worst = ratio[~((ratio >= 0) & (ratio <= self.max_ratio))].flat[0]
            raise InvalidInput(f"a/h = {worst:g}: this flat-punch solution covers [0, {self.max_ratio:g}]")
        return ratio

    @cached_property
    def _panels(self) -> MappedGrid:
        """The factor's panels."""
        return MappedGrid.between(self.factor.all_ends, self.factor.count)

    @cached_property
    def _edge_share(self) -> MappedFunction:
        """y1 - 1, which vanishes at the axis like x: there its polynomials are right, however few nodes there are."""
        unit = np.ones((self.factor.panels, self.factor.count))
        _, inherited = self.factor.eliminate(unit)
        return MappedFunction(self._panels, self.factor.edge_values(unit + inherited) - 1, 1.0)

    @cached_property
    def _stiffness_share(self) -> MappedFunction:
        """k_bar - 1 at every node: full panels before it, and the part of its own panel by scaled Gauss nodes."""
        grid, (tau, omega) = self._panels, gauss_nodes(self.factor.count)
        y = 1 + self._edge_share.node_values
        inside = 1 + self._edge_share.within_nodes()
        partial = grid.width[:, None] * tau * (inside**2 @ omega)
        full = np.concatenate([[0.0], np.cumsum(grid.width * (y**2 @ omega))[:-1]])
        return MappedFunction(grid, (full[:, None] + partial) / grid.nodes - 1, 1.0)  # Eqs. (6), (10)


def of_density(share: FloatArray, ratio: FloatArray, depth_error: FloatArray) -> FloatArray:
    """Error of the pressure from that of the density, of which psi is this share."""
    return np.asarray(share * ratio**2 / (1 + ratio**2) * depth_error)

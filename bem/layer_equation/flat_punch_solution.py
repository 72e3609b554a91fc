"""What one factorisation of the layer's equation says of flat punches of all radii."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from bem.layer_equation.contact_density import ContactDensity
from bem.layer_equation.error_model import FACTOR
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.layer_equation.one_factorisation import VolterraFactor
from bem.polynomials.equal_panels import EqualPanels
from bem.polynomials.gauss_panels import gauss_nodes, partial_panel_interpolation
from contact import InvalidInput
from contact.records.validation import FloatArray
from contact.scene.layer import Support

EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class IntegralEquationSolution:
    """The flat punch on one layer, every radius up to `max_ratio`.

    Attributes:
        support: "bonded" or "unbonded".
        poissons_ratio: nu.
        kernel: Kernel of the layer's equation.
        factor: Its factor.
    """

    support: Support
    poissons_ratio: float
    kernel: FredholmKernel
    factor: VolterraFactor

    @property
    def max_ratio(self) -> float:
        """Largest a/h that is covered."""
        return self.factor.panels * self.factor.panel_width

    @property
    def unknowns(self) -> int:
        """Size of the system that was factorised."""
        return len(self.factor.lower)

    def normalized_contact_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """k_bar = (1/ratio) int_0^ratio c_bar dx, Eqs. (6) and (10)."""
        return self._contact_stiffness(self._covered(ratio))

    def normalized_spring_stiffness(self, ratio: ArrayLike) -> FloatArray:
        """c_bar = y1^2, y1 the edge value of the density under a unit displacement."""
        return self.edge_density(ratio) ** 2

    def edge_density(self, ratio: ArrayLike) -> FloatArray:
        """y1(x) = phi(x; a = x) of a flat punch pressed in by 1."""
        return self._edge_density(self._covered(ratio))

    def smooth_pressure(self, rho: ArrayLike, ratio: ArrayLike) -> FloatArray:
        """q = p_bar sqrt(1 - rho^2) from the density, one solution for each different ratio."""
        rho, ratio = np.broadcast_arrays(np.asarray(rho, dtype=float), self._covered(ratio))
        q = np.empty(rho.shape)
        for a in np.unique(ratio):
            q[ratio == a] = self._smooth_pressure(rho[ratio == a], float(a))
        return q

    def density(self, ratio: float, load: FloatArray | None = None) -> ContactDensity:
        """Density under a contact of radius a = ratio h.

        Args:
            ratio: a/h.
            load: Averages of W as in `ContactDensity`; by default W = 1, the flat punch.
        """
        panels = int(np.ceil(ratio / self.factor.panel_width))
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
        """
        ratio = self._covered(ratio)
        k = self.normalized_contact_stiffness(ratio)
        share = np.minimum(1.0, FACTOR.own_panel * self.factor.panel_width / np.maximum(ratio, np.finfo(float).tiny))
        truncated = self._contact_stiffness.truncation(ratio) / k + share * self._spring_truncation(ratio)
        return FACTOR.stiffness_safety * truncated + EPS * (FACTOR.rounded + FACTOR.stiffness_growth * k)

    def spring_error(self, ratio: ArrayLike) -> FloatArray:
        """Error of c_bar, relative, made likewise."""
        return self._edge_error(self._covered(ratio), FACTOR.spring_safety)

    def profile_error(self, ratio: ArrayLike, start: ArrayLike = 0.0) -> FloatArray:
        """In g = yg/y1 each edge value has half the relative error of c_bar = y1^2, mostly of the same sign."""
        return self._edge_error(self._covered(ratio), FACTOR.profile_safety)

    def _edge_error(self, ratio: FloatArray, safety: float) -> FloatArray:
        rounded = 2 * FACTOR.rounded + FACTOR.spring_growth * self.normalized_contact_stiffness(ratio)
        return safety * self._spring_truncation(ratio) + EPS * rounded

    def _spring_truncation(self, ratio: FloatArray) -> FloatArray:
        """Of c_bar = y1^2, relative: orders of y1 left out, and of the kernel that gives its values at the nodes."""
        panels, _ = self._edge_density.locate(ratio)
        own: FloatArray = self._edge_density.truncation(ratio) / self.edge_density(ratio)
        return 2 * (own + self.factor.truncation[panels])

    def _covered(self, ratio: ArrayLike) -> FloatArray:
        ratio = np.asarray(ratio, dtype=float)
        if not np.all((ratio >= 0) & (ratio <= self.max_ratio)):
            worst = ratio[~((ratio >= 0) & (ratio <= self.max_ratio))].flat[0]
            raise InvalidInput(f"a/h = {worst:g}: this flat-punch solution covers [0, {self.max_ratio:g}]")
        return ratio

    @cached_property
    def _edge_density(self) -> EqualPanels:
        unit = np.ones((self.factor.panels, self.factor.count))
        _, inherited = self.factor.eliminate(unit)
        return EqualPanels.from_nodes(self.factor.panel_width, self.factor.edge_values(unit + inherited))

    @cached_property
    def _contact_stiffness(self) -> EqualPanels:
        """k_bar at every node: full panels before it, and the part of its own panel by scaled Gauss nodes."""
        tau, omega = gauss_nodes(self.factor.count)
        width, panels = self.factor.panel_width, np.arange(self.factor.panels)[:, None]
        y = self._edge_density(width * (panels + tau))
        partial = width * tau * ((partial_panel_interpolation(tau.size) @ y[:, None, :, None])[..., 0] ** 2 @ omega)
        full = np.concatenate([[0.0], np.cumsum(width * y**2 @ omega)[:-1]])
        return EqualPanels.from_nodes(width, (full[:, None] + partial) / (width * (panels + tau)))  # Eqs. (6), (10)

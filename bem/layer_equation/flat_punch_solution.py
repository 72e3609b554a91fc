"""What one factorisation of the layer's equation says of flat punches of all radii."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from bem.kernels.layer import Support, compliance_kernel
from bem.layer_equation.contact_density import ContactDensity
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.layer_equation.one_factorisation import VolterraFactor
from bem.polynomials.equal_panels import EqualPanels
from bem.polynomials.gauss_panels import gauss_nodes, partial_panel_interpolation
from contact import InvalidInput
from contact.records.validation import FloatArray


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
        """Bound of the relative error of k_bar and c_bar: truncated polynomials, and rounding times condition.

        The smallest eigenvalue of the equation on [0, a] belongs to the wavenumber of about 1/a and is chi(h/a);
        rounding errors grow with its inverse.
        """
        ratio = self._covered(ratio)
        panels, _ = self._edge_density.locate(ratio)
        rounding = 1 + np.exp(np.interp(np.log(np.maximum(ratio, 1.0)), *self._condition))
        return 2 * self._truncation[panels] + 4 * np.finfo(float).eps * rounding

    def moment_error(self, ratio: ArrayLike, start: ArrayLike = 0.0) -> FloatArray:
        """As that of the stiffnesses: the same density gives both."""
        return self.relative_error(ratio)

    @cached_property
    def _condition(self) -> tuple[FloatArray, FloatArray]:
        """Logarithms of a/h and of 1/chi(h/a), dense enough for a bound."""
        ratio = np.geomspace(1.0, max(self.max_ratio, 2.0), 100)
        return np.log(ratio), -np.log(compliance_kernel(1 / ratio, self.support, self.poissons_ratio))

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

    @cached_property
    def _truncation(self) -> FloatArray:
        """Errors of the polynomials are handed on to all larger radii."""
        size = np.maximum(self._edge_density.truncation(), self._contact_stiffness.truncation())
        running: FloatArray = np.maximum.accumulate(size)
        return running

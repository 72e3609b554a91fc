"""The layer's share of the density under one contact on a graded layer."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from bem.layer_equation.any_layer.point_kernel import PointKernel
from bem.layer_equation.any_layer.relative_panels import RelativePanels
from bem.layer_equation.protocol import LayerShare
from bem.polynomials.chebyshev import chebyshev_sum
from bem.polynomials.gauss_panels import chebyshev_from_nodes, gauss_nodes
from contact.records.validation import FloatArray

# Reach of the series in t that stands beside the axis, of the stretch to the first rim and of two thicknesses, beyond
# which the layer's images lie. It answers on the inner half, since panels there are too narrow to tell slopes. With
# this reach and six terms pressures are even to 1.3e-9, with 0.1 and five to 1.5e-9, with 0.06 and four to 1.9e-9 (E =
# 100^z and 4^z, nu = 0.3 and 0.5, a paraboloid at a/H = 0.1, 1 and 5, 2026-11-22).
AXIS: Final = 0.2
TERMS: Final = 6


def _beside_axis(share: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The terms of psi beside the axis and of psi'/t, shape (n, 11): even powers, and what the tip of a cone adds.

    A cone's density is like t, and a kernel like ln t + t makes t^2 ln t of it, t^3, t^4 ln t and so on.
    """
    logarithm, even = np.log(share), range(0, 2 * TERMS, 2)
    values = [share**n for n in even]
    slopes = [np.zeros_like(share), *(n * share ** (n - 2) for n in even[1:])]
    for n in range(2, TERMS + 1):
        values.append(share**n * (1.0 if n % 2 else logarithm))
        slopes.append(share ** (n - 2) * (n if n % 2 else n * logarithm + 1))
    return np.stack(values, axis=-1), np.stack(slopes, axis=-1)


@dataclass(frozen=True, eq=False)
class PanelSlopes:
    """A function on [0, a] by its values on relative panels, of which slopes and their Abel integrals are asked.

    Attributes:
        panels: On [0, 1].
        ratio: a, in thicknesses.
        values: At the nodes, shape (n,).
    """

    panels: RelativePanels
    ratio: float
    values: FloatArray

    def slope(self, t: FloatArray) -> FloatArray:
        """psi'(t) at points of [0, a]; beside the axis from the series."""
        inner = t < self._reach / 2
        found = self._panel_slope(np.maximum(t, self._reach / 2))
        share = np.maximum(t[inner] / self._reach, 1e-300)
        found[inner] = t[inner] / self._reach**2 * (_beside_axis(share)[1] @ self._axis_coefficients)
        return found

    @property
    def _reach(self) -> float:
        """Of the series, in thicknesses."""
        return AXIS * min(self.panels.first_bend * self.ratio, 2.0)

    @cached_property
    def _axis_coefficients(self) -> FloatArray:
        """Least squares in the panels' weights, without the first panel, where the logarithm of t + s is not resolved.

        Values are 1e-9 off on it, which would make pressures uneven by 2e-7.
        """
        share = self.ratio * self.panels.nodes / self._reach
        own = np.flatnonzero(share <= 1)[self.panels.count :]
        root = np.sqrt(self.panels.weights[own])
        terms = root[:, None] * _beside_axis(share[own])[0]
        return np.asarray(np.linalg.lstsq(terms, root * self.values[own], rcond=None)[0])

    def _panel_slope(self, t: FloatArray) -> FloatArray:
        """psi'(t) as the panels have it."""
        ends = self.ratio * self.panels.ends
        panel = np.clip(np.searchsorted(ends, t, side="left") - 1, 0, len(ends) - 2)
        s = 2 * (t - ends[panel]) / np.diff(ends)[panel] - 1
        return chebyshev_sum(self._slope_coefficients[panel], s)

    def abel_integral(self, radius: FloatArray) -> FloatArray:
        """int_r^a psi'(t)/sqrt(t^2 - r^2) dt for radii in [0, a], with t^2 = r^2 + s^2 on every panel."""
        v, omega = gauss_nodes(self.panels.count)
        ends = np.maximum(self.ratio * self.panels.ends, radius[:, None])
        s_ends = np.sqrt((ends - radius[:, None]) * (ends + radius[:, None]))
        width = np.diff(s_ends, axis=1)[..., None]
        s = s_ends[:, :-1, None] + width * v
        t = np.minimum(np.hypot(radius[:, None, None], s), self.ratio)
        values: FloatArray = np.sum(width * omega * self.slope(t) / np.maximum(t, 1e-300), axis=(1, 2))
        return values

    @cached_property
    def _slope_coefficients(self) -> FloatArray:
        coefficients = self.values.reshape(-1, self.panels.count) @ chebyshev_from_nodes(self.panels.count).T
        slope = np.zeros_like(coefficients)
        slope[:, :-1] = 2 * np.polynomial.chebyshev.chebder(coefficients, axis=1)
        return slope / (self.ratio * self.panels.widths[:, None])


@dataclass(frozen=True, eq=False)
class GradedDensity(LayerShare):
    """psi on [0, a]; it has the logarithm's kinks at both ends, towards which the panels are graded.

    Attributes:
        kernel: N.
        panels: On [0, 1].
        ratio: a, in thicknesses.
        phi: Whole density at the nodes, shape (n,).
        psi: The layer's share there and at the edge, shape (n + 1,).
    """

    kernel: PointKernel
    panels: RelativePanels
    ratio: float
    phi: FloatArray
    psi: FloatArray

    @property
    def edge_value(self) -> float:
        """psi(a)."""
        return float(self.psi[-1])

    @property
    def falls(self) -> bool:
        """phi at the nodes, which are dense at both ends."""
        return bool(np.all(np.diff(self.phi) <= 0.0) and self.phi[-1] >= 0.0)

    @property
    def first_shell(self) -> float:
        """The last panel: the logarithm has its kink at the edge."""
        return float(self.ratio * self.panels.widths[-1])

    def abel_integral(self, radius: FloatArray) -> FloatArray:
        """int_r^a psi'(t)/sqrt(t^2 - r^2) dt for radii in [0, a]."""
        return self.slopes.abel_integral(radius)

    @cached_property
    def slopes(self) -> PanelSlopes:
        """psi'."""
        return PanelSlopes(self.panels, self.ratio, self.psi[:-1])

    def outside(self, distance: FloatArray) -> FloatArray:
        """-int_0^a K(s, t) phi(t) dt at s = a + distance."""
        mass = self.phi * self.panels.weights * self.ratio
        t = self.ratio * self.panels.nodes
        rates = self.kernel.exponentials.rates[:, None]
        moments = (np.exp(-rates * (self.ratio - t)) + np.exp(-rates * (self.ratio + t))) @ mass
        decay = np.exp(-np.multiply.outer(distance, self.kernel.exponentials.rates))
        values: FloatArray = -(decay @ (self.kernel.exponentials.weights * moments)).real / np.pi
        return values

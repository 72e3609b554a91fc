"""Pressure of shapes to first order, in a coordinate in which the outline is a circle.

    p_n(r) = (E*/pi) r^n [psi(a)/sqrt(a^2 - r^2) - int_r^a psi'(x)/sqrt(x^2 - r^2) dx],   psi(x) = -x^-n phi_n(x)
    p(r, phi) = p_0(s) + sum_n cos(n phi) [p_n(s) + s p_0'(s) alpha_n/a_0],   s = r a_0/a(phi)

The brackets are regular at the edge, where p_n alone is infinite. A flat punch has phi_n = delta y_1 alpha_n times the
delta function at x = a, and a smooth part.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import CubicSpline

from contact import ContactPath
from contact.records.validation import FloatArray
from contact.scene.shapes import LARGEST_ORDER, Flat, Raised
from mdr.harmonics import Harmonics, basis_of
from mdr.spring_bed import Springs

# Nodes in u = sqrt(1 - s^2/a^2) of the brackets, of their integrals, and in ln(x) of the densities. With half of them
# errors of pressures are 1e-4 of the mean.
_NODES: Final = 40
_INTEGRAL: Final = np.polynomial.legendre.leggauss(40)
_DENSITY: Final = 160
# r over the outline a(phi) up to which the error of the pressure is estimated. At the edge any error of the outline
# changes the pressure by 100 %.
_INSIDE: Final = 0.98
# Smallest x over a of the densities. With ten times of it pressures change by 2e-5 of their mean, with a tenth by 5e-5.
_LEAST: Final = 1e-3
# Relative step of derivatives of the mean pressure. Half of it changes pressures by 6e-10 of their mean; twice of it
# leaves the contact at the outermost node.
_STEP: Final = 1e-4


@dataclass(frozen=True, eq=False)
class ShapeFields:
    """Outline and pressure of every step of a path.

    Attributes:
        shape: The indenter.
        springs: Springs of the mean profile.
        mean: The path of the mean profile.
        radius: Mean radius abar of the outline [m], shape (n,).
        harmonics: Amplitudes alpha_n of the outline [m], shape (n, p).
    """

    shape: Raised | Flat
    springs: Springs
    mean: ContactPath
    radius: FloatArray
    harmonics: FloatArray
    _brackets: dict[int, CubicSpline] = field(default_factory=dict)

    def outline(self, angle: FloatArray, step: int) -> FloatArray:
        """a(phi) [m], for a flat punch the outline of the punch."""
        if isinstance(self.shape, Flat):
            return self.shape.outline(angle)
        return np.asarray(self.radius[step] + self._cosines(angle) @ self.harmonics[step])

    def pressure(self, radius: FloatArray, step: int, angle: FloatArray) -> FloatArray:
        """p(r, phi) [Pa], zero outside the contact."""
        share = radius / self.outline(angle, step)
        inside = share < 1.0
        a = float(self.mean.contact_radius[step])
        u = np.sqrt(1.0 - share[inside] ** 2)
        p = np.zeros_like(radius)
        p[inside] = self.mean.pressure(a * share[inside], step)
        p[inside] += (self._cosines(angle[inside]) * self._bracket(step)(u)).sum(axis=1) * u**self._power
        return p

    def truncation(self, step: int) -> float:
        """Truncation error [Pa]: the largest sum of pressures of the upper half of the orders n, up to `_INSIDE`."""
        orders = np.array(self.shape.orders)
        upper = orders > LARGEST_ORDER / 2
        u = np.linspace(np.sqrt(1.0 - _INSIDE**2), 1.0, _NODES)
        return float(np.max(np.abs(self._bracket(step)(u)[:, upper]).sum(axis=1) * u**self._power))

    def _cosines(self, angle: ArrayLike) -> FloatArray:
        return np.asarray(np.cos(np.multiply.outer(np.asarray(angle), np.array(self.shape.orders))))

    @property
    def _power(self) -> int:
        """Exponent of u in the pressure near the edge."""
        return -1 if isinstance(self.shape, Flat) else 1

    def _bracket(self, step: int) -> CubicSpline:
        """Splines over u of p_n + s p_0' alpha_n/a for all orders, divided by `_power` of u [Pa]."""
        if step not in self._brackets:
            a = float(self.mean.contact_radius[step])
            u = np.sin(np.pi / 2 * (np.arange(_NODES) + 0.5) / _NODES)
            pressures = self._smooth(a, step, u) + self._shifted(a, step, u)
            self._brackets[step] = CubicSpline(u, pressures / u[:, None] ** self._power)
        return self._brackets[step]

    def _smooth(self, a: float, step: int, u: FloatArray) -> FloatArray:
        """p_n [Pa] without the part of the delta function, shape (u.size, p)."""
        orders, x = np.array(self.shape.orders), a * np.geomspace(_LEAST, 1.0, _DENSITY)
        radius = None if self.springs.kernel.is_uniform else self.springs.radius(a)
        harmonics = Harmonics(radius, self.shape.orders)
        if isinstance(self.shape, Flat):
            each = zip(harmonics.orders, harmonics.resolvent, strict=True)
            phi = np.array([R @ basis_of(n, harmonics.count, x / a) for n, R in each]) / a
            phi *= self._edge(a, step) * self.harmonics[step][:, None]
        else:
            phi = -harmonics.density(self.shape, a, x)
        density = CubicSpline(np.log(x), phi, axis=1)
        s, (t, w) = a * np.sqrt(1.0 - u**2), _INTEGRAL
        width = np.arccosh(a / s)[:, None] / 2
        at = s[:, None] * np.cosh(width * (1.0 + t))  # dx/sqrt(x^2 - s^2) = d arccosh(x/s)
        slope = density(np.log(at), 1) - orders[:, None, None] * density(np.log(at))
        integral = (slope * (s[:, None] / at) ** orders[:, None, None] / at * width * w).sum(axis=2)
        first = phi[:, -1:] * (s / a) ** orders[:, None] / (a * u)
        return np.asarray(self.springs.modulus / np.pi * (first - integral)).T

    def _edge(self, a: float, step: int) -> float:
        """phi(a) [m] under the flat punch."""
        return float(self.springs.at([a]).y1[0] * self.mean.indentation_depth[step])

    def _shifted(self, a: float, step: int, u: FloatArray) -> FloatArray:
        """s p_0'(s) alpha_n/a, plus the part of the delta function [Pa], shape (u.size, p)."""
        s, power, alpha = a * np.sqrt(1.0 - u**2), self._power, self.harmonics[step]

        def regular(r: FloatArray) -> FloatArray:
            """p_0(r) divided by sqrt(a^2 - r^2) to the `_power`."""
            return np.asarray(self.mean.pressure(r, step) / np.sqrt((a - r) * (a + r)) ** power)

        slope = (regular(s * (1 + _STEP)) - regular(s * (1 - _STEP))) / (2 * _STEP)
        shifted = slope * (a * u) ** power - power * s**2 * regular(s) * (a * u) ** (power - 2)
        pressures = np.outer(shifted, alpha / a)
        if isinstance(self.shape, Flat):
            front = self.springs.modulus / np.pi * self._edge(a, step) * a
            pressures -= front * alpha * (s[:, None] / a) ** np.array(self.shape.orders) / (a * u[:, None]) ** 3
        return pressures

"""Tractions and displacements of the surface under full stick."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import j0

from bem.layer_equation.stick.adhered_fields import AdheredFields, tanh_sinh
from bem.layer_equation.stick.adhered_punch import LARGEST_Q, AdheredPunch, halvings
from bem.polynomials.gauss import halved_panels
from bem.polynomials.gauss_panels import PANEL_NODES, gauss_nodes
from contact import Scene
from contact.records.validation import FloatArray
from mdr.friction.growth import Growth, Increments

# Nodes of the density under a contact grow with the thicknesses that it spans: one more rule for each three.
_SPAN = 3.0
# Below this share of a punch's radius its shear grows with the radius, to four digits.
_NEAR_AXIS = 1e-2


@dataclass(frozen=True)
class PunchFields:
    """Of an adhered flat punch, at every step.

    Attributes:
        punch: The punch under a depth of one.
        radius: a [m].
        modulus: E* [Pa].
        depth: delta [m], shape (n,).
    """

    punch: AdheredPunch
    radius: float
    modulus: float
    depth: FloatArray

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa], zero outside."""
        return self._traction("pressure", radius, step)

    def tangential_traction(self, radius: FloatArray, step: int) -> FloatArray:
        """q(r) [Pa], positive where the layer is pushed outward, zero outside."""
        return self._traction("shear", radius, step)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m]."""
        return np.asarray(self.depth[step] * AdheredFields(self.punch).normal_displacement(radius / self.radius))

    def _traction(self, name: str, radius: FloatArray, step: int) -> FloatArray:
        s, values = radius / self.radius, np.zeros_like(radius)
        # 4 G/(pi a) with G = beta E*/2.
        unit = 2.0 * self.punch.material.beta * self.modulus / (math.pi * self.radius)
        values[s < 1.0] = unit * self.depth[step] * getattr(AdheredFields(self.punch), name)(s[s < 1.0])
        return values


@dataclass(frozen=True)
class StickFields:
    """Of a contact that has grown under full stick.

    Attributes:
        scene: The problem.
        growth: Its solution, lengths in `unit`.
        unit: [m].
        modulus: E* [Pa].
        contact_radius: a in units, shape (n,).
        indentation_depth: delta [m], shape (n,).
    """

    scene: Scene
    growth: Growth
    unit: float
    modulus: float
    contact_radius: FloatArray
    indentation_depth: FloatArray

    def pressure(self, radius: FloatArray, step: int) -> FloatArray:
        """p(r) [Pa], zero outside."""
        return self._traction(self._unit_pressure, radius, step)

    def tangential_traction(self, radius: FloatArray, step: int) -> FloatArray:
        """q(r) [Pa], positive where the layer is pushed outward, zero outside."""
        return self._traction(self._unit_shear, radius, step)

    def surface_displacement(self, radius: FloatArray, step: int) -> FloatArray:
        """w(r) [m]: the indenter's shape inside; beside it the waves of the densities under all punches."""
        r, a = radius / self.unit, float(self.contact_radius[step])
        inside = r <= a
        values = self.indentation_depth[step] - self.scene.indenter.height(np.where(inside, radius, 0.0))
        if not inside.all():
            values[~inside] = self.unit * self._beside(r[~inside], a)
        return np.asarray(values)

    def _traction(
        self, unit: Callable[[FloatArray, Increments], FloatArray], radius: FloatArray, step: int
    ) -> FloatArray:
        """Increments of the depth times the tractions of their punches."""
        a, values = float(self.contact_radius[step]), np.zeros(radius.shape)
        for i in np.flatnonzero(radius / self.unit < a):
            r = float(radius[i] / self.unit)
            grown = self.growth.increments(r, a)
            values[i] = (grown.depth / grown.radius) @ unit(r / grown.radius, grown)
        return values * 2.0 * self.growth.table.material.beta * self.modulus / math.pi

    def _unit_pressure(self, s: FloatArray, punches: Increments) -> FloatArray:
        """p of unit punches at s = r/a, in units of 4 G/(pi a)."""
        a = punches.radius
        t, value, slope, weights, height = self._densities(s, punches.gap * (1.0 + s) / a, a)
        return np.asarray(((value - slope / t).real @ weights) / height)

    def _unit_shear(self, s: FloatArray, punches: Increments) -> FloatArray:
        """q likewise; near the axis it grows with the radius."""
        a, small = punches.radius, np.maximum(s, _NEAR_AXIS)
        square = np.where(s < _NEAR_AXIS, 1.0 - _NEAR_AXIS**2, punches.gap * (1.0 + s) / a)
        t, value, slope, weights, height = self._densities(small, square, a)
        integrand = value / t - slope / t**2 + (1.0 - t) * (1.0 + t) * value / t**3
        return np.asarray(s * (integrand.imag @ weights) / height)

    def _densities(
        self, s: FloatArray, square: FloatArray, a: FloatArray
    ) -> tuple[FloatArray, NDArray[np.complex128], NDArray[np.complex128], FloatArray, FloatArray]:
        """t, Phi, (1 - t^2) Phi' of unit punches on [s, 1], 1 - s^2 = square; weights and sqrt(1 - s^2)."""
        table, (v, rest, weights) = self.growth.table, tanh_sinh()
        t = np.sqrt(s[:, None] ** 2 + square[:, None] * v**2)
        short = np.maximum(square[:, None] * rest * (1.0 + v) / (1.0 + t), 1e-300)
        G, dG = table.below(a[:, None] * t, a)
        charge = table.material.charge
        turned = np.exp(1j * charge * np.log((1.0 + t) / short)) / math.sqrt(table.material.kappa)
        slope = turned * (2j * charge * G + short * (1.0 + t) * a[:, None] * dG)
        return t, turned * G, slope, weights, np.sqrt(square)

    def _beside(self, r: FloatArray, a: float) -> FloatArray:
        """w at r > a over the unit: (2/pi) (2 beta int phi/sqrt(r^2 - t^2) dt + waves of the layer)."""
        table, of = self.growth.table, self.growth.table.material
        parts = 1 if table.is_half_space else 1 + int(a / _SPAN)
        x, rest, weights = tanh_sinh(parts)
        phi = np.array([self._density(float(t), a) for t in a * x])
        # r - t of the rule's end, with all its digits.
        gap = (r - a)[:, None] + a * rest
        inner = (a * weights / np.sqrt(gap * (r[:, None] + a * x))) @ phi.real
        waves = np.zeros_like(r)
        if not table.is_half_space:
            width = min(1.0, 4.0 * math.pi / (a + float(r.max())))
            nodes, w = gauss_nodes(PANEL_NODES)
            panels = math.ceil(LARGEST_Q / width)
            starts, widths = halved_panels(panels, halvings(width * table.kernel.longest))
            k = (width * (starts[:, None] + widths[:, None] * nodes)).ravel()
            extra = table.kernel.beyond_half_space(k)
            angle = np.multiply.outer(k, a * x)
            P, Q = np.cos(angle) @ (a * weights * phi.real), np.sin(angle) @ (a * weights * phi.imag)
            density = np.multiply.outer(widths, width * w).ravel() * (extra.ww * P + extra.uw * Q)
            waves = j0(np.multiply.outer(r, k)) @ density
        return np.asarray(2.0 / math.pi * (2.0 * of.beta * inner + waves))

    def _density(self, t: float, a: float) -> complex:
        """Phi of the whole contact at t: of all punches larger than t."""
        table = self.growth.table
        grown = self.growth.increments(t, a)
        G, _ = table.below(np.full((grown.radius.size, 1), t), grown.radius)
        turned = np.exp(1j * table.material.charge * np.log((grown.radius + t) / np.maximum(grown.gap, 1e-300)))
        return complex(grown.depth @ (turned * G[:, 0])) / math.sqrt(table.material.kappa)

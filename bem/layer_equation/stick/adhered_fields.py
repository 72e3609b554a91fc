"""Tractions and displacements of the surface under and beside an adhered flat punch that is pressed in by one.

Lengths in the punch's radius a; tractions in units of 4 G/(pi a), displacements in units of the depth. Densities carry
the weight ``((1+t)/(1-t))^(i eps)``, which turns ever faster towards the edge: integrals over them use the tanh-sinh
rule, which thickens its nodes towards both ends.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.special import j0, j1

from bem.kernels.stack import Symmetric as TangentialKernel
from bem.layer_equation.stick.adhered_punch import AdheredPunch, BasisTransforms, basis_transforms
from contact.records.validation import FloatArray

# Step and half range of the tanh-sinh rule: its error is exp(-pi^2/(2 step)), and at the ends weights are below 1e-17.
_STEP = 0.05
_RANGE = 3.4
# Within this r/a shear and radial displacement, odd in r, are lines through the axis, where their integrals divide by
# powers of r: their cubic terms are below 1e-4 of them there (a/h = 1, bonded, nu = 0.3, 2026-11-22).
_SMALLEST_RADIUS = 1e-2
# Least distance from the edge, far below any that can be told from it, which keeps divisions finite.
_SMALLEST_REST = 1e-300


@dataclass(frozen=True)
class Densities:
    """Phi = phi + i psi at some t of [0, 1), and T = (1 - t^2) Phi'."""

    value: NDArray[np.complex128]
    slope: NDArray[np.complex128]


@dataclass(frozen=True)
class AdheredFields:
    """Fields of one punch."""

    punch: AdheredPunch

    def pressure(self, radius: FloatArray) -> FloatArray:
        """p at 0 <= r/a < 1, positive where it presses: at the very edge it pulls, as it must."""
        t, rest, weights = _towards_edge(radius)
        at = self.densities(t, rest)
        integral = (at.value - at.slope / t).real @ weights
        return np.asarray(integral / np.sqrt((1.0 - radius) * (1.0 + radius)))

    def shear(self, radius: FloatArray) -> FloatArray:
        """q at 0 <= r/a < 1, positive where it pushes the layer outward."""
        asked, radius = radius, np.maximum(radius, _SMALLEST_RADIUS)
        t, rest, weights = _towards_edge(radius)
        at = self.densities(t, rest)
        integrand = at.value / t - at.slope / t**2 + rest * (1.0 + t) * at.value / t**3
        return np.asarray(asked * (integrand.imag @ weights) / np.sqrt((1.0 - radius) * (1.0 + radius)))

    def normal_displacement(self, radius: FloatArray) -> FloatArray:
        """w at r/a >= 0: 1 inside."""
        of = self.punch.material
        transforms, extra = self._layer(radius)
        P, Q = self.punch.coefficients @ transforms.cosine, self.punch.coefficients @ transforms.sine
        density = transforms.weights * (extra.ww * P + extra.uw * Q)
        waves = j0(np.multiply.outer(radius, transforms.wavenumber)) @ density
        inner, _ = self._inner_integrals(radius)
        outer, _ = self._outer_integrals(radius)
        return np.asarray(2.0 / math.pi * (2.0 * of.beta * inner - of.eta * outer + waves))

    def radial_displacement(self, radius: FloatArray) -> FloatArray:
        """u at r/a >= 0, positive outward: 0 inside."""
        of, asked = self.punch.material, radius
        radius = np.maximum(radius, _SMALLEST_RADIUS)
        transforms, extra = self._layer(radius)
        P, Q = self.punch.coefficients @ transforms.cosine, self.punch.coefficients @ transforms.sine
        density = transforms.weights * (extra.uu * Q + extra.uw * P)
        waves = j1(np.multiply.outer(radius, transforms.wavenumber)) @ density
        _, inner = self._inner_integrals(radius)
        _, outer = self._outer_integrals(radius)
        enclosed = self.punch.half_force - outer
        displacement = 2.0 / math.pi * ((2.0 * of.beta * inner - of.eta * enclosed) / radius + waves)
        return np.asarray(displacement * np.minimum(asked / radius, 1.0))

    def densities(self, t: FloatArray, rest: FloatArray) -> Densities:
        """Phi and T at t with 1 - t = rest."""
        of, c = self.punch.material, self.punch.coefficients
        value, slope = np.zeros(t.shape, dtype=complex), np.zeros(t.shape, dtype=complex)
        for factor, (polynomial, derivative) in zip(_scaled(c, of.charge), _jacobi(t, of.charge, c.size), strict=True):
            value += factor * polynomial
            slope += factor * derivative
        weight = np.exp(1j * of.charge * np.log((1.0 + t) / rest))
        return Densities(weight * value, weight * (2j * of.charge * value + rest * (1.0 + t) * slope))

    def continued(self, s: FloatArray) -> NDArray[np.complex128]:
        """G = sqrt(kappa_nu) g at x/a, continued as the polynomial it is on the contact; for s up to 1.005 or so."""
        value = np.zeros(s.shape, dtype=complex)
        of, c = self.punch.material, self.punch.coefficients
        for factor, (polynomial, _) in zip(_scaled(c, of.charge), _jacobi(s, of.charge, c.size), strict=True):
            value += factor * polynomial
        return np.asarray(math.sqrt(of.kappa) * value)

    def transform_beside(self, s: FloatArray) -> NDArray[np.complex128]:
        """G beside the punch, s = x/a > 1, from the equation: ``((s+1)/(s-1))^(i eps) G = 1 - (S + K) Phi``."""
        of = self.punch.material
        if not s.size:
            return np.empty(0, dtype=complex)
        t, rest, weights = tanh_sinh()
        density = self.densities(t, rest).value * weights
        nearness = 1.0 / ((s[:, None] - t) * (s[:, None] + t))
        hilbert = -2.0 / math.pi * (s * (nearness @ density.real) + 1j * (nearness @ (t * density.imag)))
        transforms, extra = self._layer(s)
        P, Q = self.punch.coefficients @ transforms.cosine, self.punch.coefficients @ transforms.sine
        angle, w = np.multiply.outer(s, transforms.wavenumber), 2.0 / math.pi * transforms.weights
        normal_waves = np.cos(angle) @ (w * (extra.ww * P + extra.uw * Q))
        waves = normal_waves + 1j * np.sin(angle) @ (w * (extra.uu * Q + extra.uw * P))
        turned: NDArray[np.complex128] = np.exp(-1j * of.charge * np.log((s + 1.0) / (s - 1.0)))
        return np.asarray((1.0 - 1j * of.eta * hilbert - waves) * turned)

    def _layer(self, radius: FloatArray) -> tuple[BasisTransforms, TangentialKernel]:
        """Waves that resolve the surface out to these radii, and the layer's share of the compliance there."""
        reach = max(1.0, float(np.max(radius, initial=0.0)))
        punch = self.punch
        transforms = basis_transforms(
            punch.material.charge, punch.ratio, punch.coefficients.size, reach=reach, longest=punch.kernel.longest
        )
        return transforms, self.punch.compliance(transforms)

    def _inner_integrals(self, radius: FloatArray) -> tuple[FloatArray, FloatArray]:
        """int_0^min(s,1) of phi and of psi t, over sqrt(s^2 - t^2)."""
        nodes, _, weights = tanh_sinh()
        end = np.arcsin(np.minimum(1.0, 1.0 / np.maximum(radius, 1.0)))
        angle = np.multiply.outer(end, nodes)
        t = radius[..., None] * np.sin(angle)
        # Below a point inside, t ends at s; beside the punch it ends at 1, where 1 - t needs its own digits.
        rest = np.where(radius[..., None] < 1.0, 1.0 - t, _rest_outside(radius, end))
        at = self.densities(np.minimum(t, 1.0 - _SMALLEST_REST), np.maximum(rest, _SMALLEST_REST))
        scaled = end[..., None] * weights
        return (at.value.real * scaled).sum(-1), (at.value.imag * t * scaled).sum(-1)

    def _outer_integrals(self, radius: FloatArray) -> tuple[FloatArray, FloatArray]:
        """int_s^1 of psi and of phi t, over sqrt(t^2 - s^2); zero beside the punch."""
        inside = np.minimum(radius, 1.0)
        t, rest, weights = _towards_edge(inside)
        at = self.densities(t, rest)
        height = np.sqrt((1.0 - inside) * (1.0 + inside))
        return height * ((at.value.imag / t) @ weights), height * (at.value.real @ weights)


@cache
def tanh_sinh(parts: int = 1) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Nodes x on (0, 1), 1 - x with all its digits, and weights; with `parts` times as many nodes."""
    step = _STEP / parts
    u = np.arange(-_RANGE, _RANGE + step / 2.0, step)
    y = math.pi / 2.0 * np.sinh(u)
    x, rest = 1.0 / (1.0 + np.exp(-2.0 * y)), 1.0 / (1.0 + np.exp(2.0 * y))
    weights = np.cosh(u) * x * rest
    # What the rounded weights miss of 1 counts as often as an incompressible layer is stiffer than the half-space.
    return x, rest, weights / math.fsum(weights)


def _towards_edge(radius: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """t = sqrt(s^2 + (1 - s^2) v^2), 1 - t, and the weights of v on (0, 1)."""
    v, rest, weights = tanh_sinh()
    square = ((1.0 - radius) * (1.0 + radius))[..., None]
    t = np.sqrt(radius[..., None] ** 2 + square * v**2)
    return t, np.maximum(square * rest * (1.0 + v) / (1.0 + t), _SMALLEST_REST), weights


def _rest_outside(radius: FloatArray, end: FloatArray) -> FloatArray:
    """1 - s sin(x end) where s sin(end) = 1: s (sin(end) - sin(x end)) as a product."""
    x, rest, _ = tanh_sinh()
    half = end[..., None] / 2.0
    product: FloatArray = 2.0 * radius[..., None] * np.cos(half * (1.0 + x)) * np.sin(half * rest)
    return product


def _scaled(coefficients: FloatArray, charge: float) -> NDArray[np.complex128]:
    """c_n i^n/sqrt(h_n)."""
    n = np.arange(coefficients.size)
    gamma = math.pi * charge / math.sinh(math.pi * charge) if charge else 1.0
    squares = gamma * np.cumprod(np.concatenate([[1.0], 1.0 + (charge / n[1:]) ** 2]))
    return np.asarray(coefficients * (1j) ** (n % 4) / np.sqrt(2.0 / (2 * n + 1) * squares), dtype=complex)


def _jacobi(
    t: FloatArray, charge: float, count: int
) -> Iterator[tuple[NDArray[np.complex128], NDArray[np.complex128]]]:
    """P_n^(-i eps, i eps)(t) and its derivative for n = 0 .. count - 1; only the first step is complex."""
    before: NDArray[np.complex128] = np.ones(t.shape, dtype=complex)
    here: NDArray[np.complex128] = np.asarray(t - 1j * charge, dtype=complex)
    slope_before, slope = np.zeros(t.shape, dtype=complex), np.ones(t.shape, dtype=complex)
    yield before, slope_before
    for n in range(1, count):
        yield here, slope
        ahead, back = (2 * n + 1) / (n + 1), (n**2 + charge**2) / (n * (n + 1))
        before, here, slope_before, slope = (
            here,
            ahead * t * here - back * before,
            slope,
            ahead * (here + t * slope) - back * slope_before,
        )

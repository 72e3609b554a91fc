"""A flat punch under full stick, pressed into a layer or a stack.

The unknown is Phi = phi + i psi, the Abel densities of pressure and shear, in 4 G/pi for a unit depth, lengths over the
radius. It is a series in rho(t) times Jacobi polynomials,

    rho = ((1 + t)/(1 - t))^(i eps),   eps = ln(3 - 4 nu)/(2 pi),

in which the operator of the half-space is the diagonal matrix kap^(1/2), kap = 3 - 4 nu (Spence 1968). Their transforms
P (cosine, of phi) and Q (sine, of psi) are Coulomb wave functions F_n(+-eps, k). The layer adds the smooth symmetric
matrix (4/pi) int [D_WW P P + D_UU Q Q + D_UW (P Q + Q P)] dk, D = C - C_half-space of `bem.kernels.stack`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve
from scipy.special import j0

from bem.kernels.stack import StackKernel
from bem.numerics import panels
from contact.records.validation import FloatArray
from mdr.inside import wave_rule

# Wave number beyond which layers add nothing, exp(-2k); with half of it 1e-9.
REACH = 21.5
# Ratio of neighbouring panels towards an end, and their number: integrals of exp(i eps ln(1 - t)) have errors of 1e-16;
# with half as many panels of 1e-8.
_RATIO, _LEVELS = 0.15, 17
# r/a below which shear is taken as linear in r: half of it loses digits, twice leaves 4e-5.
_NEAR_AXIS = 3e-3
# x/a up to which G is computed by the polynomials of the density. With 1.005 the error is 1e-6 at a/h = 50.
_POLYNOMIAL_END = 1 + 1e-6

ComplexArray: TypeAlias = NDArray[np.complex128]
Rule: TypeAlias = tuple[FloatArray, FloatArray, FloatArray]
# Phi and (1 - t^2) Phi' at t = 1 - rest, from t and rest.
Density: TypeAlias = Callable[[FloatArray, FloatArray], tuple[ComplexArray, ComplexArray]]


def towards_one(count: int, levels: int = 0) -> Rule:
    """Nodes v of [0, 1], 1 - v with all digits, and weights: panels shrink towards 1, and `levels` times towards 0."""
    near = 0.5 * _RATIO ** np.arange(_LEVELS)[::-1]
    rest, w = panels(np.concatenate([[0.0], near, 1 - 0.5 * _RATIO ** np.arange(1, levels + 1), [1.0]]), count)
    return 1 - rest, rest, w


def abel(s: FloatArray, square: FloatArray, rule: Rule, density: Density) -> FloatArray:
    """p and q at s in 4 G/(pi a), shape (2, n), from Phi and (1 - t^2) Phi'; square = 1 - s^2."""
    s, square, (v, rest, w) = s[:, None], square[:, None], rule
    t = np.maximum(np.sqrt(s * s + square * v * v), 1e-100)
    short = np.maximum(square * rest * (1 + v) / (1 + t), 1e-300)
    phi, slope = density(t, short)
    p = (phi - slope / t).real
    if s.min(initial=1.0) < _NEAR_AXIS:
        near = np.maximum(s, _NEAR_AXIS)
        shear = abel(near[:, 0], np.where(s < near, 1 - near**2, square)[:, 0], rule, density)[1]
        return np.array([p @ w / np.sqrt(square[:, 0]), shear * (s / near)[:, 0]])
    q = (s / t * (phi - slope / t + short * (1 + t) * phi / t**2)).imag
    return np.asarray(np.array([p @ w, q @ w]) / np.sqrt(square[:, 0]))


def _turns(eps: float, count: int) -> FloatArray:
    """theta_n = sum_(j <= n) atan(eps/j)."""
    return np.concatenate([[0.0], np.cumsum(np.arctan(eps / np.arange(1, count)))])


def coulomb(eps: float, x: FloatArray, count: int) -> FloatArray:
    """exp(pi eps/2) F_n(eps, x)/x, n < count: Miller's recurrence, scaled by its generating sum."""
    top = int(max(count, x.max(initial=1.0)) + 40 + 6 * np.cbrt(x.max(initial=1.0)))
    n = np.arange(top + 1)
    phase = (2 * n + 1) * (-1j) ** (n % 4) * np.exp(-1j * _turns(eps, top + 1))
    table, above, here = np.zeros((count, x.size)), np.zeros(x.size), np.full(x.size, 1e-250)
    total = np.zeros(x.size, dtype=np.complex128)
    for m in range(top, -1, -1):
        total = total + phase[m] * here
        if m < count:
            table[m] = here
        large = np.abs(here) > 1e200
        if large.any():
            for array in (here, above, total, table.T):
                array[large] /= 1e200
        if m:
            below = ((2 * m + 1) / x + eps / m + eps / (m + 1)) * here - np.hypot(1, eps / (m + 1)) * above
            above, here = here, below / np.hypot(1, eps / m)
    gamma = np.sqrt(np.pi * eps / np.sinh(np.pi * eps)) if eps else 1.0
    return np.asarray(table * (gamma * np.exp(-1j * x) / total).real)


class Adhered:
    """Solution of the equation of the adhered punch of radius a.

    Args:
        kernel: Kernel of the layer.
        a: Radius in units of the kernel.
        extra: Number of further polynomials and nodes.
        far: Largest x/a at which `beside` is evaluated.
    """

    def __init__(self, kernel: StackKernel, a: float, extra: int = 0, far: float = 1.0) -> None:
        self.kernel, self.a, nu = kernel, a, kernel.poissons_ratio
        self.eta, self.beta, self.kap = 1 - 2 * nu, 1 - nu, 3 - 4 * nu
        self.eps = float(np.log1p(2 * self.eta) / (2 * np.pi))
        self.per_eta = self.eps / self.eta if self.eta else 1 / np.pi
        x = 0.0 if kernel.is_half_space else a
        self.count = max(8, 24 + int(16 * np.sqrt(x) + max(0.0, x - 10) / 2) + extra)
        self.rule = towards_one(20 + self.count // 2 + extra)
        self.first = float(np.sqrt(2 * np.pi * self.per_eta * np.sqrt(self.kap)))
        matrix = np.sqrt(self.kap) * np.eye(self.count)
        self.nodes = 20 + extra
        if not kernel.is_half_space:
            matrix += self._of_layer(far)
        right = np.zeros(self.count)
        right[0] = self.first
        self.c = np.asarray(cho_solve(cho_factor(matrix), right))
        self.condition = float(np.linalg.cond(matrix))

    def _waves(self, far: float) -> tuple[FloatArray, FloatArray]:
        """Wave numbers k a and weights, shape (m,), for fields up to x/a = far."""
        k, w = wave_rule(REACH, self.a * (1 + far), self.kernel.longest, self.nodes)
        return k * self.a, w * self.a

    def _basis(self, k: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Cosine transforms of the even and sine transforms of the odd part of each basis function, shape (n, m)."""
        n = np.arange(self.count)[:, None]
        plus, minus = coulomb(self.eps, k, self.count), coulomb(-self.eps, k, self.count) * (-1.0) ** n
        size = np.sqrt((2 * n + 1) / 8)
        return size * (plus + minus), size * (plus - minus)

    def _of_layer(self, far: float) -> FloatArray:
        """Matrix of the layer, shape (n, n). Wave numbers, weights times D, and transforms are stored for fields."""
        self.k, w = self._waves(far)
        self.cosine, self.sine = self._basis(self.k)
        self.extra = [w * compliance for compliance in self.kernel.beyond_half_space(self.k / self.a)]
        uu, uw, ww = (4 / np.pi * weight for weight in self.extra)
        mixed = (self.cosine * uw) @ self.sine.T
        return np.asarray((self.cosine * ww) @ self.cosine.T + (self.sine * uu) @ self.sine.T + mixed + mixed.T)

    @property
    def stiffness(self) -> float:
        """Stiffness over 2 E*, k_stick/(2 E*), a length in units of the kernel."""
        return float(self.a * self.beta * self.first * self.c[0])

    @property
    def spring(self) -> float:
        """c_stick/E* = (dk_stick/da)/(2 E*)."""
        n = np.arange(self.count)
        phase = 1j ** (n % 4) * np.exp(-1j * _turns(self.eps, self.count))
        edge = (self.c * np.sqrt(2 * n + 1) * phase).sum() / self.first
        return float(2 * np.pi * self.per_eta * self.kap * self.beta * abs(edge) ** 2)

    @cached_property
    def _factors(self) -> ComplexArray:
        """Coefficients of g in the polynomials of the recurrence in `polynomial`, shape (n,)."""
        n = np.arange(self.count)
        size = 2 / (2 * n + 1) * self.first**2 / 2 * np.cumprod(np.concatenate([[1.0], 1 + (self.eps / n[1:]) ** 2]))
        return np.asarray(self.c * 1j ** (n % 4) / np.sqrt(size))

    def polynomial(self, t: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """g(t) and g'(t) of Phi = rho g."""
        eps, factor = self.eps, self._factors
        here: NDArray[Any] = t - 1j * eps
        below, slope_below, slope = np.ones_like(here), np.zeros_like(here), np.ones_like(here)
        value, change = factor[0] + factor[1] * here, factor[1] * slope
        for m in range(1, self.count - 1):
            ahead, back = (2 * m + 1) / (m + 1), (m * m + eps * eps) / (m * (m + 1))
            next_slope = ahead * (here + t * slope) - back * slope_below
            below, here = here, np.asarray(ahead * t * here - back * below)
            slope_below, slope = slope, next_slope
            value, change = value + factor[m + 1] * here, change + factor[m + 1] * slope
        return value, change

    def density(self, t: FloatArray, rest: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """Phi and (1 - t^2) Phi' at t = 1 - rest."""
        g, slope = self.polynomial(t)
        rho = np.exp(1j * self.eps * np.log((1 + t) / rest))
        return rho * g, rho * (2j * self.eps * g + rest * (1 + t) * slope)

    def tractions(self, s: FloatArray) -> FloatArray:
        """p/E* and q/E*, shape (2, n), at s = r/a < 1 for a unit depth; q > 0 pushes the layer outwards."""
        return 2 * self.beta / np.pi / self.a * abel(s, (1 - s) * (1 + s), self.rule, self.density)

    def displacement(self, s: FloatArray) -> FloatArray:
        """u_z/depth outside the punch at s = r/a > 1."""
        t, rest, w = self.rule
        phi, _ = self.density(t, rest)
        near = w / np.sqrt((s[:, None] - 1 + rest) * (s[:, None] + t)) @ phi.real
        return 2 / np.pi * (2 * self.beta * near + self._added(s))

    def _added(self, s: FloatArray) -> FloatArray | float:
        """Part of (pi/2) u_z/depth at s = r/a that the layer adds to the half-space."""
        if self.kernel.is_half_space:
            return 0.0
        k, w = self._waves(float(s.max()))
        cosine, sine = self._basis(k)
        _, uw, ww = self.kernel.beyond_half_space(k / self.a)
        return np.asarray(j0(np.multiply.outer(s, k)) @ (w * (ww * (self.c @ cosine) + uw * (self.c @ sine))))

    def beside(self, s: FloatArray) -> ComplexArray:
        """G at s = x/a > 0, shape (n,), analytic across s = 1, for a unit depth.

        Outside the punch depth minus Abel transform of the surface is Re[((s + 1)/(s - 1))^(i eps) G]. Inside
        G = sqrt(kap) g, g of `polynomial`.
        """
        G: ComplexArray = np.asarray(np.sqrt(self.kap) * self.polynomial(s)[0])
        out = s > _POLYNOMIAL_END
        far, (t, rest, w) = s[out][:, None], self.rule
        phi, nearness = self.density(t, rest)[0] * w, 1 / ((far - 1 + rest) * (far + t))
        hilbert = -(far[:, 0] * (nearness @ phi.real) + 1j * (nearness @ (t * phi.imag)))
        remaining = 1 - 2j / np.pi * self.eta * hilbert
        if not self.kernel.is_half_space:
            uu, uw, ww = self.extra
            p, q = self.c @ self.cosine, self.c @ self.sine
            waves = far * self.k
            remaining = remaining - 2 / np.pi * (
                np.cos(waves) @ (ww * p + uw * q) + 1j * np.sin(waves) @ (uu * q + uw * p)
            )
        G[out] = remaining * np.exp(-1j * self.eps * np.log((far + 1) / (far - 1)))[:, 0]
        return G

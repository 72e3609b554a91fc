"""First-order contact of harmonics f_n(r) cos(n phi) of an indenter, within the mean contact of radius a.

For f_n(r) cos(n phi) the density of the pressure obeys

    phi_n(x) - (2/pi) int_0^a L_n(x, t) phi_n(t) dt = G_n(x)
    L_n(x, t) = int_0^inf (1 - chi) [kx j_(n-1)(kx)] [kt j_(n-1)(kt)] dk
    G_n(x) = int_0^(pi/2) sin^(n+1)(u) [(n + 1) f_n(r) + r f_n'(r)] du,   r = x sin(u)

With b_m(s) = sqrt(4m + 2n + 1) (-1)^m s^n P_m^(n-1/2, 0)(1 - 2 s^2), orthonormal on [0, 1], the transform
int_0^1 b_m(s) ks j_(n-1)(ks) ds = sqrt(4m + 2n + 1) (-1)^m j_(n+2m)(k) is known, as for n = 0 (`bem.equation`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import eval_jacobi

from bem.equation import Radius
from bem.numerics import cholesky, gauss, panels, solve_factored, spherical_bessel
from contact.records.validation import FloatArray
from contact.scene.shapes import Raised

# Nodes of quadratures over u, and additional ones over s, between two breakpoints. The error for blunt pyramids is 1e-7
# with half as many, 1e-9 with twice as many.
_NODES = 20


class Harmonics:
    """Densities of harmonics under one contact radius.

    Args:
        radius: The integral equation at that radius; None on the half-space.
        orders: n, shape (p,).
    """

    def __init__(self, radius: Radius | None, orders: Sequence[int]) -> None:
        self.orders = tuple(orders)
        self.count = 1 if radius is None else radius.count
        self._factors: list[FloatArray] = []
        self.resolvent = np.zeros((len(orders), self.count))  # (A^-1 G)(a) = G(a) + int_0^1 R(s) G(a s) ds
        self.edge = np.zeros(len(orders))  # a psi_n(a), the solution of right side (2/pi) L_n(x, a)
        if radius is not None:
            self._solve(radius)

    def _solve(self, radius: Radius) -> None:
        """Factor the equation of each order, and compute `resolvent` and `edge`."""
        kappa, w, _ = radius.waves()
        weight = 2 / np.pi * w * radius.kernel.one_minus_chi(kappa / radius.a)
        bessel = spherical_bessel(kappa, max(self.orders) + 2 * self.count)
        for i, n in enumerate(self.orders):
            m = np.arange(self.count)
            table = (np.sqrt(4 * m + 2 * n + 1) * (-1.0) ** m)[:, None] * bessel[n + 2 * m]
            at_edge = kappa * bessel[n - 1] if n else np.cos(kappa)
            column = table @ (weight * at_edge)
            factor = cholesky(np.eye(self.count) - (table * weight) @ table.T)
            self._factors.append(factor)
            self.resolvent[i] = solve_factored(factor, column)
            self.edge[i] = weight @ at_edge**2 + self.resolvent[i] @ column

    @property
    def growth(self) -> FloatArray:
        """n/2 + a (psi_n(a) - psi_0(a)) for all orders n but the first, n = 0, shape (p - 1,)."""
        return np.asarray(np.array(self.orders[1:]) / 2 + self.edge[1:] - self.edge[0])

    def density_at_edge(self, shape: Raised, a: float) -> FloatArray:
        """phi_n(a) [m] for all orders n, shape (p,)."""
        return np.asarray(
            transforms(shape, self.orders, np.array([a]))[:, 0] + (self.resolvent * self._moments(shape, a)).sum(axis=1)
        )

    def density(self, shape: Raised, a: float, x: FloatArray) -> FloatArray:
        """phi_n [m] at 0 < x <= a, shape (p, x.size)."""
        phi, moments = transforms(shape, self.orders, x), self._moments(shape, a)
        for i, factor in enumerate(self._factors):
            smooth = solve_factored(factor, moments[i]) - moments[i]
            phi[i] += smooth @ basis_of(self.orders[i], self.count, x / a)
        return phi

    def _moments(self, shape: Raised, a: float) -> FloatArray:
        """int_0^1 G_n(a s) b_m(s) ds [m], shape (p, count)."""
        if not self._factors:
            return np.zeros_like(self.resolvent)
        s, weight = panels([0.0, *(b / a for b in shape.breakpoints if b < a), 1.0], self.count + _NODES)
        inside = transforms(shape, self.orders, a * s)
        bases = [basis_of(n, self.count, s) for n in self.orders]
        return np.array([basis @ (weight * g) for basis, g in zip(bases, inside, strict=True)])


def basis_of(order: int, count: int, s: FloatArray) -> FloatArray:
    """b_m(s), shape (count, s.size)."""
    m = np.arange(count)[:, None]
    polynomials = eval_jacobi(m, order - 0.5, 0.0, 1 - 2 * s**2)
    return np.asarray(np.sqrt(4 * m + 2 * order + 1) * (-1.0) ** m * s**order * polynomials)


def transforms(shape: Raised, orders: Sequence[int], x: FloatArray) -> FloatArray:
    """G_n(x) [m] at x > 0 [m], shape (p, x.size)."""
    breaks = np.array(shape.breakpoints)
    inner = np.arcsin(np.minimum(breaks / x[:, None], 1.0))
    ends = np.hstack([np.zeros((x.size, 1)), inner, np.full((x.size, 1), np.pi / 2)])
    v, w = gauss(_NODES)
    width = np.diff(ends)[..., None]
    sine, weight = np.sin(ends[:, :-1, None] + width * v), width * w
    r = x[:, None, None] * sine
    height, slope = shape.harmonic(orders, r)
    n = np.array(orders)
    integrand = sine[..., None] ** (n + 1) * ((n + 1) * height + r[..., None] * slope)
    return np.asarray(np.einsum("xab,xabp->px", weight, integrand))

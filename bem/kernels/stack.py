"""Compliance of a stack of layers in wavenumber space, by a recursion without subtraction of large numbers.

Displacements v = (U, W) and tractions t = (Q, P) belong to the Bessel functions (J1, J0). What lies below a plane is
``v = C t`` with a symmetric positive C. In units ``tau = t/(2 G k)`` of a layer, and q = kh,

    v_top = N tau_top + A v_bottom,    tau_bottom = A^T tau_top - K v_bottom,    C_top = N + A (C^-1 + K)^-1 A^T,

N being the compliance of the layer glued to a rigid base, K the stiffness of its lower face under a free top, and A
what passes through. All are sums of positive terms, divided by exp(2q). The surface answers with
``chi = C_WW/(2 (1 - nu))`` (Redheffer's star product, as for waves in stratified media; there is no transfer matrix).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial, inf
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.kernels.layer import SERIES_LIMIT, SERIES_TERMS, one_minus_kernel, shear_bracket_over_q
from bem.kernels.tangential import TangentialKernel, beyond_half_space


class Symmetric(NamedTuple):
    """A symmetric matrix of two rows at every wavenumber."""

    uu: NDArray[Any]
    uw: NDArray[Any]
    ww: NDArray[Any]

    @property
    def determinant(self) -> NDArray[Any]:
        """Of each matrix."""
        difference: NDArray[Any] = self.uu * self.ww - self.uw**2
        return difference

    def times(self, factor: float) -> Symmetric:
        """Each entry times a factor."""
        return Symmetric(self.uu * factor, self.uw * factor, self.ww * factor)


@dataclass(frozen=True)
class Sheet:
    """One uniform layer in units of the first one.

    Attributes:
        thickness: h_i over the first layer's.
        shear_modulus: G_i over the first layer's.
        poissons_ratio: nu_i.
        slips_below: Whether its lower face slides without friction.
    """

    thickness: float
    shear_modulus: float
    poissons_ratio: float
    slips_below: bool

    @property
    def plane_modulus(self) -> float:
        """E*_i = 2 G_i/(1 - nu_i)."""
        return 2 * self.shear_modulus / (1 - self.poissons_ratio)


@dataclass(frozen=True)
class StackKernel:
    """Kernel of layers on a rigid base or on an elastic half-space.

    Attributes:
        sheets: From the top.
        base: The half-space below, of infinite thickness; None for a rigid base.
    """

    sheets: tuple[Sheet, ...]
    base: Sheet | None

    @property
    def longest(self) -> float:
        """Total thickness, or what stretches farther: a stiff film spreads a load over (E1/E2) h."""
        stiffness = [sheet.shear_modulus for sheet in (*self.sheets, *([self.base] if self.base else []))]
        total = sum(sheet.thickness for sheet in self.sheets)
        return total * max(1.0, max(stiffness) / min(stiffness))

    @property
    def is_smooth(self) -> bool:
        """1 - chi falls exponentially."""
        return True

    @property
    def poissons_ratio(self) -> float:
        """Of the first layer."""
        return self.sheets[0].poissons_ratio

    @property
    def edge_slope(self) -> float:
        """Zero: 1 - chi falls exponentially."""
        return 0.0

    @property
    def zero_mode(self) -> float:
        """chi/k at k = 0: uniaxial strain, less what groups of layers give that may slide sideways."""
        if self.base is not None:
            return inf
        strain = sum(one.thickness * _uniaxial_compliance(one) for one in self.sheets)
        return self.sheets[0].plane_modulus / 2 * (strain + sum(_sideways(group) for group in _free_groups(self)))

    def chi(self, wavenumber: NDArray[Any]) -> NDArray[Any]:
        """chi at wavenumbers with Re k > 0, any shape."""
        top = self.sheets[0]
        q = top.thickness * wavenumber
        own = step(q, top.poissons_ratio)
        chi: NDArray[Any] = (own.glued.ww + self._through(own, wavenumber)) / (2 * (1 - top.poissons_ratio))
        return chi

    def one_minus_chi(self, wavenumber: NDArray[Any]) -> NDArray[Any]:
        """1 - chi: that of the first layer alone, less what comes through it."""
        top = self.sheets[0]
        q = top.thickness * wavenumber
        own = step(q, top.poissons_ratio)
        alone = one_minus_kernel(q, "bonded", top.poissons_ratio)
        rest: NDArray[Any] = alone - self._through(own, wavenumber) / (2 * (1 - top.poissons_ratio))
        return rest

    def beyond_half_space(self, wavenumber: NDArray[Any]) -> TangentialKernel:
        """D = C - C_hs for both tractions: that of the first layer alone, and what comes through it."""
        top = self.sheets[0]
        q = top.thickness * wavenumber
        own = step(q, top.poissons_ratio)
        alone = beyond_half_space(q, "bonded", top.poissons_ratio)
        nothing = own._replace(glued=_rigid(wavenumber))
        more = passed(nothing, coupled(self._below(wavenumber), own, slips=top.slips_below))
        return TangentialKernel(alone.radial + more.uu, alone.coupling + more.uw, alone.normal + more.ww)

    def _through(self, own: Step, wavenumber: NDArray[Any]) -> NDArray[Any]:
        """What the layers below add to C_WW of the first."""
        M = coupled(self._below(wavenumber), own, slips=self.sheets[0].slips_below)
        through: NDArray[Any] = own.wu**2 * M.uu + 2 * own.wu * own.ww * M.uw + own.ww**2 * M.ww
        return through

    def _below(self, wavenumber: NDArray[Any]) -> Symmetric:
        """C of all that lies below the first layer, in its units."""
        below = base_compliance(self, wavenumber)
        for lower in self.sheets[:0:-1]:
            one = step(lower.thickness * wavenumber, lower.poissons_ratio)
            inside = below.times(lower.shear_modulus)
            through = passed(one, coupled(inside, one, slips=lower.slips_below))
            below = through.times(1 / lower.shear_modulus)
        return below.times(self.sheets[0].shear_modulus)


class Step(NamedTuple):
    """N, K and det K of one layer, and A by (row at the top, column at the bottom)."""

    glued: Symmetric
    free: Symmetric
    free_determinant: NDArray[Any]
    uu: NDArray[Any]
    uw: NDArray[Any]
    wu: NDArray[Any]
    ww: NDArray[Any]


def step(q: NDArray[Any], nu: float) -> Step:
    """Equations of THEORY for one layer; numerators and denominator times exp(-2q), A times exp(-q) twice."""
    kap, eta, beta = 3 - 4 * nu, 1 - 2 * nu, 1 - nu
    root = np.exp(-q)
    e, qe = root**2, q * root
    # The products c^2, s^2 and s c - q of c = cosh q and s = sinh q, all times exp(-2q).
    cc, ss, excess = (1 + e) ** 2 / 4, np.expm1(-2 * q) ** 2 / 4, q * shear_bracket_over_q(q) / 4
    D = kap * cc + eta**2 * e + qe**2
    linear, square = qe * root, qe**2
    double = excess + 2 * linear
    glued = Symmetric(
        2 * beta * (kap * excess + (kap + 1) * linear) / D,
        (square - eta * kap * ss) / D,
        2 * beta * (kap * excess + 2 * eta * linear) / D,
    )
    free = Symmetric(2 * beta * double / D, -(eta * ss + square) / D, 2 * beta * excess / D)
    c, s = (1 + e) / 2, -np.expm1(-2 * q) / 2
    along, across = root * 2 * beta / D, qe * 2 * beta / D
    return Step(
        glued,
        free,
        _squares_apart(q, ss, square) / D,
        2 * beta * along * c - across * s,
        -(across * c + along * eta * s),
        across * c - along * eta * s,
        2 * beta * along * c + across * s,
    )


def _squares_apart(q: NDArray[Any], ss: NDArray[Any], square: NDArray[Any]) -> NDArray[Any]:
    """(sinh^2 q - q^2) exp(-2q): a series of positive terms where the difference cancels."""
    small = np.abs(q) < SERIES_LIMIT
    t2 = np.where(small, 2 * q, 0) ** 2
    series = np.zeros_like(t2)
    for k in reversed(range(SERIES_TERMS)):
        series = series * t2 + _EVEN[k]
    result: NDArray[Any] = np.where(small, t2**2 * series * np.exp(-2 * np.where(small, q, 0)) / 2, ss - square)
    return result


_EVEN: Final = tuple(1 / factorial(2 * k + 4) for k in range(SERIES_TERMS))


def coupled(below: Symmetric, step: Step, *, slips: bool) -> Symmetric:
    """M = (C^-1 + K)^-1, or its limit for a frictionless interface, which passes pressure only."""
    K, det_K = step.free, step.free_determinant
    if slips:
        c = below.ww
        d = K.uu + c * det_K
        return Symmetric((1 + c * K.ww) / d, -c * K.uw / d, c * K.uu / d)
    det_C = below.determinant
    d = 1 + K.uu * below.uu + 2 * K.uw * below.uw + K.ww * below.ww + det_K * det_C
    return Symmetric((below.uu + det_C * K.ww) / d, (below.uw - det_C * K.uw) / d, (below.ww + det_C * K.uu) / d)


def passed(step: Step, M: Symmetric) -> Symmetric:
    """N + A M A^T."""
    uu, uw, wu, ww = step.uu, step.uw, step.wu, step.ww
    return Symmetric(
        step.glued.uu + uu**2 * M.uu + 2 * uu * uw * M.uw + uw**2 * M.ww,
        step.glued.uw + uu * wu * M.uu + (uu * ww + uw * wu) * M.uw + uw * ww * M.ww,
        step.glued.ww + wu**2 * M.uu + 2 * wu * ww * M.uw + ww**2 * M.ww,
    )


def base_compliance(kernel: StackKernel, wavenumber: NDArray[Any]) -> Symmetric:
    """C of the base times 2k, over the first layer's modulus."""
    return _rigid(wavenumber) if kernel.base is None else _half_space(wavenumber, kernel.base)


def _rigid(wavenumber: NDArray[Any]) -> Symmetric:
    zero = np.zeros_like(wavenumber)
    return Symmetric(zero, zero, zero)


def _half_space(wavenumber: NDArray[Any], base: Sheet) -> Symmetric:
    """C of a half-space, times 2k: [[2 (1 - nu), -(1 - 2 nu)], [-(1 - 2 nu), 2 (1 - nu)]]/G."""
    one, nu = np.ones_like(wavenumber) / base.shear_modulus, base.poissons_ratio
    return Symmetric(2 * (1 - nu) * one, -(1 - 2 * nu) * one, 2 * (1 - nu) * one)


def _uniaxial_compliance(sheet: Sheet) -> float:
    nu = sheet.poissons_ratio
    return (1 - 2 * nu) / (2 * sheet.shear_modulus * (1 - nu))


def _free_groups(kernel: StackKernel) -> list[list[Sheet]]:
    """Groups of bonded layers that a frictionless face lets slide."""
    groups: list[list[Sheet]] = [[]]
    for sheet in kernel.sheets:
        groups[-1].append(sheet)
        if sheet.slips_below:
            groups.append([])
    return groups[:-1]


def _sideways(group: list[Sheet]) -> float:
    """(sum m_i h_i)^2/(sum E*_i h_i), m = nu/(1 - nu)."""
    push = sum(one.poissons_ratio / (1 - one.poissons_ratio) * one.thickness for one in group)
    return push**2 / sum(one.plane_modulus * one.thickness for one in group)

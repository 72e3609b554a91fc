"""Stacks of layers in wave number space: a recursion upwards for the surface, and one downwards for the inside.

With u_r = int U J1(kr) k dk, u_z = int W J0 k dk, sigma_rz = -int Q J1 k dk and sigma_zz = -int P J0 k dk, the material
below a plane has a symmetric positive compliance C: 2 G k (U, W) = C (Q, P). One layer with q = k h obeys

    v_top = N t_top + A v_bottom,    t_bottom = A^T t_top - K v_bottom,        v = 2 G k (U, W), t = (Q, P)

On top of the compliance C it gives C_top = N + A M A^T, M = (C^-1 + K)^-1 (Redheffer's star product, as for waves in
stratified media). Downwards b = A^T t_top, v_bottom = M b, t_bottom = b - K v_bottom. All are sums of positive decaying
terms, so nothing overflows or cancels. For the surface chi = C_WW/(2 (1 - nu)), of which Eqs. (29) and (31) are the
cases of one layer. Matrices have the shape (2, 2, n), rows and columns in the order U, W. Kernels of all kinds of
layers have `longest`, `tail`, `chi`, `one_minus_chi` and `descent`.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial, inf
from typing import Any, ClassVar, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import NDArray

from contact.records.validation import FloatArray

Matrix: TypeAlias = NDArray[Any]
# q up to which differences of hyperbolic functions are computed by series; with half of it they lose two digits by
# cancellation, with twice of it by truncation.
_SERIES = 1.5
# Coefficients of these series: the error at `_SERIES` is 1e-20 with 17, 1e-7 with half as many.
_ODD, _EVEN = ([1 / factorial(2 * k + first) for k in range(17)] for first in (3, 4))
# Relative distance within which a depth is at an interface: rounding errors of a sum of thicknesses, and of the unit.
_ROUNDINGS = 32.0 * float(np.finfo(float).eps)


class Transfer(NamedTuple):
    """U and W times 2 G k, G at that depth, and Q and P, at m depths under a unit pressure on the surface, (m, n)."""

    radial: NDArray[Any]
    axial: NDArray[Any]
    shear: NDArray[Any]
    normal: NDArray[Any]


class Material(NamedTuple):
    """Material at depths of one layer: G over that of the surface, nu, d ln G/dz, d nu/dz, and whether it is on top."""

    shear_modulus: FloatArray | float
    poissons_ratio: FloatArray | float
    stiffens: FloatArray | float
    turns: FloatArray | float
    is_top: bool


def symmetric(uu: Any, uw: Any, ww: Any) -> Matrix:
    """Symmetric 2 x 2 matrix of its entries, shape (2, 2, ..)."""
    return np.array([[uu, uw], [uw, ww]])


def half_space(nu: float, k: NDArray[Any]) -> Matrix:
    """C of a half-space, shape (2, 2, n); the same for all k."""
    return np.asarray(np.multiply.outer(symmetric(2 * (1 - nu), 2 * nu - 1, 2 * (1 - nu)), np.ones_like(k)))


def half_space_at(
    q: FloatArray, nu: float, shear: FloatArray | float = 0.0, normal: FloatArray | float = 1.0
) -> Transfer:
    """Transfer functions in a half-space at q = k z under tractions `shear` (Q) and `normal` (P) of its surface."""
    Q = ((1 - q) * shear + q * normal) * np.exp(-q)
    P = ((1 + q) * normal - q * shear) * np.exp(-q)
    c, s = 2 * (1 - nu), 2 * nu - 1
    return Transfer(c * Q + s * P, s * Q + c * P, Q, P)


class Step(NamedTuple):
    """Matrices of one layer for the recursion, each of shape (2, 2, n).

    Attributes:
        glued: N, compliance of the upper face if the lower one is bonded to a rigid base.
        beyond: N minus the compliance of the half-space, which decreases exponentially with q.
        free: K, stiffness of the lower face if the upper one is free of tractions.
        free_determinant: det K, shape (n,).
        through: A, rows at the upper, columns at the lower face.
    """

    glued: Matrix
    beyond: Matrix
    free: Matrix
    free_determinant: NDArray[Any]
    through: Matrix

    @classmethod
    def of(cls, q: NDArray[Any], nu: float) -> Step:
        """Matrices of a layer at q = k h; numerators and denominators are multiplied by exp(-2q), in A by exp(-q)."""
        kap, eta, beta = 3 - 4 * nu, 1 - 2 * nu, 1 - nu
        root = np.exp(-q)
        e, qe = root**2, q * root
        linear, square, ss = qe * root, qe**2, np.expm1(-2 * q) ** 2 / 4
        excess, excess_of_squares = _differences(q, e)
        d = kap * (1 + e) ** 2 / 4 + eta**2 * e + square
        even = kap * (1 + e) / 2 * e + eta**2 * e + square
        c, s = 2 * beta * root * (1 + e) / 2, -np.expm1(-2 * q) / 2
        glued = symmetric(
            2 * beta * (kap * excess + (kap + 1) * linear),
            square - eta * kap * ss,
            2 * beta * (kap * excess + 2 * eta * linear),
        )
        beyond = -2 * beta * symmetric(even - linear, -square - 2 * beta * eta * e, even + linear)
        free = symmetric(2 * beta * (excess + 2 * linear), -(eta * ss + square), 2 * beta * excess)
        off, turned = qe * (1 + e) / 2, eta * root * s
        through = 2 * beta / d * np.array([[c - qe * s, -off - turned], [off - turned, c + qe * s]])
        return cls(glued / d, beyond / d, free / d, excess_of_squares / d, through)

    def joined(self, below: Matrix, *, slips: bool) -> Matrix:
        """M = (C^-1 + K)^-1, compliance of the interface; with `slips` it transmits pressure only."""
        (uu, uw), (_, ww), K = *below, self.free
        adjoint = symmetric(K[1, 1], -K[0, 1], K[0, 0])
        if slips:
            pressed = ww * adjoint
            pressed[0, 0] += 1
            return np.asarray(pressed / (K[0, 0] + ww * self.free_determinant))
        det = uu * ww - uw**2
        return np.asarray((below + det * adjoint) / (1 + (K * below).sum(axis=(0, 1)) + self.free_determinant * det))

    def on_top(self, compliance: Matrix, below: Matrix, *, slips: bool) -> Matrix:
        """C of the upper face: `compliance`, which is N or N minus that of the half-space, plus A M A^T."""
        M = self.joined(below, slips=slips)
        return np.asarray(compliance + np.einsum("ij...,jk...,lk...->il...", self.through, M, self.through))

    def down(self, below: Matrix, shear: FloatArray, normal: FloatArray, *, slips: bool) -> Transfer:
        """Transfer functions at the lower face from tractions Q and P of the upper face."""
        b = self.through[0] * shear + self.through[1] * normal
        v = np.einsum("ij...,j...->i...", self.joined(below, slips=slips), b)
        return Transfer(*v, *(b - np.einsum("ij...,j...->i...", self.free, v)))


def _differences(q: NDArray[Any], e: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """(sinh 2q - 2q)/2 and sinh^2 q - q^2, both times e = exp(-2q), by series where they would cancel."""
    small = np.abs(q) < _SERIES
    t = np.where(small, 2 * q, 0)
    odd, even = (polyval(t * t, np.array(series)) for series in (_ODD, _EVEN))
    far = np.where(small, 1, q)
    faded = np.where(small, 0, far * np.exp(-far))
    first = np.where(small, t**3 * odd * e / 2, -np.expm1(-4 * far) / 4 - faded * np.exp(-far))
    second = np.where(small, t**4 * even * e / 2, np.expm1(-2 * far) ** 2 / 4 - faded**2)
    return first, second


@dataclass(frozen=True)
class Sheet:
    """One uniform layer in units of the first one.

    Attributes:
        thickness: h_i over the first layer's.
        shear_modulus: G_i over the first layer's.
        poissons_ratio: nu_i.
        slips_below: Whether the interface below is frictionless.
    """

    thickness: float
    shear_modulus: float
    poissons_ratio: float
    slips_below: bool


@dataclass(frozen=True)
class StackKernel:
    """Kernel of layers on a rigid base or on an elastic half-space; without layers, of the half-space.

    Attributes:
        sheets: Layers from the top.
        base: The half-space below, of infinite thickness; None for a rigid base.
    """

    sheets: tuple[Sheet, ...]
    base: Sheet | None

    @classmethod
    def single(cls, support: str, nu: float) -> StackKernel:
        """One layer, "bonded" or "unbonded" to a rigid base."""
        return cls((Sheet(1.0, 1.0, nu, support == "unbonded"),), None)

    # c_1, c_2, .. of 1 - chi ~ sum c_j/k^j for large k: none, 1 - chi falls exponentially.
    tail: ClassVar[tuple[float, ...]] = ()

    @property
    def is_half_space(self) -> bool:
        """Whether there are no layers on the base."""
        return not self.sheets

    @property
    def poissons_ratio(self) -> float:
        """Poisson's ratio of the surface material."""
        return (*self.sheets, self.base)[0].poissons_ratio  # type: ignore[union-attr]

    @property
    def longest(self) -> float:
        """Length L over h: for k < 1/L chi has its limit for small k. Total thickness times ratio of extreme moduli."""
        stiffness = [sheet.shear_modulus for sheet in (*self.sheets, *([self.base] if self.base else []))]
        total = sum(sheet.thickness for sheet in self.sheets)
        return total * max(stiffness) / min(stiffness) if self.sheets else 1.0

    def chi(self, k: NDArray[Any]) -> NDArray[Any]:
        """chi at wave numbers k, real or with Re k > 0, any shape."""
        return np.asarray(self._surface(k, "glued")[1, 1] / (2 * (1 - self.poissons_ratio)))

    def one_minus_chi(self, k: NDArray[Any]) -> NDArray[Any]:
        """1 - chi, also where it is exponentially small."""
        return np.asarray(-self._surface(k, "beyond")[1, 1] / (2 * (1 - self.poissons_ratio)))

    def beyond_half_space(self, k: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
        """Entries UU, UW, WW of C minus that of the half-space of the surface material, each of the shape of k."""
        (uu, uw), (_, ww) = self._surface(k, "beyond")
        return uu, uw, ww

    def _surface(self, k: NDArray[Any], part: Literal["glued", "beyond"]) -> Matrix:
        """C of the surface, or with "beyond" C minus that of the half-space."""
        if not self.sheets:
            C = half_space(self.poissons_ratio, k)
            return C if part == "glued" else 0 * C
        top = self.sheets[0]
        step = Step.of(top.thickness * k, top.poissons_ratio)
        return step.on_top(getattr(step, part), self.below(k)[0], slips=top.slips_below)

    def below(self, k: NDArray[Any]) -> list[Matrix]:
        """C of the material below each layer, from the top, made dimensionless with the modulus of that layer."""
        C = half_space(self.base.poissons_ratio, k) if self.base else np.zeros((2, 2, *np.shape(k)))
        unit, compliances = self.base.shear_modulus if self.base else 1.0, []
        for sheet in reversed(self.sheets):
            C = C * (sheet.shear_modulus / unit)
            compliances.append(C)
            if len(compliances) < len(self.sheets):
                step = Step.of(sheet.thickness * k, sheet.poissons_ratio)
                C = step.on_top(step.glued, C, slips=sheet.slips_below)
            unit = sheet.shear_modulus
        return compliances[::-1]

    def descent(self, k: FloatArray) -> StackDescent:
        """Transfer functions to the inside at wave numbers k, shape (n,)."""
        return StackDescent(self, k)


class StackDescent:
    """Transfer functions from a unit pressure of wave numbers k > 0, shape (n,), on the surface into a stack.

    Depths are over the thickness of the first layer. Depths with the same number `places` are evaluated together.
    """

    def __init__(self, kernel: StackKernel, k: FloatArray) -> None:
        self.kernel, self.k = kernel, k
        self._below = kernel.below(k)
        self._faces = np.cumsum([sheet.thickness for sheet in kernel.sheets])
        self._tops = np.concatenate([[0.0], self._faces])
        self._loads = [(np.zeros_like(k), np.ones_like(k))]
        for sheet, below in zip(kernel.sheets, self._below, strict=True):
            step = Step.of(sheet.thickness * k, sheet.poissons_ratio)
            self._loads.append(step.down(below, *self._loads[-1], slips=sheet.slips_below)[2:])

    def places(self, z: FloatArray) -> NDArray[np.intp]:
        """Twice the index of the layer that contains each depth, plus one on the lower face of that layer.

        Depths within rounding of an interface are at the interface, which belongs to the upper layer.
        """
        layer = np.searchsorted(self._faces * (1 + _ROUNDINGS), z)
        if self.kernel.base is None:
            layer = np.minimum(layer, self._faces.size - 1)
        return 2 * layer + (z >= np.append(self._faces, inf)[layer] * (1 - _ROUNDINGS))

    def material(self, place: int, z: FloatArray) -> Material:
        """Material at depths z with the number `place`."""
        sheet = (*self.kernel.sheets, self.kernel.base)[place // 2]
        assert sheet is not None
        return Material(sheet.shear_modulus, sheet.poissons_ratio, 0.0, 0.0, place < 2)

    def at(self, place: int, z: FloatArray) -> Transfer:
        """Transfer functions, arrays of shape (m, n), at depths z of shape (m, 1) with the number `place`."""
        number, on_face = divmod(place, 2)
        depth, load = self.k * (z - self._tops[number]), self._loads[number]
        if number == len(self.kernel.sheets):
            assert self.kernel.base is not None
            return half_space_at(depth, self.kernel.base.poissons_ratio, *load)
        sheet, below = self.kernel.sheets[number], self._below[number][:, :, None]
        upper, slips = Step.of(depth, sheet.poissons_ratio), sheet.slips_below
        if not on_face:
            rest = Step.of(self.k * (self._faces[number] - z), sheet.poissons_ratio)
            below, slips = rest.on_top(rest.glued, below, slips=slips), False
        return upper.down(below, *load, slips=slips)

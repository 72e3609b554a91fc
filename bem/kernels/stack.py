"""Layers on top of each other in wave number space: one recursion upwards for the surface, downwards for the inside.

With u_r = int U J1(kr) k dk, u_z = int W J0 k dk, sigma_rz = -int Q J1 k dk and sigma_zz = -int P J0 k dk all
that lies below a plane is a compliance C: 2 G k (U, W) = C (Q, P), symmetric and positive. One layer with q = k h,

    v_top = N t_top + A v_bottom,    t_bottom = A^T t_top - K v_bottom,        v = 2 G k (U, W), t = (Q, P)

adds itself to what lies below by C_top = N + A M A^T, M = (C^-1 + K)^-1 (Redheffer's star product, as for waves in
stratified media). Downwards b = A^T t_top, v_bottom = M b, t_bottom = b - K v_bottom. All are sums of positive terms
that fade: nothing grows, nothing cancels. The surface answers with chi = C_WW/(2 (1 - nu)), of which Eqs. (29) and (31)
are the cases of one layer. Matrices have the shape (2, 2, n), rows and columns in the order U, W. Kernels
of all kinds of layers have `longest`, `tail`, `chi`, `one_minus_chi` and `descent`.
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
# q up to which differences of hyperbolic functions are summed as series; with half of it they lose two digits, with
# twice of it the series does.
_SERIES = 1.5
# Their terms: 17 leave 1e-20 at `_SERIES`, half as many 1e-7.
_ODD, _EVEN = ([1 / factorial(2 * k + first) for k in range(17)] for first in (3, 4))
# Roundings of a depth within which it lies at an interface: one for each of some thicknesses, and two of the unit.
_ROUNDINGS = 32.0 * float(np.finfo(float).eps)


class Transfer(NamedTuple):
    """At one depth under a unit pressure of the surface: U and W times 2 G k of the material there, Q and P."""

    radial: NDArray[Any]
    axial: NDArray[Any]
    shear: NDArray[Any]
    normal: NDArray[Any]


class Material(NamedTuple):
    """At some depths of one layer: G over the surface's, nu, d ln G/dz, d nu/dz, and whether it is the top one."""

    shear_modulus: FloatArray | float
    poissons_ratio: FloatArray | float
    stiffens: FloatArray | float
    turns: FloatArray | float
    is_top: bool


def symmetric(uu: Any, uw: Any, ww: Any) -> Matrix:
    """A symmetric matrix by its entries."""
    return np.array([[uu, uw], [uw, ww]])


def half_space(nu: float, k: NDArray[Any]) -> Matrix:
    """C of a half-space."""
    return np.asarray(np.multiply.outer(symmetric(2 * (1 - nu), 2 * nu - 1, 2 * (1 - nu)), np.ones_like(k)))


def half_space_at(
    q: FloatArray, nu: float, shear: FloatArray | float = 0.0, normal: FloatArray | float = 1.0
) -> Transfer:
    """The inside of a half-space under tractions of its surface, at q = k z."""
    Q = ((1 - q) * shear + q * normal) * np.exp(-q)
    P = ((1 + q) * normal - q * shear) * np.exp(-q)
    c, s = 2 * (1 - nu), 2 * nu - 1
    return Transfer(c * Q + s * P, s * Q + c * P, Q, P)


class Step(NamedTuple):
    """One layer.

    Attributes:
        glued: N, its compliance on a rigid base.
        beyond: N less the compliance of the half-space, which falls exponentially.
        free: K, the stiffness of its lower face under a free top.
        free_determinant: det K.
        through: A by row at the top and column at the bottom.
    """

    glued: Matrix
    beyond: Matrix
    free: Matrix
    free_determinant: NDArray[Any]
    through: Matrix

    @classmethod
    def of(cls, q: NDArray[Any], nu: float) -> Step:
        """The layer of nu at q = k h; numerators and denominators times exp(-2q), in A times exp(-q)."""
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
        """M = (C^-1 + K)^-1, compliance of the lower face; across a frictionless interface passes pressure only."""
        (uu, uw), (_, ww), K = *below, self.free
        adjoint = symmetric(K[1, 1], -K[0, 1], K[0, 0])
        if slips:
            pressed = ww * adjoint
            pressed[0, 0] += 1
            return np.asarray(pressed / (K[0, 0] + ww * self.free_determinant))
        det = uu * ww - uw**2
        return np.asarray((below + det * adjoint) / (1 + (K * below).sum(axis=(0, 1)) + self.free_determinant * det))

    def on_top(self, compliance: Matrix, below: Matrix, *, slips: bool) -> Matrix:
        """C of the upper face: N, or what is asked of it instead, and A M A^T of the layers below."""
        M = self.joined(below, slips=slips)
        return np.asarray(compliance + np.einsum("ij...,jk...,lk...->il...", self.through, M, self.through))

    def down(self, below: Matrix, shear: FloatArray, normal: FloatArray, *, slips: bool) -> Transfer:
        """The lower face under tractions of the upper one."""
        b = self.through[0] * shear + self.through[1] * normal
        v = np.einsum("ij...,j...->i...", self.joined(below, slips=slips), b)
        return Transfer(*v, *(b - np.einsum("ij...,j...->i...", self.free, v)))


def _differences(q: NDArray[Any], e: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """(sinh 2q - 2q)/2 and sinh^2 q - q^2, times e = exp(-2q): series of positive terms where they cancel."""
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
        slips_below: Whether its lower face slides without friction.
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
        """Whether there is nothing but the base."""
        return not self.sheets

    @property
    def poissons_ratio(self) -> float:
        """Poisson's ratio of the surface material."""
        return (*self.sheets, self.base)[0].poissons_ratio  # type: ignore[union-attr]

    @property
    def longest(self) -> float:
        """Length over h beyond which chi has its limit for small k: the total thickness; of stiff films (E1/E2) h."""
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
        """C less that of the half-space of the surface material: its entries UU, UW, WW."""
        (uu, uw), (_, ww) = self._surface(k, "beyond")
        return uu, uw, ww

    def _surface(self, k: NDArray[Any], part: Literal["glued", "beyond"]) -> Matrix:
        """C of the surface, or with "beyond" C less that of the half-space."""
        if not self.sheets:
            C = half_space(self.poissons_ratio, k)
            return C if part == "glued" else 0 * C
        top = self.sheets[0]
        step = Step.of(top.thickness * k, top.poissons_ratio)
        return step.on_top(getattr(step, part), self.below(k)[0], slips=top.slips_below)

    def below(self, k: NDArray[Any]) -> list[Matrix]:
        """C of all that lies below each layer, in units of that layer."""
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
        """The inside at wave numbers k, shape (n,)."""
        return StackDescent(self, k)


class StackDescent:
    """The inside of a stack under a unit pressure of wave numbers k > 0, shape (n,), on the surface.

    Depths count in thicknesses of the first layer. `places` numbers the parts: depths of one part are asked together.
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
        """Twice the number of the layer that holds each depth, and one more on its lower face.

        A depth that differs from a sum of thicknesses by roundings lies at the interface, which is the upper layer's.
        """
        layer = np.searchsorted(self._faces * (1 + _ROUNDINGS), z)
        if self.kernel.base is None:
            layer = np.minimum(layer, self._faces.size - 1)
        return 2 * layer + (z >= np.append(self._faces, inf)[layer] * (1 - _ROUNDINGS))

    def material(self, place: int, z: FloatArray) -> Material:
        """Material at depths z of one place."""
        sheet = (*self.kernel.sheets, self.kernel.base)[place // 2]
        assert sheet is not None
        return Material(sheet.shear_modulus, sheet.poissons_ratio, 0.0, 0.0, place < 2)

    def at(self, place: int, z: FloatArray) -> Transfer:
        """Transfer functions at depths z of one place, shape (m, 1): arrays of shape (m, n)."""
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

"""Layers whose constants change with depth: Riccati's equation of the reflection, integrated upwards and downwards.

At every depth the field is the sum of waves of the local half-space that decay downwards, with tractions d, and waves
that decay upwards, with tractions g = R d: t = d + g and 2 G k (U, W) = C_0 d - C_0~ g. C_0 is the compliance of the
half-space, C_0~ has the other sign off the diagonal. C_0 + C_0~ = 4 beta, beta = 1 - nu. So

    C = C_0 - 4 beta S,   S = R (1 + R)^-1,   1 - chi = 2 S_WW at the surface.

With L = [[2, 1], [-1, 0]], gamma = G'/G, f = -(beta gamma + nu')/(2 beta), h = ((1 - 2 nu) gamma + 2 nu')/(4 beta) and
F = [[f, h], [h, f]],

    R' = k (L R + R L^T) + (1 + R) F (1 + R) + (gamma + nu'/beta) (R + R^2)

which is linear where the material is uniform, bounded for every base (a frictionless one has R_UU = -1), and integrated
upwards, where errors decay like exp(-2kz). R and 1 - chi ~ c_1/k are accurate relative to their size for large k.
Downwards d' = -k L^T d + (gamma (C_0 - C_0~ R) - 2 nu' J (1 + R)) d/(4 beta) + (nu'/beta) d, J = ones. Lengths are over
the thickness.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from bem.kernels.stack import Material, Transfer, half_space
from bem.numerics import WAVES, Octaves, barycentric
from contact.records.errors import NotConvergedError
from contact.records.validation import FloatArray
from contact.scene.graded_layer import GradedLayer
from contact.scene.layer import ElasticBase

# Depth times |k| below which the layer has no influence: exp(-2 DEEP cos(15 degrees)) is 1e-17, with half of it 1e-9.
DEEP = 21.0
# Depth times k down to which fields inside are integrated: exp(-43) is negligible, at half of it exp(-21) is not.
# `_FADED` + `DEEP` is a power of two, so that in an octave all waves reach the base or none does.
_FADED = 43.0
# Relative and absolute tolerance of the integration; ten times as much costs a digit and saves a tenth of the time.
TOLERANCE, ABSOLUTE = 1e-13, 1e-15
# Chebyshev nodes over the depth between two breakpoints: exp(-61 z) is resolved by 64 to 1e-14, by 32 to 1e-5.
_NODES = 64
# Least wave number of the fit of c_2, c_3, ..: half has ten times the error, twice has larger rounding errors.
_FAR = 80.0
_SHARES = (1 - np.cos(np.pi * np.arange(1, 2 * _NODES, 2) / (2 * _NODES))) / 2
_WEIGHTS = barycentric(_SHARES)

# The solution as a function of s in [0, 1], the fraction of the interval; and dy/dz as a function of s, z and y.
_Followed: TypeAlias = Callable[[float], NDArray[Any]]
_Rate: TypeAlias = Callable[[float, FloatArray, NDArray[Any]], NDArray[Any]]


class _Local(NamedTuple):
    """nu, d nu/dz and d ln G/dz at depths."""

    nu: NDArray[Any]
    turns: NDArray[Any]
    stiffens: NDArray[Any]

    @classmethod
    def at(cls, layer: GradedLayer, z: NDArray[Any]) -> _Local:
        """Local constants of a layer at depths z."""
        nu, turns, modulus = layer.ratio_at(z), layer.ratio_slope(z), layer.youngs_modulus
        return cls(nu, turns, modulus.slope(z, 1.0) / modulus.at(z, 1.0) - turns / (1 + nu))


@dataclass(frozen=True)
class GradedKernel:
    """Kernel of a graded layer, lengths in units of its thickness.

    Attributes:
        layer: The layer, of thickness 1 and with E* = 1 at the surface.
    """

    layer: GradedLayer

    @property
    def longest(self) -> float:
        """Length over which a load spreads, at least the thickness: the ratio of the largest modulus to the least."""
        moduli, base = self.layer.youngs_modulus.at(np.linspace(0.0, 1.0, 257), 1.0), self.layer.support
        if isinstance(base, ElasticBase):
            moduli = np.append(moduli, base.youngs_modulus)
        return float(moduli.max() / moduli.min())

    @cached_property
    def tail(self) -> tuple[float, ...]:
        """c_1, c_2, .. of 1 - chi ~ sum c_j/k^j for large k.

        c_1 = [(2 - nu) G'/G + nu']/(2 (1 - nu)) at the surface; the others are fitted.
        """
        nu, turns, stiffens = (float(value) for value in _Local.at(self.layer, np.array(0.0)))
        first = ((2 - nu) * stiffens + turns) / (2 * (1 - nu))
        x = np.cos(np.linspace(0.0, np.pi / 2.4, 24)) / _FAR
        rest = self.one_minus_chi(1 / x) - first * x
        fitted = np.linalg.lstsq((x[:, None] * _FAR) ** np.arange(2, 12), rest, rcond=None)[0]
        return (first, *(fitted * _FAR ** np.arange(2.0, 12))[:4].tolist())

    def __getstate__(self) -> dict[str, Any]:
        """State without tables, which are computed again when needed."""
        return {"layer": self.layer}

    def chi(self, k: NDArray[Any]) -> NDArray[Any]:
        """chi at wave numbers k > 0 or 0 <= arg k < pi/2, any shape."""
        return np.asarray(1 - self.one_minus_chi(k))

    def one_minus_chi(self, k: NDArray[Any]) -> NDArray[Any]:
        """1 - chi at wave numbers k, any shape, accurate relative to its size also for large k."""
        R = self.reflection(np.ravel(k), DEEP)[0](0.0)
        return np.asarray(2 * _unreflected(R)[1]).reshape(np.shape(k))

    def reflection(self, k: NDArray[Any], deep: float) -> list[_Followed]:
        """R_UU, R_UW, R_WW, shape (3, k.size), integrated upwards from the base, or from k z = `deep`.

        Returns:
            For each stretch between breakpoints, the top first, R as a function of s, 0 at its top and 1 at its bottom.
        """
        start = np.minimum(1.0, deep / np.abs(k))
        R = np.where(start < 1.0, 0.0, self._at_base(k))
        reflections: list[_Followed] = []
        for low, high in self.stretches(start)[::-1]:
            upwards = _integrated(partial(self._slope, k), R, high, low)
            reflections.append(lambda share, upwards=upwards: upwards(1.0 - share))  # type: ignore[misc]
            R = upwards(1.0)
        return reflections[::-1]

    def stretches(self, start: FloatArray) -> list[tuple[FloatArray, FloatArray]]:
        """Beginnings and ends of depths between breakpoints, down to `start`, shape (n,) each."""
        ends = [0.0, *self.layer.breakpoints, 1.0]
        return [
            (np.minimum(low, start), np.minimum(high, start)) for low, high in pairwise(ends) if np.any(low < start)
        ]

    def _at_base(self, k: NDArray[Any]) -> NDArray[Any]:
        """R = 4 beta (C + C_0~)^-1 - 1 at the base."""
        nu, base = float(self.layer.ratio_at(1.0)), self.layer.support
        diagonal, side, face = 2 * (1 - nu), 1 - 2 * nu, base
        if isinstance(base, ElasticBase):
            G = float(self.layer.youngs_modulus.at(1.0, 1.0)) / (1 + nu)
            softer = G * (1 + base.poissons_ratio) / base.youngs_modulus
            (uu, uw), _ = softer * half_space(base.poissons_ratio, np.ones(()))
            diagonal, side, face = diagonal + uu, side + uw, base.interface
        size = 4 * (1 - nu) / (diagonal**2 - side**2)
        bonded, slips = (
            (size * diagonal - 1, -size * side, size * diagonal - 1),
            (-1.0, 0.0, 4 * (1 - nu) / diagonal - 1),
        )
        return np.outer(bonded if face == "bonded" else slips, np.ones_like(k))

    def _slope(self, k: NDArray[Any], _: float, z: FloatArray, R: NDArray[Any]) -> NDArray[Any]:
        """dR/dz, shape (3, n)."""
        uu, uw, ww = R
        nu, turns, stiffens = _Local.at(self.layer, z)
        beta = 1 - nu
        f, h = -(beta * stiffens + turns) / (2 * beta), ((1 - 2 * nu) * stiffens + 2 * turns) / (4 * beta)
        grows, a, b = stiffens + turns / beta, 1 + uu, 1 + ww
        return np.array(
            [
                k * (4 * uu + 2 * uw) + f * (a * a + uw * uw) + 2 * h * a * uw + grows * (uu * a + uw * uw),
                k * (2 * uw + ww - uu) + f * uw * (a + b) + h * (a * b + uw * uw) + grows * uw * (a + ww),
                -2 * k * uw + f * (b * b + uw * uw) + 2 * h * b * uw + grows * (ww * b + uw * uw),
            ]
        )

    def descent(self, k: FloatArray) -> GradedDescent:
        """Transfer functions to the inside at wave numbers k, shape (n,)."""
        return GradedDescent(self, k)

    @cached_property
    def transfers(self) -> Octaves:
        """Interpolation over octaves of k of U, W, Q, P times exp(kz), shape (n, fields x stretches x nodes of z)."""
        lowest = -2 - int(np.ceil(np.log2(self.longest)))
        return Octaves(lambda k, _: self._transferred(k), lowest, WAVES)

    def _transferred(self, k: FloatArray) -> FloatArray:
        """Values of `transfers` at wave numbers k, shape (n,); zero on stretches that the waves do not reach."""
        reflected = self.reflection(k, _FADED + DEEP)
        stretches = self.stretches(np.minimum(1.0, (_FADED + DEEP) / k))
        transfers = np.zeros((k.size, 4, len(self.layer.breakpoints) + 1, _NODES))
        uw, ww = _unreflected(reflected[0](0.0))
        d = np.array([-uw, 1 - ww])  # (1 + R)^-1 (0, 1)
        for number, ((low, high), R) in enumerate(zip(stretches, reflected, strict=True)):
            downwards = _integrated(partial(self._fading, k, R), d, low, high)
            for i, share in enumerate(_SHARES.tolist()):
                nu = self.layer.ratio_at(low + (high - low) * share)
                transfers[:, :, number, i] = np.transpose(_fields(nu, R(share), downwards(share)))
            d = downwards(1.0)
        return transfers.reshape(k.size, -1)

    def _fading(self, k: FloatArray, R: _Followed, share: float, z: FloatArray, d: FloatArray) -> FloatArray:
        """d/dz of d exp(kz)."""
        nu, turns, stiffens = _Local.at(self.layer, z)
        u, w, q, p = _fields(nu, R(share), d)
        both = k * (d[1] - d[0]) - 2 * turns * (q + p) / (4 * (1 - nu))
        return np.asarray(both + stiffens * np.array([u, w]) / (4 * (1 - nu)) + turns / (1 - nu) * d)


class GradedDescent:
    """Transfer functions from a unit pressure of wave numbers k > 0, shape (n,), on the surface into a graded layer."""

    def __init__(self, kernel: GradedKernel, k: FloatArray) -> None:
        self.kernel, self.k = kernel, k
        self._ends = np.array([0.0, *kernel.layer.breakpoints, 1.0])
        self._rows = np.empty((k.size, 4, self._ends.size - 1, _NODES))
        for octave, index in kernel.transfers.groups(k):
            self._rows[index] = kernel.transfers(k[index], octave).reshape(-1, *self._rows.shape[1:])

    def places(self, z: FloatArray) -> NDArray[np.intp]:
        """Number of the part of the layer at depths z, as in `StackDescent`: always zero."""
        return np.zeros(z.shape, dtype=np.intp)

    def material(self, place: int, z: FloatArray) -> Material:
        """Constants of the material at depths z."""
        layer = self.kernel.layer
        nu, turns, stiffens = _Local.at(layer, z)
        modulus = layer.youngs_modulus.at(z, 1.0) / float(layer.youngs_modulus.at(0.0, 1.0))
        return Material(modulus * (1 + float(layer.ratio_at(0.0))) / (1 + nu), nu, stiffens, turns, is_top=True)

    def at(self, place: int, z: FloatArray) -> Transfer:
        """Transfer functions at depths z of shape (m, 1), each of shape (m, n)."""
        return Transfer(*np.stack([self._at(depth) for depth in z.ravel().tolist()], axis=1))

    def _at(self, z: float) -> FloatArray:
        """Transfer functions U, W, Q, P at one depth, shape (4, n)."""
        i = min(max(int(np.searchsorted(self._ends, z)) - 1, 0), self._ends.size - 2)
        low = self._ends[i]
        high = np.minimum(self._ends[i + 1], np.maximum((_FADED + DEEP) / self.k, low + 1e-9))
        gap = np.clip((z - low) / (high - low), 0.0, 1.0)[:, None] - _SHARES
        weights = _WEIGHTS / np.where(gap == 0, 1e-200, gap)
        values = np.einsum("ks,kfs->fk", weights, self._rows[:, :, i]) / weights.sum(axis=1)
        return np.asarray(values * np.where(self.k * z < _FADED, np.exp(-self.k * z), 0.0))


def _unreflected(R: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Entries UW and WW of S = R (1 + R)^-1."""
    uu, uw, ww = R
    det = (1 + uu) * (1 + ww) - uw**2
    return uw / det, (ww * (1 + uu) - uw**2) / det


def _fields(nu: FloatArray, R: FloatArray, d: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """2 G k U, 2 G k W, Q and P of the waves with tractions d downwards and g = R d upwards."""
    g = R[0] * d[0] + R[1] * d[1], R[1] * d[0] + R[2] * d[1]
    difference, total, eta = d - np.array(g), d + np.array(g), 1 - 2 * nu
    u, w = 2 * (1 - nu) * difference
    return u - eta * total[1], w - eta * total[0], total[0], total[1]


def _integrated(rate: _Rate, start: NDArray[Any], begin: FloatArray, end: FloatArray) -> _Followed:
    """Solve dy/dz = rate(s, z, y) for all wave numbers together; returns y(s), s the fraction from `begin` to `end`.

    Raises:
        NotConvergedError: If the tolerance is not met.
    """

    def slope(share: float, y: NDArray[Any]) -> NDArray[Any]:
        z = begin + (end - begin) * share
        return np.ravel((end - begin) * rate(share, z, y.reshape(start.shape)))

    solution = solve_ivp(slope, (0.0, 1.0), start.ravel(), "DOP853", dense_output=True, rtol=TOLERANCE, atol=ABSOLUTE)
    values = solution.sol
    if not solution.success or values is None:
        raise NotConvergedError(f"the graded layer was not integrated over its depth: {solution.message}")
    return lambda s: np.asarray(values(s).reshape(start.shape))

"""Displacement of cell centres by a uniform pressure on one square cell, for every kind of layer.

Lengths in cell sizes, pressures in units of E* of the material at the surface. With the kernel chi of a layer,

    u(r) = (1/pi) int_cell [1/|r - r'| + V(|r - r'|/h)/h] dA',      V(rho) = int_0^inf (chi(q) - 1) J0(q rho) dq.

The first term is Love's rectangle. The second is smooth where chi - 1 falls exponentially, and logarithmic at the axis
where chi - 1 = c_1/q + ... (graded surfaces). V is a Hankel transform over many orders of magnitude of q, which FFTLog
computes from logarithmically spaced samples of chi (Hamilton 2000, Mon. Not. R. Astron. Soc. 312, 257).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from math import ceil, log, pi
from typing import TYPE_CHECKING, Final

import numpy as np
from scipy.fft import fht, fhtoffset
from scipy.interpolate import CubicSpline
from scipy.special import itj0y0

from bem.grid.transforms import cosine_plan
from bem.kernels.of_layer import surface_kernel
from contact import ElasticLayer
from contact.records.validation import FloatArray

if TYPE_CHECKING:
    from bem.kernels.of_layer import SurfaceKernel

# Wavenumbers q of FFTLog. Half as many samples leave 7e-9 of V, twice as many 1e-9 as these do.
SAMPLES: Final = 1024
LEAST_Q, LARGEST_Q = 1e-9, 1e5
# Exponent of the power of q that damps both ends of the samples: half and twice of it leave 1e-8 of V.
BIAS: Final = -0.25
# Least rho of the smooth part of V, which is even in rho: below it the value at it has an error of 1e-6.
NEAR: Final = 1e-3
# r/h from which on displacements of a layer on a rigid base are zero: exp(-0.739 * 48) = 4e-16.
REACH: Final = 48.0
# k times `longest` at which chi/k is evaluated for k = 0: its error is the square, and half of it changes nothing.
LEAST_SHARE: Final = 1e-12
# Mean of ln r over a unit square about its centre.
MEAN_LOGARITHM: Final = (pi / 2 - 3.0 - log(2.0)) / 2
# Distance from the loaded cell, in cells, within which means over cells are computed by Gauss rules, and half the
# largest number of their points across a cell.
CLOSE: Final = 12
MOST_POINTS: Final = 4.0


@dataclass(frozen=True, eq=False)
class PointResponse:
    """V(rho) of one layer, rho = r/h.

    Attributes:
        smooth: Smooth part of V as a function of ln rho, computed by FFTLog.
        limit: 1 - chi at q = 0, one on a rigid base.
        logarithm: c_1 in chi = 1 + c_1/q + ....
    """

    smooth: Callable[[FloatArray], FloatArray]
    limit: float
    logarithm: float

    def __call__(self, rho: FloatArray) -> FloatArray:
        """V at rho > 0: the smooth part and closed forms of exp(-q) and (1 - exp(-q))/q."""
        near = np.log(np.clip(rho, NEAR, 1e5))
        logarithmic = self.logarithm * np.arcsinh(1.0 / rho) if self.logarithm else 0.0
        return np.asarray(self.smooth(near) - (self.limit + self.logarithm) / np.hypot(1.0, rho) + logarithmic)


@lru_cache(maxsize=32)
def point_response(kernel: SurfaceKernel) -> PointResponse:
    """The function V of a kernel, cached."""
    q = np.geomspace(LEAST_Q, LARGEST_Q, SAMPLES)
    step, less = log(q[1] / q[0]), kernel.one_minus_chi(q)
    limit = float(less[0])
    logarithm = float(-less[-1] * q[-1])
    rest = -less + logarithm * np.expm1(-q) / q + (limit + logarithm) * np.exp(-q)
    offset = fhtoffset(step, 0.0, bias=BIAS)
    rho = np.exp(offset) / q[::-1]
    values = fht(rest, step, 0.0, offset=offset, bias=BIAS) / rho
    return PointResponse(CubicSpline(np.log(rho), values), limit, logarithm)


@lru_cache(maxsize=8)
def rectangle_influence(offsets: int) -> FloatArray:
    """Displacements of a half-space at cell offsets 0 <= i, j <= `offsets` by a unit pressure on a unit cell.

    Love's solution is the second difference over the cell's corners of J = x asinh(y/x) + y asinh(x/y).
    """
    corner = np.arange(offsets + 2) - 0.5
    x, y = corner[:, None], corner[None, :]
    half = x * np.arcsinh(y / np.abs(x))
    return np.asarray(np.diff(np.diff(half + half.T, axis=0), axis=1) / pi)


def layer_influence(offsets: int, layer: ElasticLayer, cell_size: float) -> FloatArray:
    """Displacements of any layer at cell offsets 0 <= i, j <= `offsets` by a unit pressure on one cell."""
    influence = rectangle_influence(offsets)
    if layer.is_half_space:
        return influence
    thickness = layer.surface.thickness / cell_size
    response = point_response(surface_kernel(layer))
    influence = influence + _cell_means(response, offsets, thickness) / (pi * thickness)
    if not layer.has_elastic_base:
        cells = np.arange(offsets + 1)
        influence[np.hypot(cells[:, None], cells) > REACH * thickness + 1.0] = 0.0
    return influence


def _cell_means(response: PointResponse, offsets: int, thickness: float) -> FloatArray:
    """Mean of V over each cell: V + (1/24) of its Laplacian, from differences, and Gauss points close to the load."""
    i, j = np.tril_indices(offsets + 2)
    V = np.empty((offsets + 2, offsets + 2))
    V[i, j] = V[j, i] = response(np.maximum(np.hypot(i, j), 0.5) / thickness)
    W = np.pad(V, ((1, 0), (1, 0)), mode="reflect")
    neighbours = W[2:, 1:-1] + W[:-2, 1:-1] + W[1:-1, 2:] + W[1:-1, :-2]
    means = V[:-1, :-1] + (neighbours - 4.0 * V[:-1, :-1]) / 24.0
    # An even number of points leaves out the centre, where V of a graded layer is infinite.
    points, weights = np.polynomial.legendre.leggauss(2 + 2 * ceil(min(2.0 / thickness, MOST_POINTS)))
    points, weights = points / 2, weights / 2
    near = np.arange(min(offsets, CLOSE) + 1)
    x, y = near[:, None] + points, near[:, None, None, None] + points[:, None]
    values = response(np.hypot(y, x[None, :, None, :]) / thickness)
    means[: near.size, : near.size] = np.einsum("ijkl,k,l", values, weights, weights)
    logarithm = weights @ np.log(np.hypot(points[:, None], points)) @ weights
    means[0, 0] += response.logarithm * (logarithm - MEAN_LOGARITHM)
    return means


def layer_symbol(wavenumber: FloatArray, layer: ElasticLayer, cell_size: float) -> FloatArray:
    """u^/p^ = 2 chi(k h)/k, Eq. (27), at k per cell size; at k = 0 its finite limit on a rigid base, zero otherwise."""
    k = np.where(wavenumber == 0.0, 1.0, wavenumber)
    if layer.is_half_space:
        return np.where(wavenumber == 0.0, 0.0, 2.0 / k)
    h, kernel = layer.surface.thickness / cell_size, surface_kernel(layer)
    # chi/k no longer depends on k.
    least = LEAST_SHARE / kernel.longest
    zero = 0.0 if layer.has_elastic_base else 2.0 * h * float(kernel.chi(np.array([least]))[0]) / least
    values, place = np.unique(k, return_inverse=True)
    grid = np.geomspace(values[0], values[-1] * (1.0 + 1e-12), min(SAMPLES, values.size) + 4)
    chi = CubicSpline(np.log(grid), kernel.chi(grid * h))(np.log(values))[place].reshape(k.shape)
    return np.where(wavenumber == 0.0, zero, 2.0 * chi / k)


def band_limited_influence(offsets: int) -> FloatArray:
    """Displacements of a half-space at offsets 0 <= i, j <= `offsets` by the trigonometric interpolant of a unit load.

    It is the free-space counterpart of the periodic operator. The kernel 1/(pi r) is cut off at a radius R beyond the
    grid, which changes no displacement on the grid and makes the transform (2/k) int_0^(kR) J0(t) dt (Vico, Greengard
    and Ferrando 2016, J. Comput. Phys. 323, 191).
    """
    # With half of the period twice the grid no image of the cut-off kernel reaches back to sqrt(2) offsets.
    half, cut_off = 2 * offsets, 2.0 * offsets
    modes = np.arange(half + 1)
    k = pi / half * np.hypot(modes[:, None], modes)
    k[0, 0] = 1.0
    symbol = 2.0 / k * itj0y0(k * cut_off)[0]
    symbol[0, 0] = 2.0 * cut_off
    cosine_plan(symbol, 1, (0, 1)).execute()
    return np.asarray(symbol[: offsets + 1, : offsets + 1] / (2 * half) ** 2)

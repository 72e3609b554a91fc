"""Displacement at the centre of one square cell under a uniform pressure on another: half-space and layer.

All functions are dimensionless: lengths in units of the cell size, pressures in units of E*. The displacement of a
layer is Love's rectangle solution of the half-space plus a smooth correction,

    u(r) = (1/pi E*) int_cell dA'/|r - r'|  +  (1/pi E*) int_cell V(|r - r'|/h)/h dA',
    V(rho) = int_0^inf (chi(q) - 1) J0(q rho) dq.

chi(q)/q is an even analytic function of q, so the two parts cancel exponentially far away: beyond `REACH` thicknesses
the sum is below 1e-15 of its parts and is set to zero, which also spares the cancellation. (The slowest decay is that
of the bonded incompressible layer, exp(-0.739 r/h): the pole of chi at q = iy with cos y = y.)
"""

from __future__ import annotations

from functools import lru_cache
from math import ceil, isinf
from typing import Final

import numpy as np
import numpy.typing as npt

from bem.grid.transforms import cosine_plan
from bem.kernels.layer import one_minus_kernel, zero_mode
from bem.polynomials.cubics import PiecewiseCubic
from bem.polynomials.gauss import legendre_rule
from contact.answer.compiled_files import compiled
from contact.records.validation import FloatArray
from contact.scene.layer import Support

# Distance r/h beyond which a layer does not answer: exp(-0.739 REACH) is 4e-16.
REACH: Final = 48.0
# From so many cells across a layer on, the correction's Laplacian tells its mean over a cell, to 1.4e-10 of the largest
# influence (nu = 0.3 and 0.5, either support, 2026-11-26).
THICK: Final = 32.0


def rectangle_influence(offsets: int) -> FloatArray:
    """Half-space: displacement at cell offset (i, j) by a unit pressure on one unit cell, E* = 1.

    Love's solution is the second difference over the cell's corners of
    `J(x, y) = x asinh(y/x) + y asinh(x/y)`, the double integral of 1/r. Cancellation grows with the offset r as
    r^2 ln r: about 1e-9 relative at r = 1000, absolutely harmless since the value decays as 1/r.

    Args:
        offsets: Largest offset m.

    Returns:
        Influence [cell sizes], shape (m + 1, m + 1).
    """
    corner = np.arange(offsets + 2) - 0.5
    x, y = corner[:, None], corner[None, :]
    half = x * np.arcsinh(y / np.abs(x))
    antiderivative = half + half.T
    return np.asarray(np.diff(np.diff(antiderivative, axis=0), axis=1) / np.pi)


def layer_influence(offsets: int, thickness: float, support: Support, poissons_ratio: float) -> FloatArray:
    """The same for a layer of `thickness` cell sizes; an infinite thickness gives the half-space.

    Args:
        offsets: Largest offset m.
        thickness: h in cell sizes.
        support: "bonded" or "unbonded".
        poissons_ratio: nu.

    Returns:
        Influence [cell sizes], shape (m + 1, m + 1).
    """
    influence = rectangle_influence(offsets)
    if isinf(thickness):
        return influence
    near = min(offsets, ceil(REACH * thickness) + 1)
    influence[near + 1 :] = influence[:, near + 1 :] = 0.0
    i, j = np.tril_indices(near + 1)
    correction = _cell_average(i, j, thickness, support, poissons_ratio)
    beyond = np.hypot(i, j) > REACH * thickness + 1.0
    total = np.where(beyond, 0.0, influence[i, j] + correction)
    influence[i, j] = influence[j, i] = total
    return influence


def _cell_average(
    i: npt.NDArray[np.intp], j: npt.NDArray[np.intp], thickness: float, support: Support, poissons_ratio: float
) -> FloatArray:
    """Gauss quadrature of V(r/h)/(pi h) over the unit cell at (i, j); more points as the cell outgrows h.

    The mean over a cell many of which span h is V + s^2/24 times its Laplacian.
    """
    smooth, laplacian = _correction_and_laplacian(support, poissons_ratio)
    if thickness >= THICK:
        smooth = PiecewiseCubic(smooth.x, smooth.powers + laplacian.powers / (24.0 * thickness**2))
    points, weights = legendre_rule(1 if thickness >= THICK else 2 + ceil(4.0 / thickness))
    total = np.zeros(i.shape)
    for x, wx in zip(points / 2.0, weights / 2.0, strict=True):
        for y, wy in zip(points / 2.0, weights / 2.0, strict=True):
            rho = np.hypot(i + x, j + y) / thickness
            total += wx * wy * np.where(rho < REACH, smooth(np.minimum(rho, REACH)), -1.0 / np.maximum(rho, 1.0))
    return total / (np.pi * thickness)


def correction_function(support: Support, poissons_ratio: float) -> PiecewiseCubic:
    """V(rho) = int_0^inf (chi(q) - 1) J0(q rho) dq on [0, REACH]."""
    return _correction_and_laplacian(support, poissons_ratio)[0]


@lru_cache(maxsize=32)
def _correction_and_laplacian(support: Support, poissons_ratio: float) -> tuple[PiecewiseCubic, PiecewiseCubic]:
    """V(rho) by Gauss-Legendre with 8 nodes a period of J0, and its Laplacian, in which J0 counts -q^2 times.

    The integral ends at q = 24, where 1 - chi is about 1e-18. The spline's 1200 knots are dense near the axis, which
    makes its error less than 1e-9.
    """
    points, weights = legendre_rule(32)
    largest_q, knots = 24.0, 1200
    panels = ceil(largest_q * REACH / (8.0 * np.pi))
    half = largest_q / (2 * panels)
    q = (half * (2.0 * np.arange(panels)[:, None] + 1.0 + points)).ravel()
    density = np.tile(half * weights, panels) * one_minus_kernel(q, support, poissons_ratio)
    rho = REACH * np.sinh(4.0 * np.linspace(0.0, 1.0, knots)) / np.sinh(4.0)
    j0 = compiled("scipy.special._special_ufuncs", "scipy.special").j0
    waves = j0(rho[:, None] * q)
    return PiecewiseCubic.spline(rho, -waves @ density), PiecewiseCubic.spline(rho, waves @ (q**2 * density))


def uniform_response(support: Support, poissons_ratio: float) -> float:
    """Displacement by a uniform pressure over a whole layer, times E*/(2 h p); zero if bonded and incompressible."""
    return zero_mode(support, poissons_ratio)


def band_limited_influence(offsets: int) -> FloatArray:
    """Half-space: displacement at offset (i, j) by the trigonometric interpolant of a unit pressure at one point.

    This is the free-space partner of the periodic operator, whose symbol is 2/k up to the lattice's largest
    wavenumbers. The kernel 1/(pi r) is cut off at a radius R beyond the grid, which makes its transform the smooth
    `(2/k) int_0^(kR) J0(t) dt` without changing any displacement on the grid (Vico, Greengard and Ferrando 2016,
    J. Comput. Phys. 323, 191). E* = 1, lengths in cell sizes.

    Args:
        offsets: Largest offset m.

    Returns:
        Influence [cell sizes], shape (m + 1, m + 1).
    """
    # Only thin layers ask, and it takes 0.1 s to import.
    from scipy.special import itj0y0  # noqa: PLC0415

    # Half of the period: with it no image of the cut-off kernel reaches back to sqrt(2) m.
    half = 2 * offsets
    cut_off = 2.0 * offsets
    modes = np.arange(half + 1)
    k = np.pi / half * np.hypot(modes[:, None], modes)
    k[0, 0] = 1.0
    symbol = 2.0 / k * itj0y0(k * cut_off)[0]
    symbol[0, 0] = 2.0 * cut_off
    cosine_plan(symbol, 1, (0, 1)).execute()
    return np.asarray(symbol[: offsets + 1, : offsets + 1] / (2 * half) ** 2)

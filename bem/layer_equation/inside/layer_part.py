"""What the layers below add to a half-space of the surface material, or the whole field: integrals over wavenumbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import j0, j1

from bem.kernels.inside import Place, Transfer, half_space_transfer, place_of, sheet_of, transfer
from bem.kernels.stack import StackKernel
from bem.polynomials.gauss_panels import PANEL_NODES, gauss_nodes, lagrange_matrix
from contact.records.validation import FloatArray

# exp(-38) is below all digits.
_DECAYED = 38.0
# First panel of the wavenumber over the reciprocal of the longest length; panels then double.
_FIRST = 0.5

# Points count as a grid if their different radii times depths are at most so many times the points.
_GRID = 4
# Width of panels over the thinnest layer, and Gauss nodes, on which what layers add is interpolated where points are
# many: images of the load lie at least a thickness away, where 18 nodes on half of one leave 1e-16.
_SMOOTH_WIDTH = 0.5
_SMOOTH_NODES = 18
# A point of a grid costs so many times less than a scattered one, rounded down.
_GRID_IS_CHEAPER = 8
# Points times wavenumbers of a block: 2 MB an array.
_BLOCK = 1 << 18
# Which Bessel function each field goes with.
_WAVES = ("over_r", "J0", "J0", "J1", "J0", "J0", "J0", "J1", "J0")

NAMES = (
    "hoop_strain",
    "axial",
    "axial_stress",
    "shear_stress",
    "s1",
    "s2",
    "hydrostatic_pressure",
    "pressure_gradient_radial",
    "pressure_gradient_axial",
)


def wavenumbers(kernel: StackKernel, reach: float, largest: float) -> tuple[FloatArray, FloatArray]:
    """Nodes and weights up to `largest` that resolve waves out to `reach`."""
    widest = min(1.0, 4.0 * math.pi / reach)
    ends, width = [0.0], min(_FIRST / kernel.longest, widest)
    while ends[-1] < largest:
        ends.append(ends[-1] + width)
        width = min(2.0 * width, widest)
    u, w = gauss_nodes(PANEL_NODES)
    starts, widths = np.array(ends[:-1]), np.diff(ends)
    return (starts[:, None] + widths[:, None] * u).ravel(), (widths[:, None] * w).ravel()


def layer_fields(
    kernel: StackKernel,
    pressure_transform: Callable[[FloatArray], FloatArray],
    r: FloatArray,
    depth: FloatArray,
    *,
    beyond_half_space: bool,
    radius: float,
) -> dict[str, FloatArray]:
    """Fields at points of one layer, lengths over the first layer's thickness, shape (n,).

    Args:
        kernel: The stack.
        pressure_transform: p^(k) = int_0^inf p J_0(kr) r dr, of shape (k,).
        r: Radii, shape (n,).
        depth: Their depths z > 0, all in the same layer.
        beyond_half_space: Whether to leave out what a half-space of the surface material would feel; in the top layer.
        radius: Of the loaded circle.
    """
    place = place_of(kernel, float(depth.max()))
    above = float(depth.max() - place.depth)
    slowest = 2.0 * kernel.sheets[0].thickness - depth.max() if beyond_half_space else depth.min()
    k, w = wavenumbers(kernel, radius + float(r.max(initial=0.0)), _DECAYED / float(slowest))
    sums = _Sums(kernel, Place(place.sheet, 0.0), above, beyond_half_space, k, w * k * pressure_transform(k))
    radii, which_r = np.unique(r, return_inverse=True)
    depths, which_z = np.unique(depth, return_inverse=True)
    # Points on a grid share Bessel functions and transfer functions; scattered ones have their own.
    shared = radii.size * depths.size <= _GRID * r.size
    if not shared and (smooth := _Smooth.of(kernel, r, depth, place, above)) is not None:
        grid = sums.on_grid(smooth.radii, smooth.depths)
        return dict(zip(NAMES, smooth.interpolated(grid, r, depth), strict=True))
    if shared:
        rows = max(1, _BLOCK // k.size)
        parts = [sums.on_grid(radii, depths[i : i + rows]) for i in range(0, depths.size, rows)]
        values = np.concatenate(parts, axis=1)[:, which_z, which_r]
    else:
        rows = max(1, _BLOCK // k.size)
        parts = [sums.at_points(r[i : i + rows], depth[i : i + rows]) for i in range(0, r.size, rows)]
        values = np.concatenate(parts, axis=1)
    return dict(zip(NAMES, values, strict=True))


@dataclass(frozen=True)
class _Smooth:
    """Gauss panels in r and z on which these fields are polynomials: they vary on the scale of the thinnest layer.

    Attributes:
        radii: Nodes, shape (panels, nodes) raveled.
        depths: The same.
        origin: First depth.
        widths: Of the panels in r and z.
    """

    radii: FloatArray
    depths: FloatArray
    origin: float
    widths: tuple[float, float]

    @classmethod
    def of(cls, kernel: StackKernel, r: FloatArray, depth: FloatArray, place: Place, above: float) -> _Smooth | None:
        """The panels that cover the points; None where the points are fewer."""
        thinnest = min(sheet.thickness for sheet in kernel.sheets)
        width = _SMOOTH_WIDTH * (thinnest if place.sheet == 0 else min(thinnest, above))
        first, reach, deepest = float(depth.min()), float(r.max()), float(depth.max())
        counts = math.ceil(reach / width) or 1, math.ceil((deepest - first) / width) or 1
        if _SMOOTH_NODES**2 * counts[0] * counts[1] > _GRID_IS_CHEAPER * r.size:
            return None
        widths = (reach or 1.0) / counts[0], (deepest - first or 1.0) / counts[1]
        u, _ = gauss_nodes(_SMOOTH_NODES)
        radii, depths = ((n * (np.arange(many)[:, None] + u)).ravel() for n, many in zip(widths, counts, strict=True))
        return cls(radii, first + depths, first, widths)

    def interpolated(self, grid: FloatArray, r: FloatArray, depth: FloatArray) -> FloatArray:
        """Values at points, shape (9, n), of those on the grid, shape (9, depths, radii)."""
        column, across = _lagrange(r / self.widths[0], self.radii.size)
        row, down = _lagrange((depth - self.origin) / self.widths[1], self.depths.size)
        values = np.empty((len(grid), r.size))
        blocks = grid.reshape(len(grid), -1, _SMOOTH_NODES, self.radii.size // _SMOOTH_NODES, _SMOOTH_NODES)
        for i, j in {*zip(row.tolist(), column.tolist(), strict=True)}:
            some = (row == i) & (column == j)
            values[:, some] = np.einsum("pz,czr,pr->cp", down[some], blocks[:, i, :, j], across[some], optimize=True)
        return values


def _lagrange(position: FloatArray, nodes: int) -> tuple[NDArray[np.intp], FloatArray]:
    """Panel of each position, and the weights of its nodes."""
    panel = np.clip(position.astype(np.intp), 0, nodes // _SMOOTH_NODES - 1)
    return panel, lagrange_matrix(_SMOOTH_NODES, position - panel)


@dataclass(frozen=True)
class _Sums:
    """Sums over wavenumbers of one layer.

    Attributes:
        kernel: The stack.
        top: The layer's upper face.
        above: Depth of that face.
        beyond_half_space: As in `layer_fields`.
        k: Wavenumbers.
        load: Weights times k p^(k).
    """

    kernel: StackKernel
    top: Place
    above: float
    beyond_half_space: bool
    k: FloatArray
    load: FloatArray

    def on_grid(self, r: FloatArray, depth: FloatArray) -> FloatArray:
        """Shape (9, depths, radii)."""
        terms = self._terms(depth)
        J0, J1, over_r = _bessel(np.multiply.outer(r, self.k), r[:, None], self.k)
        waves = {"J0": J0, "J1": J1, "over_r": over_r}
        return np.stack([term @ waves[wave].T for wave, term in zip(_WAVES, terms, strict=True)])

    def at_points(self, r: FloatArray, depth: FloatArray) -> FloatArray:
        """Shape (9, points)."""
        terms = self._terms(depth)
        J0, J1, over_r = _bessel(np.multiply.outer(r, self.k), r[:, None], self.k)
        waves = {"J0": J0, "J1": J1, "over_r": over_r}
        return np.stack([np.einsum("pk,pk->p", term, waves[wave]) for wave, term in zip(_WAVES, terms, strict=True)])

    def _terms(self, depth: FloatArray) -> list[FloatArray]:
        """What multiplies the Bessel functions, each of shape (depths, k)."""
        within = np.maximum(depth - self.above, 0.0)[:, None]
        here = transfer(self.kernel, self.k, Place(self.top.sheet, within))
        nu = sheet_of(self.kernel, self.top).poissons_ratio
        if self.beyond_half_space:
            other = half_space_transfer(self.k * depth[:, None], nu)
            here = Transfer(*(one - two for one, two in zip(here, other, strict=True)))
        U, W, Q, P = (part * self.load for part in here)
        m, share = nu / (1 - nu), (1 + nu) / (3 * (1 - nu))
        k, spherical = self.k, share * (P - U)
        plane = U / (1 - nu) - m * P
        return [U / k, W / k, -P, -Q, plane, m * (U - P), spherical, -k * spherical, share * k * (Q - W)]


def _bessel(kr: FloatArray, r: FloatArray, k: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """J0, J1 and J1/r, which is k/2 on the axis."""
    J1 = j1(kr)
    return j0(kr), J1, np.where(r > 0.0, J1 / np.where(r > 0.0, r, 1.0), k / 2.0)

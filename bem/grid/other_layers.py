"""Displacement at the centre of one square cell under a uniform pressure on another: stacks and graded layers.

As in `influence`, Love's rectangle and a correction ``V(rho) = int_0^inf (chi - 1) J0(k rho) dk``, which comes from
the kernel N of the integral equation: ``V(rho) = -(2/pi) int_0^rho N(s)/sqrt(rho^2 - s^2) ds``. It neither ends at a
distance, since an elastic base is felt anywhere, nor is it smooth at the axis under a graded surface.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import ceil, log
from typing import Final

import numpy as np

from bem.grid.influence import rectangle_influence
from bem.kernels.of_layer import surface_kernel
from bem.kernels.protocol import SurfaceKernel
from bem.layer_equation.any_layer.point_kernel import PointKernel
from bem.polynomials.cubics import PiecewiseCubic
from bem.polynomials.gauss import legendre_rule
from contact import ElasticLayer
from contact.records.validation import FloatArray

# Knots of the spline of V over ln(rho + NEAR), out to FAR thicknesses of the surface material. On two stacks and a
# graded layer V moved by less than 1e-8 of its largest with twice as many (tests/bem/test_other_layers.py).
KNOTS: Final = 1600
NEAR: Final = 1e-4
# Most Gauss points across a cell, beyond two: first guesses on coarse cells need no more, and answers on cells wider
# than the material at the surface is thick are refused.
MOST_POINTS: Final = 8.0
FAR: Final = 2.0**12
# Mean of ln r on a unit square about its centre. V is -c_1 ln(rho) at the axis under a graded surface, and Gauss points
# leave 0.045 of that on the loaded cell itself: 4e-7 of a stiffness on 256 cells.
MEAN_LOGARITHM: Final = (np.pi / 2 - 3.0 - log(2.0)) / 2


@dataclass(frozen=True, eq=False)
class PointCorrection:
    """V of one layer, lengths in thicknesses of its surface material."""

    spline: PiecewiseCubic

    @classmethod
    def of_surface(cls, kernel: SurfaceKernel) -> PointCorrection:
        """By Gauss panels that double with s, and s = rho sin(beta) on the last."""
        u = np.linspace(np.log(NEAR), np.log(FAR + NEAR), KNOTS)
        rho, N = np.exp(u) - NEAR, PointKernel.of_surface(kernel)
        x, w = legendre_rule(20)
        shares = np.append(0.0, 2.0 ** np.arange(-24, 0))
        left, half = shares[:-1, None], np.diff(shares)[:, None] / 2
        share, weight = (left + half * (1 + x)).ravel(), (half * w).ravel()
        low = np.arcsin(shares[-1])
        beta = low + (np.pi / 2 - low) * (1 + x) / 2
        inner = N(np.multiply.outer(rho, share)) @ (weight / np.sqrt(1 - share**2))
        outer = N(np.multiply.outer(rho, np.sin(beta))) @ ((np.pi / 2 - low) / 2 * w)
        return cls(PiecewiseCubic.spline(u, -2 / np.pi * (inner + outer)))

    def __call__(self, rho: FloatArray) -> FloatArray:
        """V(rho); beyond FAR it falls like 1/rho."""
        near = np.minimum(rho, FAR)
        return np.asarray(self.spline(np.log(near + NEAR)) * np.minimum(FAR / np.maximum(rho, NEAR), 1.0))


@lru_cache(maxsize=16)
def point_correction(kernel: SurfaceKernel) -> PointCorrection:
    """The same, remembered."""
    return PointCorrection.of_surface(kernel)


def other_layer_influence(offsets: int, layer: ElasticLayer, cell_size: float) -> FloatArray:
    """Displacement at cell offset (i, j) by a unit pressure on one cell, lengths in cell sizes, E* = 1.

    Args:
        offsets: Largest offset m.
        layer: Stack or graded layer.
        cell_size: s [m].

    Returns:
        Influence [cell sizes], shape (m + 1, m + 1).
    """
    influence, thickness = rectangle_influence(offsets), layer.surface.thickness / cell_size
    kernel = surface_kernel(layer)
    correction = point_correction(kernel)
    # An even number leaves out the centre, where the logarithm of a graded layer is infinite.
    points, weights = legendre_rule(2 + 2 * ceil(min(2.0 / thickness, MOST_POINTS / 2)))
    i, j = np.tril_indices(offsets + 1)
    total = np.zeros(i.shape)
    for x, wx in zip(points / 2, weights / 2, strict=True):
        for y, wy in zip(points / 2, weights / 2, strict=True):
            total += wx * wy * correction(np.hypot(i + x, j + y) / thickness)
    total[0] += kernel.edge_slope * (_mean_logarithm(points / 2, weights / 2) - MEAN_LOGARITHM)
    influence[i, j] += total / (np.pi * thickness)
    influence[j, i] = influence[i, j]
    return influence


def _mean_logarithm(points: FloatArray, weights: FloatArray) -> float:
    """What this rule on [-1/2, 1/2] makes of the mean of ln r on a unit square about its centre."""
    return float(weights @ np.log(np.hypot(points[:, None], points)) @ weights)


def edge_logarithm(layer: ElasticLayer) -> float:
    """c_1/h [1/m] with chi = 1 + c_1/(k h) + ...: zero but under a graded surface."""
    return 0.0 if layer.is_half_space else surface_kernel(layer).edge_slope / layer.surface.thickness


def point_response(layer: ElasticLayer, distance: FloatArray) -> FloatArray:
    """1/r + V(r/h)/h [1/m], what a point force does at a distance r [m]."""
    h = layer.surface.thickness
    return np.asarray(1 / distance + point_correction(surface_kernel(layer))(distance / h) / h)

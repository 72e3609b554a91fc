"""The kernel between points on both sides of a cut as a short sum of products, and what it becomes a block further.

For points x, s >= 0 of any distance the kernel N(x + s) has few independent functions of x: the largest eigenvectors of
its Hankel matrix on panels that double (some 35 to a rounding). With these functions as columns of U,

    N(x + s) = U(x) v(s),    v(s + B) = T v(s),

so that the kernel between blocks of width B is U T^n v for any number n of blocks between them. The functions are
orthonormal, so that coefficients are no larger than what they stand for.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.polynomials.gauss_panels import PANEL_NODES, lagrange_matrix
from bem.polynomials.mapped import MappedGrid
from contact.records.validation import FloatArray

# Eigenvalues of the Hankel matrix below this share of the largest are left out. Below a few roundings eigenvectors are
# noise, and powers of T grow: at 5e-17 they reach 1e10 over 160 blocks, at 4e-15 and 3e-16 k_bar is within 0.3 k_bar
# roundings of dense factors up to a/h = 1000 (nu = 0.3 on a free base, 0.45, 0.5, 2026-11-23).
SMALLEST_SHARE = 1e-15


@dataclass(frozen=True)
class ShiftedKernel:
    """N between the nodes of equal blocks of width B.

    Attributes:
        functions: U at the nodes x of a block, counted from its start, shape (n, r).
        shift: T, shape (r, r).
        before: v(B - x), for the kernel N(x - t) between neighbouring blocks, shape (r, n).
        mirrored: v(B + x), for the kernel N(x + t) between the first two, shape (r, n).
    """

    functions: FloatArray
    shift: FloatArray
    before: FloatArray
    mirrored: FloatArray

    @classmethod
    def of_kernel(cls, kernel: FredholmKernel, nodes: FloatArray, width: float, reach: float) -> ShiftedKernel:
        """For distances x + s up to `reach`.

        Args:
            kernel: N.
            nodes: x of one block, shape (n,).
            width: B, in thicknesses.
            reach: A multiple of B, two at least.
        """
        grid = doubling_panels(reach)
        x, weights = grid.nodes.ravel(), grid.weights.ravel()
        basis = _functions(kernel, x, np.sqrt(weights))
        projection = (basis * weights[:, None]).T
        to_left, to_right = width - nodes, width + nodes
        values = kernel.products(x, np.concatenate([to_left, to_right]))
        coefficients = projection @ values
        # Once more: the functions are orthonormal but for roundings.
        coefficients += projection @ (values - basis @ coefficients)
        before, mirrored = np.hsplit(coefficients, 2)
        return cls(_between(grid, basis, nodes), _shift(grid, basis, width), before, mirrored)


def doubling_panels(reach: float) -> MappedGrid:
    """Panels on [0, reach] that are one thickness wide at the start and double; the last one ends there."""
    ends = 2.0 ** np.arange(np.ceil(np.log2(reach)))
    return MappedGrid.between(np.concatenate([[0.0], ends[ends < reach], [reach]]), PANEL_NODES)


def _functions(kernel: FredholmKernel, x: FloatArray, root: FloatArray) -> FloatArray:
    """Orthonormal functions at the nodes of a grid, shape (nodes, r)."""
    values, vectors = np.linalg.eigh(root[:, None] * kernel.products(x, x) * root)
    size = np.abs(values)
    return np.asarray(vectors[:, size > SMALLEST_SHARE * size.max()] / root[:, None])


def _between(grid: MappedGrid, basis: FloatArray, points: FloatArray) -> FloatArray:
    """The functions at other points, by the polynomials of their panels."""
    panel, position = grid.locate(points)
    on_panels = basis.reshape(len(grid.left), grid.count, -1)
    return np.asarray((lagrange_matrix(grid.count, position)[:, None] @ on_panels[panel])[:, 0])


def _shift(grid: MappedGrid, basis: FloatArray, width: float) -> FloatArray:
    """T by least squares on all of the grid but a block."""
    ends = grid.ends[grid.ends < grid.end - width]
    shorter = MappedGrid.between(np.append(ends, grid.end - width), grid.count)
    x, root = shorter.nodes.ravel(), np.sqrt(shorter.weights).reshape(-1, 1)
    here, there = (root * _between(grid, basis, points) for points in (x, x + width))
    return np.asarray(np.linalg.lstsq(here, there, rcond=None)[0])

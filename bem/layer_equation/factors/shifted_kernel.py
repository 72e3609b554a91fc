"""The kernel between points on both sides of a cut as a short sum of products, and what it becomes a block further.

For x, s >= 0 the kernel N(x + s) has few independent functions of x: the largest eigenvectors of its Hankel matrix on
the nodes of a block and on panels that double beyond it, some 35 to a rounding. With them as columns of U,

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

# Eigenvalues of the Hankel matrix below this share of the largest are left out. At 1e-16 to 4e-15 the kernel errs by
# 2e-17 at most, times the roots of two weights, with 30 to 47 functions; at 5e-17 there are 100, of which most are
# noise, at 1e-14 errors double (four layers, blocks of 8 to 40 thicknesses, 2026-11-23).
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
    def of_kernel(
        cls, kernel: FredholmKernel, nodes: FloatArray, weights: FloatArray, width: float, blocks: int
    ) -> ShiftedKernel:
        """For distances x + s up to twice that of so many blocks.

        Args:
            kernel: N.
            nodes: x of one block, shape (n,).
            weights: Of integrals over it, shape (n,).
            width: B, in thicknesses.
            blocks: Their number.
        """
        beyond = _doubling_panels(width, 2 * blocks * width)
        x, own = np.append(nodes, width + beyond.nodes), np.append(weights, beyond.weights)
        basis = _functions(kernel, x, np.sqrt(own))
        projection = (basis * own[:, None]).T
        values = kernel.products(x, np.append(width - nodes, width + nodes))
        coefficients = projection @ values
        # Once more: the functions are orthonormal but for roundings.
        coefficients += projection @ (values - basis @ coefficients)
        before, mirrored = np.hsplit(coefficients, 2)
        inside, outside = np.split(basis, [len(nodes)])
        # T by least squares on all but the last block.
        ends = beyond.ends[beyond.ends < beyond.end - width]
        shorter = MappedGrid.between(np.append(ends, beyond.end - width), beyond.count)
        root = np.sqrt(np.append(weights, shorter.weights))[:, None]
        here = np.concatenate([inside, _between(beyond, outside, shorter.nodes)])
        there = _between(beyond, outside, np.append(nodes, width + shorter.nodes))
        shift = np.linalg.lstsq(root * here, root * there, rcond=None)[0]
        return cls(inside, shift, before, mirrored)


def _doubling_panels(first: float, end: float) -> MappedGrid:
    """Beyond the first block, counted from its end: panels that end where the distance from its start has doubled."""
    ends = first * 2.0 ** np.arange(np.ceil(np.log2(end / first)))
    return MappedGrid.between(np.append(ends[ends < end], end) - first, PANEL_NODES)


def _functions(kernel: FredholmKernel, x: FloatArray, root: FloatArray) -> FloatArray:
    """Orthonormal functions at the nodes of a grid, shape (nodes, r)."""
    values, vectors = np.linalg.eigh(root[:, None] * kernel.products(x, x) * root)
    size = np.abs(values)
    return np.asarray(vectors[:, size > SMALLEST_SHARE * size.max()] / root[:, None])


def _between(grid: MappedGrid, basis: FloatArray, points: FloatArray) -> FloatArray:
    """The functions at other points, by the polynomials of their panels."""
    panel, position = grid.locate(points.ravel())
    on_panels = basis.reshape(len(grid.left), grid.count, -1)
    return np.asarray((lagrange_matrix(grid.count, position)[:, None] @ on_panels[panel])[:, 0])

"""A triangular factor as one dense matrix."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.layer_equation.triangular import equation_factor, solve_lower
from bem.polynomials.gauss_panels import gauss_nodes
from contact.records.validation import FloatArray


@dataclass(frozen=True)
class DenseLower:
    """The factor C of all panels.

    Attributes:
        matrix: Shape (n, n), lower triangle.
    """

    matrix: FloatArray

    def __len__(self) -> int:
        """Its unknowns."""
        return len(self.matrix)

    def solve(self, right: FloatArray, *, transposed: bool = False) -> FloatArray:
        """Solution of C x = b, or C^T x = b, for the leading section that is as large as b."""
        n = len(right)
        return solve_lower(self.matrix[:n, :n], right, transposed=transposed)

    def row(self, start: int, stop: int) -> FloatArray:
        """What stands left of the diagonal block [start, stop) of a panel, shape (stop - start, start)."""
        return np.asarray(self.matrix[start:stop, :start])

    def from_earlier(self, solution: FloatArray, count: int) -> FloatArray:
        """Each such row times the solution before it, for panels of so many nodes, shape (panels, count)."""
        starts = range(0, len(solution), count)
        return np.array([self.row(s, s + count) @ solution[:s] for s in starts])


def dense_factor(kernel: FredholmKernel, panels: int, width: float, count: int) -> tuple[DenseLower, FloatArray]:
    """The factor on equal panels, and K~ at each panel's own nodes, shape (panels, count, count).

    Args:
        kernel: N.
        panels: Their number.
        width: Of each, in thicknesses.
        count: Gauss nodes on each.

    Raises:
        NotConvergedError: If the matrix is not positive definite in double precision.
    """
    root = np.sqrt(width * np.tile(gauss_nodes(count)[1], panels))
    return factor_of_matrix(kernel.panel_matrix(panels, width, count), root, count, panels * width)


def factor_of_matrix(matrix: FloatArray, root: FloatArray, count: int, ratio: float) -> tuple[DenseLower, FloatArray]:
    """The same from L at all nodes, which is overwritten.

    Args:
        matrix: L, shape (n, n).
        root: sqrt(w), shape (n,).
        count: Gauss nodes on each panel.
        ratio: Largest a/h, for the message.

    Raises:
        NotConvergedError: If the matrix is not positive definite in double precision.
    """
    own = 2 / np.pi * np.array([matrix[s : s + count, s : s + count] for s in range(0, len(matrix), count)])
    lower = equation_factor(matrix, root, ratio)
    return DenseLower(lower), schur_kernels(own, lower, root)


def schur_kernels(own: FloatArray, lower: FloatArray, root: FloatArray) -> FloatArray:
    """K~ = K + K A^-1 K over the earlier panels, from the rows of the factor left of each diagonal block of K."""
    schur, count = own.copy(), own.shape[1]
    for p, kernel in enumerate(schur):
        start, stop = p * count, (p + 1) * count
        row = lower[start:stop, :start] / root[start:stop, None]
        kernel[:] += row @ row.T
    return schur

"""A triangular factor by blocks of panels: dense on the diagonal, joined by the few functions of `ShiftedKernel`.

Rows of block p and columns of block q < p of the matrix I - sqrt(w) K sqrt(w) are U T^(p-q-1) V_q, and so are those of
its factor, U T^(p-q-1) W_q^T. What blocks before p take from the matrix of block p is U S_p U^T, where

    S_(p+1) = T S_p T^T + W_p^T W_p.

A dense factor of n unknowns takes n^3/3 steps and n^2 numbers, this one a multiple of n.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from bem.layer_equation.factors.dense import factor_of_matrix
from bem.layer_equation.factors.shifted_kernel import ShiftedKernel
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.layer_equation.triangular import solve_lower
from bem.polynomials.gauss_panels import gauss_nodes
from contact.records.validation import FloatArray

# Unknowns of a block at most: few enough for its dense factor to cost less than joining blocks, enough for errors of T
# not to add up. With blocks of one panel k_bar moved by one k_bar rounding, with eight by 0.2 (a/h = 160, 2026-11-23).
BLOCK = 192


@dataclass(frozen=True)
class BlockLower:
    """The factor C of all panels.

    Attributes:
        size: Unknowns, n.
        diagonal: Lower factors of each block, the last one perhaps smaller.
        columns: W of each block, shape (its size, r).
        rows: sqrt(w) U of a block, shape (size of a block, r).
        shift: T, shape (r, r).
    """

    size: int
    diagonal: list[FloatArray]
    columns: list[FloatArray]
    rows: FloatArray
    shift: FloatArray

    def __len__(self) -> int:
        """Its unknowns."""
        return self.size

    def solve(self, right: FloatArray, *, transposed: bool = False) -> FloatArray:
        """Solution of C x = b, or C^T x = b, for the leading section that is as large as b."""
        return self._backward(right) if transposed else self._forward(right)

    def row(self, start: int, stop: int) -> FloatArray:
        """What stands left of the diagonal block [start, stop) of a panel, shape (stop - start, start)."""
        block, first = divmod(start, len(self.rows))
        within = slice(first, first + stop - start)
        found, joined = [self.diagonal[block][within, :first]], self.rows[within]
        for columns in reversed(self.columns[:block]):
            found.append(joined @ columns.T)
            joined = joined @ self.shift
        return np.concatenate(found[::-1], axis=1)

    def from_earlier(self, solution: FloatArray, count: int) -> FloatArray:
        """Each such row times the solution before it, for panels of so many nodes, shape (panels, count)."""
        found, state = np.empty(len(solution)), np.zeros(len(self.shift))
        for number, part in enumerate(self._parts(len(solution))):
            z = solution[part]
            panel = np.arange(len(z)) // count
            inside = np.where(panel[:, None] > panel, self.diagonal[number][: len(z), : len(z)], 0.0)
            found[part] = self.rows[: len(z)] @ state + inside @ z
            state = self.shift @ state + self.columns[number][: len(z)].T @ z
        return found.reshape(-1, count)

    def _parts(self, size: int) -> list[slice]:
        """Of a leading section, one for each block."""
        return [slice(start, min(start + len(self.rows), size)) for start in range(0, size, len(self.rows))]

    def _forward(self, right: FloatArray) -> FloatArray:
        solution, state = np.empty_like(right), np.zeros((len(self.shift), *right.shape[1:]))
        for number, part in enumerate(self._parts(len(right))):
            load = right[part]
            section = self.diagonal[number][: len(load), : len(load)]
            solution[part] = solve_lower(section, load - self.rows[: len(load)] @ state)
            state = self.shift @ state + self.columns[number][: len(load)].T @ solution[part]
        return solution

    def _backward(self, right: FloatArray) -> FloatArray:
        solution, state = np.empty_like(right), np.zeros((len(self.shift), *right.shape[1:]))
        for number, part in reversed(list(enumerate(self._parts(len(right))))):
            load = right[part]
            section = self.diagonal[number][: len(load), : len(load)]
            later = self.columns[number][: len(load)] @ state
            solution[part] = solve_lower(section, load - later, transposed=True)
            state = self.shift.T @ state + self.rows[: len(load)].T @ solution[part]
        return solution


def block_factor(kernel: FredholmKernel, panels: int, width: float, count: int) -> tuple[BlockLower, FloatArray]:
    """The factor, and K~ at each panel's own nodes, shape (panels, count, count).

    Args:
        kernel: N.
        panels: Their number.
        width: Of each, in thicknesses.
        count: Gauss nodes on each.

    Raises:
        NotConvergedError: If the matrix is not positive definite in double precision.
    """
    together = max(BLOCK // count, 1)
    blocks, nodes = -(-panels // together), (width * (np.arange(together)[:, None] + gauss_nodes(count)[0])).ravel()
    weights = width * np.tile(gauss_nodes(count)[1], together)
    joined = ShiftedKernel.of_kernel(kernel, nodes, weights, width * together, blocks)
    U, T, root = joined.functions, joined.shift, np.sqrt(weights)
    taken, diagonal, columns, schur = np.zeros_like(T), [], [], []
    for number, (own, right) in enumerate(_matrix(kernel, joined, blocks, width, count)):
        n = min(len(U), panels * count - number * len(U))
        left = (own + np.pi / 2 * (U @ taken @ U.T))[:n, :n]
        lower, kernels = factor_of_matrix(np.ascontiguousarray(left), root[:n], count, panels * width)
        further = -2 / np.pi * right - T @ (taken @ U.T)
        columns.append(lower.solve((further * root).T[:n]))
        diagonal.append(lower.matrix)
        schur.append(kernels)
        taken = T @ taken @ T.T + columns[-1].T @ columns[-1]
    return BlockLower(panels * count, diagonal, columns, root[:, None] * U, T), np.concatenate(schur)


def _matrix(
    kernel: FredholmKernel, joined: ShiftedKernel, blocks: int, width: float, count: int
) -> Iterator[tuple[FloatArray, FloatArray]]:
    """L = [N(x - t) + N(x + t)]/2 in each block, and what joins it to the next: coefficients for its nodes t."""
    together = len(joined.functions) // count
    nodes = (width * (np.arange(together)[:, None] + gauss_nodes(count)[0])).ravel()
    first, mirrored = kernel.panel_matrix(together, width, count), joined.mirrored
    differences = first - kernel.products(nodes, nodes) / 2
    yield first, (joined.before + mirrored) / 2
    for _ in range(blocks - 1):
        inside = joined.shift @ mirrored
        mirrored = joined.shift @ inside
        yield differences + joined.functions @ inside / 2, (joined.before + mirrored) / 2

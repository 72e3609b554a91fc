"""Sparse direct solutions with prescribed unknowns.

Unknowns inside triangles are condensed, the others are factorised in an order that needs no pivoting. Every solution is
checked by its backward error. With o for the unknowns that a triangle shares with others and i for those inside it,
``K_ii u_i + K_io u_o = f_i`` leaves ``S u_o = f_o - K_oi K_ii^-1 f_i`` with ``S = K_oo - K_oi K_ii^-1 K_io``
(E. L. Wilson, Int. J. Numer. Meth. Engng 8 (1974) 198-203). The pressure inside a triangle is condensed with the
displacements there, which keep K_ii regular at nu = 1/2.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from contact.records.errors import NotConvergedError, UnsupportedSceneError
from contact.records.validation import FloatArray, IntArray
from fem_reference.assembly import Space, scatter

# Componentwise backward error that a solution must reach: sound ones end below 1e-14, those of small pivots far above.
BACKWARD_ERROR = 1e-11
# Rows whose terms are smaller than this share of the largest are judged like rows of that size: displacements far away
# fall below the rounding of those under the contact.
LEAST_SHARE = float(np.sqrt(np.finfo(float).eps))
# Bytes per entry of a condensed matrix while it is factorised.
BYTES_PER_ENTRY = 165
# SuperLU with diagonal pivots in the order of `minimum_degree`.
DIAGONAL: dict[str, Any] = {"diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True, "Equil": False}}


class RestrictedSolver:
    """Solutions with prescribed unknowns, all from one factorisation of the condensed triangles.

    Args:
        space: the unknowns.
        elements: matrix of each triangle, shape (triangle, n, n).
        springs: matrix that is added, in the numbering of all unknowns, without entries inside triangles; or None.
        prescribed: unknowns with given values, none of them inside a triangle.

    Attributes:
        prescribed: unknowns with given values.
        factorisations: number of factorisations: one, or two if the first was inaccurate.

    Raises:
        NotConvergedError: the matrix is singular.
        UnsupportedSceneError: the factors do not fit into memory.
    """

    def __init__(
        self, space: Space, elements: FloatArray, springs: sparse.csc_array | None, prescribed: IntArray
    ) -> None:
        inner = space.pair.inner
        outer = np.setdiff1d(np.arange(elements.shape[1]), inner)
        self._unknowns, self._inner = space.element_unknowns[:, outer], space.element_unknowns[:, inner]
        self._coupling = elements[:, inner][:, :, outer]
        self._inverse = np.linalg.inv(elements[:, inner][:, :, inner])
        shared = elements[:, outer][:, :, outer]
        shared = shared - self._coupling.transpose(0, 2, 1) @ (self._inverse @ self._coupling)
        matrix = scatter(shared, self._unknowns, space.size)
        self._matrix = (matrix if springs is None else matrix + springs).tocsr()
        self.prescribed, is_free = prescribed, np.zeros(space.size, dtype=bool)
        is_free[self._unknowns] = True
        is_free[prescribed] = False
        order = minimum_degree(space)
        self._free = order[is_free[order]]
        self._square = self._matrix[self._free][:, self._free].tocsc()
        self._absolute, self.factorisations = abs(self._square), 0
        self._factors = self._factorised(permc_spec="NATURAL", **DIAGONAL)

    def solve_displaced(self, values: FloatArray) -> FloatArray:
        """All unknowns, shape (size, m), for prescribed values of shape (prescribed, m)."""
        solution = np.zeros((self._matrix.shape[0], values.shape[1]))
        solution[self.prescribed] = values
        solution[self._free] = self._solved(-(self._matrix @ solution)[self._free])
        solution[self._inner] = -(self._inverse @ (self._coupling @ solution[self._unknowns]))
        return solution

    def solve_loaded(self, loads: FloatArray, *, inside: bool = True) -> FloatArray:
        """All unknowns, shape (size, m), for loads of that shape, with the prescribed unknowns at zero.

        If ``inside`` is False, loads inside triangles are zero, and unknowns there are not computed but left at zero.
        """
        solution, outer = np.zeros_like(loads), loads.copy()
        if inside:
            local = self._coupling.transpose(0, 2, 1) @ (self._inverse @ loads[self._inner])
            np.subtract.at(outer, self._unknowns, local)
        solution[self._free] = self._solved(outer[self._free])
        if inside:
            solution[self._inner] = self._inverse @ (loads[self._inner] - self._coupling @ solution[self._unknowns])
        return solution

    def reactions(self, solution: FloatArray, unknowns: IntArray) -> FloatArray:
        """Nodal forces that act on the layer at shared unknowns, for a solution without loads inside triangles."""
        return np.asarray(self._matrix[unknowns] @ solution)

    def _factorised(self, **options: Any) -> Any:
        """SuperLU's factors with the given options; with partial pivoting if a diagonal pivot vanishes."""
        self.factorisations += 1
        if BYTES_PER_ENTRY * self._square.nnz > physical_memory():
            raise self._too_large
        try:
            return splu(self._square, **options)
        except MemoryError:
            raise self._too_large from None
        except RuntimeError:
            if options:
                return self._factorised()
        raise NotConvergedError("the stiffness matrix is singular; do the base and the axis support the layer?")

    @property
    def _too_large(self) -> UnsupportedSceneError:
        """Error of a matrix whose factors do not fit into memory."""
        return UnsupportedSceneError(
            f"a mesh of {len(self._free)} unknowns needs about {BYTES_PER_ENTRY * self._square.nnz / 1e9:.2g} GB, more "
            "than there is: give a less strict accuracy or a larger growth"
        )

    def _solved(self, rhs: FloatArray) -> FloatArray:
        """Solution at the free unknowns, shape (free, m), refactorised with pivoting if diagonal pivots are inaccurate.

        Raises:
            NotConvergedError: the backward error stays above `BACKWARD_ERROR`.
        """
        solution, error = self._refined(rhs)
        if not error <= BACKWARD_ERROR and self.factorisations == 1:
            self._factors = self._factorised()
            solution, error = self._refined(rhs)
        if not error <= BACKWARD_ERROR:
            raise NotConvergedError("the linear solve is inaccurate", {"backward_error": error})
        return solution

    def _refined(self, rhs: FloatArray) -> tuple[FloatArray, float]:
        """Solution after iterative refinement, with its componentwise backward error.

        That is the largest ``|b - A x|_i / (|A| |x| + |b|)_i`` (Oettli and Prager, Numer. Math. 6 (1964) 405-409).
        """
        solution = np.zeros_like(rhs)
        for _ in range(5):
            solution = solution + self._factors.solve(rhs - self._square @ solution)
            residual = np.abs(rhs - self._square @ solution)
            scale = self._absolute @ np.abs(solution) + np.abs(rhs)
            scale = np.maximum(scale, LEAST_SHARE * scale.max(axis=0, initial=0.0))
            error = float(np.max(np.divide(residual, scale, out=np.zeros_like(scale), where=scale != 0), initial=0))
            if error <= 1e-3 * BACKWARD_ERROR or not np.isfinite(error):
                break
        return solution, error


def physical_memory() -> float:
    """Bytes of the machine's memory; infinity on systems without this information."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return float("inf")


def minimum_degree(space: Space) -> IntArray:
    """All unknowns in an order of elimination that needs no pivoting and little fill, shape (size,).

    Unknowns of the same triangles (of one vertex, one edge or one interior) form one node, and the node with the fewest
    neighbours left is eliminated next (George and Liu, SIAM Review 31 (1989) 1-19).

    For nu < 1/2 the matrix ``[[A, B^T], [B, -C]]`` is quasidefinite, which factors without row exchanges in any order
    (Vanderbei, SIAM J. Optim. 5 (1995) 100-113). At nu = 1/2, where C = 0, the pivot of a pressure is minus the Schur
    complement of the displacements before it, and would vanish without these. Therefore displacements precede the
    pressures of their node. The inf-sup condition bounds the complement of all unknowns, not each pivot:
    `RestrictedSolver` checks every solution, and pivots if one is inaccurate.
    """
    unknowns = space.element_unknowns
    # One random number per triangle: their sum over the triangles of an unknown identifies its node.
    numbers = np.random.default_rng(0).random(len(unknowns))[:, None] + np.zeros(unknowns.shape[1])
    tags, node = np.unique(np.bincount(unknowns.ravel(), numbers.ravel(), space.size), return_inverse=True)
    ends = unknowns.shape[1] * np.arange(len(unknowns) + 1)
    assignment = sparse.csr_array((np.ones(unknowns.size), node[unknowns].ravel(), ends), (len(unknowns), len(tags)))
    neighbours = (assignment.T @ assignment).tocsc()
    # Any matrix of that pattern whose diagonal outweighs its rows factors without row exchanges.
    dominant = neighbours + sparse.diags_array(1.0 + neighbours.sum(axis=0)).tocsc()
    rank = splu(dominant, permc_spec="MMD_AT_PLUS_A", **DIAGONAL).perm_c
    is_pressure = np.arange(space.size) >= space.displacement_count
    return np.lexsort((is_pressure, rank[node])).astype(np.int64)

"""Sparse direct solutions with prescribed unknowns: inner unknowns condensed, an order without pivoting, checked.

With o for the unknowns that a triangle shares with others and i for those inside it, ``K_ii u_i + K_io u_o = f_i``
leaves ``S u_o = f_o - K_oi K_ii^-1 f_i`` with ``S = K_oo - K_oi K_ii^-1 K_io`` (E. L. Wilson, Int. J. Numer. Meth.
Engng 8 (1974) 198-203). The pressure inside a triangle is condensed with the displacements there, at every nu.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from importlib.util import find_spec
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from contact.records.errors import InvalidInput, NotConvergedError, UnsupportedSceneError
from contact.records.validation import FloatArray, IntArray
from fem_reference.assembly import Space, inner_counts, scatter

# Componentwise backward error that a solution must reach: sound ones end below 1e-14, those of small pivots far above.
BACKWARD_ERROR = 1e-11
# Rows whose terms are smaller than this share of the largest are judged like rows of that size: displacements far away
# fall below the rounding of those under the contact.
LEAST_SHARE = float(np.sqrt(np.finfo(float).eps))
# Bytes per entry of a condensed matrix while it is factorised.
BYTES_PER_ENTRY = 165
# Columns that SuperLU works on at a time: its own 20 take 1.1 times as long.
PANEL = 4


def without_pivoting(matrix: sparse.csc_array) -> Any:
    """SuperLU in the given order with diagonal pivots: fast, valid in the order of `minimum_degree`."""
    options = {"SymmetricMode": True, "Equil": False}
    return splu(matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, panel_size=PANEL, options=options)


def with_pivoting(matrix: sparse.csc_array) -> Any:
    """SuperLU with COLAMD ordering and partial pivoting: several times slower, valid for any matrix."""
    return splu(matrix, permc_spec="COLAMD")


def with_mumps(matrix: sparse.csc_array) -> Any:
    """MUMPS' symmetric indefinite factorisation (optional package python-mumps).

    Raises:
        InvalidInput: python-mumps is not installed.
    """
    if find_spec("mumps") is None:
        raise InvalidInput(
            "solver 'mumps' needs python-mumps; install contact-verification[mumps] or take solver 'superlu'"
        )
    import mumps  # type: ignore[import-not-found, unused-ignore]  # noqa: PLC0415 - optional

    context = mumps.Context()
    context.set_matrix(sparse.coo_matrix(matrix), symmetric=True)
    context.factor()
    return context


# Factorisations of each solver, tried in turn.
BACKENDS: dict[str, tuple[Callable[[sparse.csc_array], Any], ...]] = {
    "superlu": (without_pivoting, with_pivoting),
    "superlu-pivoting": (with_pivoting,),
    "mumps": (with_mumps, with_pivoting),
}


class CheckedSolver:
    """Solves ``matrix x = rhs`` with iterative refinement to a componentwise backward error of 1e-11.

    A factorisation that breaks down, or misses that bound, is replaced by the next, safer one of its row in `BACKENDS`.

    Args:
        matrix: sparse and symmetric.
        backend: a key of `BACKENDS`.

    Attributes:
        factorisations: how many were needed.

    Raises:
        NotConvergedError: the matrix is singular.
        UnsupportedSceneError: its factors do not fit into memory.
    """

    def __init__(self, matrix: sparse.csc_array, backend: str = "superlu") -> None:
        if backend not in BACKENDS:
            raise InvalidInput(f"solver must be one of {', '.join(BACKENDS)}, got {backend!r}")
        self._matrix, self._absolute, self._remaining = matrix, abs(matrix), list(BACKENDS[backend])
        self.factorisations = 0
        if BYTES_PER_ENTRY * matrix.nnz > physical_memory():
            raise _too_large(matrix)
        self._factors = self._next_factors()

    def _next_factors(self) -> Any:
        """The next factorisation that does not break down."""
        while self._remaining:
            factorize = self._remaining.pop(0)
            self.factorisations += 1
            try:
                return factorize(self._matrix)
            except RuntimeError:  # SuperLU met a pivot that is exactly zero.
                continue
            except MemoryError:
                raise _too_large(self._matrix) from None
        raise NotConvergedError("the stiffness matrix is singular; is the layer held by its base and axis?")

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solution of shape (n, m) for right-hand sides of shape (n, m).

        Raises:
            NotConvergedError: no factorisation reaches the backward error.
        """
        while True:
            solution, error = self._refined(rhs)
            if error <= BACKWARD_ERROR:
                return solution
            if not self._remaining:
                raise NotConvergedError("the linear solve is inaccurate", {"backward_error": error})
            self._factors = self._next_factors()

    def _refined(self, rhs: FloatArray) -> tuple[FloatArray, float]:
        solution = np.asarray(self._factors.solve(rhs))
        for left in reversed(range(5)):
            residual = rhs - self._matrix @ solution
            error = self._backward_error(residual, solution, rhs)
            if error <= 1e-3 * BACKWARD_ERROR or not np.isfinite(error) or left == 0:
                break
            solution = solution + self._factors.solve(residual)
        return solution, error if np.isfinite(error) else np.inf

    def _backward_error(self, residual: FloatArray, solution: FloatArray, rhs: FloatArray) -> float:
        """Largest ``|r_i| / (|A| |x| + |b|)_i`` (Oettli and Prager 1964)."""
        scale = self._absolute @ np.abs(solution) + np.abs(rhs)
        scale = np.maximum(scale, LEAST_SHARE * scale.max(axis=0, initial=0.0))
        return float(np.max(np.divide(np.abs(residual), scale, out=np.zeros_like(scale), where=scale != 0), initial=0))


def physical_memory() -> float:
    """Bytes of the machine's memory; infinity on systems without this information."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, ValueError, OSError):
        return float("inf")


def _too_large(matrix: sparse.csc_array) -> UnsupportedSceneError:
    """The refusal, with the size of the mesh and what makes it smaller."""
    needed = BYTES_PER_ENTRY * matrix.nnz / 1e9
    return UnsupportedSceneError(
        f"a mesh of {matrix.shape[0]} unknowns needs about {needed:.2g} GB, more than there is: ask for a less strict "
        "accuracy, or give a larger growth"
    )


class RestrictedSolver:
    """Solutions with prescribed unknowns, all from one factorisation of the condensed triangles.

    Args:
        space: the unknowns.
        elements: matrix of each triangle, shape (triangle, n, n).
        springs: a matrix of all unknowns that is added, or None.
        held: prescribed unknowns, none of them inside a triangle.
        backend: a key of `BACKENDS`.

    Attributes:
        held: the prescribed unknowns.
        checked: the factorised matrix of the others.
    """

    def __init__(
        self, space: Space, elements: FloatArray, springs: sparse.csc_array | None, held: IntArray, backend: str
    ) -> None:
        outer = elements.shape[1] - sum(inner_counts(space.pair))
        unknowns, self._coupling = space.element_unknowns, elements[:, outer:, :outer]
        self._unknowns, self._inner = unknowns[:, :outer], unknowns[:, outer:]
        self._inverse = np.linalg.inv(elements[:, outer:, outer:])
        shared = elements[:, :outer, :outer] - self._coupling.transpose(0, 2, 1) @ (self._inverse @ self._coupling)
        matrix = scatter(shared, self._unknowns, space.size)
        self._matrix = (matrix if springs is None else matrix + springs).tocsr()
        self.held, is_free = held, np.zeros(space.size, dtype=bool)
        is_free[self._unknowns] = True
        is_free[held] = False
        order = minimum_degree(space)
        self.free = order[is_free[order]]
        self.checked = CheckedSolver(self._matrix[self.free][:, self.free].tocsc(), backend)

    def solve_displaced(self, values: FloatArray) -> FloatArray:
        """All unknowns, shape (size, m), for prescribed values of shape (held, m)."""
        solution = np.zeros((self._matrix.shape[0], values.shape[1]))
        solution[self.held] = values
        solution[self.free] = self.checked.solve(-(self._matrix @ solution)[self.free])
        solution[self._inner] = -(self._inverse @ (self._coupling @ solution[self._unknowns]))
        return solution

    def solve_loaded(self, loads: FloatArray, *, inside: bool = True) -> FloatArray:
        """All unknowns, shape (size, m), for loads of that shape, the prescribed unknowns at zero.

        Without ``inside`` the unknowns inside triangles are not computed and stay zero.
        """
        solution, outer = np.zeros_like(loads), loads
        if loads[self._inner].any():
            local = self._coupling.transpose(0, 2, 1) @ (self._inverse @ loads[self._inner])
            outer = loads.copy()
            np.subtract.at(outer, self._unknowns, local)
        solution[self.free] = self.checked.solve(outer[self.free])
        if inside:
            missing = loads[self._inner] - self._coupling @ solution[self._unknowns]
            solution[self._inner] = self._inverse @ missing
        return solution

    def reactions(self, solution: FloatArray, unknowns: IntArray) -> FloatArray:
        """Nodal forces that act on the layer at shared unknowns, for a solution without loads inside triangles."""
        return np.asarray(self._matrix[unknowns] @ solution)


def minimum_degree(space: Space) -> IntArray:
    """All unknowns in an order of elimination that needs no pivoting and little fill.

    Unknowns of the same triangles (of one vertex, one edge or one interior) form one node, and the node with the fewest
    neighbours left is eliminated next (George and Liu, SIAM Review 31 (1989) 1-19). Inside every node the displacements
    precede the pressures: by the inf-sup condition each pressure pivot is then the (negative) Schur complement of
    displacements already eliminated, so the symmetric indefinite matrix factors without row exchanges.
    """
    unknowns = space.element_unknowns
    # The sum of random numbers of its triangles identifies the node of an unknown.
    numbers = np.repeat(np.random.default_rng(0).random(len(unknowns)), unknowns.shape[1])
    tags, first, node = np.unique(
        np.bincount(unknowns.ravel(), numbers, space.size), return_index=True, return_inverse=True
    )
    stands = np.zeros(space.size, dtype=bool)
    stands[first] = True
    shared = unknowns[:, : unknowns.shape[1] - sum(inner_counts(space.pair))]
    triangle, place = np.nonzero(stands[shared])
    shape = (len(unknowns), len(tags))
    belongs = sparse.coo_array((np.ones(len(place)), (triangle, node[shared[triangle, place]])), shape=shape).tocsr()
    neighbours = (belongs.T @ belongs).tocsc()
    # Any matrix of that pattern whose diagonal outweighs its rows factors without row exchanges.
    heavy = neighbours + sparse.diags_array(1.0 + neighbours.sum(axis=0)).tocsc()
    options = {"SymmetricMode": True, "Equil": False}
    rank = splu(heavy, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options).perm_c
    is_pressure = np.arange(space.size) >= space.displacement_count
    return np.lexsort((is_pressure, rank[node])).astype(np.int64)

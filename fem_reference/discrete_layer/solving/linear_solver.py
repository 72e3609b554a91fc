"""Sparse direct solves that are checked: a solution leaves this module with a small backward error or not at all."""

from __future__ import annotations

import os
from collections.abc import Callable
from importlib.util import find_spec
from typing import Protocol

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from contact.records.errors import InvalidInput, NotConvergedError, UnsupportedSceneError
from contact.records.validation import FloatArray

# Componentwise backward error that a solution must reach.  Refined solutions end below 1e-14 (paraboloids at a/h = 0.2
# to 20, nu = 0.3 to 1/2, 2026-11-22); one that misses this has lost digits to small pivots.
BACKWARD_ERROR = 1e-11
# Bytes for each entry of a condensed matrix in the order of `ordering` while it is factorised.  Measured: peaks of 0.76
# and 1.48 GB at 4.2 and 9.0 million entries (punch, degree 4, growth 0.18 and 0.12, 2026-11-23).
BYTES_PER_ENTRY = 165
# Columns that SuperLU works on at a time.  At its own 20 it takes 1.1 times as long for 3,400 to 98,000 unknowns (least
# of two, 2026-11-23); 8 and 12 lie between, and some sizes above 20 end the process.
PANEL = 4


class Factors(Protocol):
    """A factorised matrix."""

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Solution for one right-hand side (n,) or several (n, m)."""


def without_pivoting(matrix: sparse.csc_array) -> Factors:
    """SuperLU in the given order with diagonal pivots: fast, right in the order of `ordering`."""
    options = {"SymmetricMode": True, "Equil": False}
    factors: Factors = splu(matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, panel_size=PANEL, options=options)
    return factors


def with_pivoting(matrix: sparse.csc_array) -> Factors:
    """SuperLU with COLAMD ordering and partial pivoting: several times slower, and safe for any matrix."""
    factors: Factors = splu(matrix, permc_spec="COLAMD")
    return factors


def with_mumps(matrix: sparse.csc_array) -> Factors:
    """MUMPS' symmetric indefinite factorisation (optional package python-mumps).

    Raises:
        InvalidInput: python-mumps is not installed.
    """
    if find_spec("mumps") is None:
        raise InvalidInput(
            "solver 'mumps' needs python-mumps; install contact-verification[mumps] or take solver 'superlu'"
        )
    return _Mumps(matrix)


class _Mumps:
    def __init__(self, matrix: sparse.csc_array) -> None:
        import mumps  # type: ignore[import-not-found, unused-ignore]  # noqa: PLC0415 - optional

        self._context = mumps.Context()
        self._context.set_matrix(sparse.coo_matrix(matrix), symmetric=True)
        self._context.factor()

    def solve(self, rhs: FloatArray) -> FloatArray:
        return np.asarray(self._context.solve(rhs))


BACKENDS: dict[str, tuple[Callable[[sparse.csc_array], Factors], ...]] = {
    "superlu": (without_pivoting, with_pivoting),
    "superlu-pivoting": (with_pivoting,),
    "mumps": (with_mumps, with_pivoting),
}


class CheckedSolver:
    """Solves ``matrix x = rhs`` with iterative refinement to a componentwise backward error of 1e-11.

    A backend that breaks down, or misses that bound, is replaced by the next, safer one of its row in `BACKENDS`.

    Args:
        matrix: sparse and symmetric.
        backend: a key of `BACKENDS`.
        least_share: rows whose terms are smaller than this share of the largest are judged like rows of that size;
            zero judges each row by its own terms.

    Attributes:
        factorisations: how many were needed.

    Raises:
        NotConvergedError: the matrix is singular.
        UnsupportedSceneError: its factors do not fit into memory.
    """

    def __init__(self, matrix: sparse.csc_array, backend: str = "superlu", least_share: float = 0.0) -> None:
        if backend not in BACKENDS:
            raise InvalidInput(f"solver must be one of {', '.join(BACKENDS)}, got {backend!r}")
        self._matrix = matrix
        self._absolute = abs(matrix)
        self._least_share = least_share
        self._remaining = list(BACKENDS[backend])
        self.factorisations = 0
        if BYTES_PER_ENTRY * matrix.nnz > physical_memory():
            raise _too_large(matrix)
        self._factors = self._next_factors()

    def _next_factors(self) -> Factors:
        """Factorise by the next backend that does not break down."""
        while self._remaining:
            factorize = self._remaining.pop(0)
            self.factorisations += 1
            try:
                return factorize(self._matrix)
            # SuperLU met a pivot that is exactly zero.
            except RuntimeError:
                continue
            except MemoryError:
                raise _too_large(self._matrix) from None
        raise NotConvergedError("the stiffness matrix is singular; is the layer held by its base and axis?")

    def solve(self, rhs: FloatArray) -> FloatArray:
        """Checked solution of shape (n, m) for right-hand sides of shape (n, m).

        Raises:
            NotConvergedError: no backend reaches the backward error.
        """
        while True:
            solution, error = self._refine(rhs)
            if error <= BACKWARD_ERROR:
                return solution
            if not self._remaining:
                raise NotConvergedError("the linear solve is inaccurate", {"backward_error": error})
            self._factors = self._next_factors()

    def _refine(self, rhs: FloatArray) -> tuple[FloatArray, float]:
        solution = self._factors.solve(rhs)
        for left in reversed(range(5)):
            residual = rhs - self._matrix @ solution
            error = self._backward_error(residual, solution, rhs)
            if error <= 1e-3 * BACKWARD_ERROR or not np.isfinite(error) or left == 0:
                break
            solution = solution + self._factors.solve(residual)
        return solution, error if np.isfinite(error) else np.inf

    def _backward_error(self, residual: FloatArray, solution: FloatArray, rhs: FloatArray) -> float:
        """Largest ``|r_i| / (|A| |x| + |b|)_i`` (Oettli and Prager 1964), zero rows left out."""
        scale = self._absolute @ np.abs(solution) + np.abs(rhs)
        scale = np.maximum(scale, self._least_share * scale.max(axis=0, initial=0.0))
        return float(np.max(np.divide(np.abs(residual), scale, out=np.zeros_like(scale), where=scale != 0), initial=0))


def physical_memory() -> float:
    """Bytes of the machine's memory; infinity where the system does not tell."""
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

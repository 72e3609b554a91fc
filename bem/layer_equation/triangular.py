"""Cholesky factors and solves of the integral equations, by LAPACK itself."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from contact.answer.compiled_files import lapack
from contact.answer.one_thread import one_thread
from contact.records.errors import NotConvergedError
from contact.records.validation import FloatArray

# Side of the squares that a matrix is mirrored by: two of them take 64 kB; chosen.
_SQUARE = 64
# Largest section of a factor that is copied for LAPACK, 8 MB; larger ones are solved in blocks of this size. Chosen.
_COPIED = 1024


def equation_factor(kernel: FloatArray, root: FloatArray, ratio: float) -> FloatArray:
    """Lower factor of I - sqrt(w) K sqrt(w), K = (2/pi) L.

    Args:
        kernel: L at the nodes, shape (n, n), symmetric; it is overwritten, since it may fill a hundred megabytes.
        root: sqrt(w), shape (n,).
        ratio: Largest a/h, for the message.

    Raises:
        NotConvergedError: If the matrix is not positive definite in double precision.
    """
    kernel *= 2 / np.pi
    kernel *= root[:, None]
    kernel *= -root
    kernel[np.diag_indices_from(kernel)] += 1
    with one_thread:
        # LAPACK counts in columns: what lies row by row it would copy first.
        _mirror(kernel)
        lower, failed = lapack().dpotrf(kernel.T, lower=True, overwrite_a=True, clean=True)
    if failed:
        message = f"the layer's equation up to a/h = {ratio:g} is singular to double precision; ask for a smaller a/h"
        raise NotConvergedError(message)
    return np.asarray(lower)


def _mirror(matrix: FloatArray) -> None:
    """Write the lower triangle onto the upper one, in place, by squares that fit into the cache."""
    for start in range(0, len(matrix), _SQUARE):
        for column in range(start, len(matrix), _SQUARE):
            upper = matrix[start : start + _SQUARE, column : column + _SQUARE]
            lower = matrix[column : column + _SQUARE, start : start + _SQUARE]
            upper[:] = lower.T if column > start else np.tril(lower) + np.tril(lower, -1).T


def solve_lower(lower: FloatArray, right: FloatArray, *, transposed: bool = False) -> FloatArray:
    """Solution of C x = b, or of C^T x = b; only the lower triangle of C is read.

    Raises:
        NotConvergedError: If C is singular.
    """
    if not right.size:
        return np.zeros_like(right)
    if len(lower) > _COPIED and not lower.flags.forc:
        return _solve_in_blocks(lower, right, transposed=transposed)
    # LAPACK counts in columns: a matrix that lies in memory row by row is its own transpose there.
    by_columns = lower.flags.f_contiguous
    with one_thread:
        solution, failed = lapack().dtrtrs(
            lower if by_columns else lower.T, right, lower=by_columns, trans=transposed == by_columns
        )
    if failed:
        raise NotConvergedError(f"the factor is singular in row {failed - 1}")
    return np.asarray(solution)


def _solve_in_blocks(lower: FloatArray, right: FloatArray, *, transposed: bool) -> FloatArray:
    """The same block by block, since LAPACK would copy a section of a factor: a hundred megabytes at a/h = 159."""
    solution, ends = right.copy(), [*range(0, len(lower), _COPIED), len(lower)]
    blocks = [slice(*pair) for pair in pairwise(ends)]
    with one_thread:
        for block in reversed(blocks) if transposed else blocks:
            if transposed:
                solution[block] -= lower[block.stop :, block].T @ solution[block.stop :]
            else:
                solution[block] -= lower[block, : block.start] @ solution[: block.start]
            solution[block] = solve_lower(lower[block, block], solution[block], transposed=transposed)
    return solution


def positive_factor(matrix: FloatArray) -> FloatArray:
    """Lower Cholesky factor of a symmetric positive definite matrix, of which only the lower triangle is read.

    Raises:
        numpy.linalg.LinAlgError: If it is not positive definite in double precision.
    """
    factor, failed = lapack().dpotrf(matrix, lower=True, clean=False)
    if failed:
        raise np.linalg.LinAlgError(f"the leading minor of order {failed} is not positive definite")
    return np.asarray(factor)


def solve_factored(factor: FloatArray, loads: FloatArray) -> FloatArray:
    """Solution of A x = b from the lower Cholesky factor of A."""
    return np.asarray(lapack().dpotrs(factor, loads, lower=True)[0])


def solve_positive(matrix: FloatArray, loads: FloatArray) -> FloatArray:
    """Solution of A x = b for a symmetric positive definite A; only its lower triangle is read.

    Raises:
        numpy.linalg.LinAlgError: If it is not positive definite in double precision.
    """
    return solve_factored(positive_factor(matrix), loads)

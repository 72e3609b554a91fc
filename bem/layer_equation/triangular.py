"""Cholesky factors and triangular solves of the integral equations, by LAPACK itself."""

from __future__ import annotations

import numpy as np

from contact import NotConvergedError
from contact.answer.lapack import lapack
from contact.answer.one_thread import one_thread
from contact.records.validation import FloatArray


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
        lower, failed = lapack().dpotrf(kernel, lower=True, overwrite_a=True, clean=True)
    if failed:
        message = f"the layer's equation up to a/h = {ratio:g} is singular to double precision; ask for a smaller a/h"
        raise NotConvergedError(message)
    return np.asarray(lower)


def solve_lower(lower: FloatArray, right: FloatArray, *, transposed: bool = False) -> FloatArray:
    """Solution of C x = b, or of C^T x = b; only the lower triangle of C is read.

    Raises:
        NotConvergedError: If C is singular.
    """
    if not right.size:
        return np.zeros_like(right)
    # LAPACK counts in columns: a matrix that lies in memory row by row is its own transpose there.
    by_columns = lower.flags.f_contiguous
    with one_thread:
        solution, failed = lapack().dtrtrs(
            lower if by_columns else lower.T, right, lower=by_columns, trans=transposed == by_columns
        )
    if failed:
        raise NotConvergedError(f"the factor is singular in row {failed - 1}")
    return np.asarray(solution)

"""Cholesky factors and triangular solves of the integral equations.

SciPy's linear algebra is loaded at the first factorisation: who imports the package to describe a scene need not wait.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from contact import NotConvergedError
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
    from scipy.linalg import cholesky  # noqa: PLC0415

    kernel *= 2 / np.pi
    kernel *= root[:, None]
    kernel *= -root
    kernel[np.diag_indices_from(kernel)] += 1
    try:
        with one_thread:
            lower: FloatArray = cholesky(kernel, lower=True, overwrite_a=True, check_finite=False)
    except np.linalg.LinAlgError:
        message = f"the layer's equation up to a/h = {ratio:g} is singular to double precision; ask for a smaller a/h"
        raise NotConvergedError(message) from None
    return lower


def solve_lower(lower: FloatArray, right: FloatArray, *, transposed: bool = False) -> FloatArray:
    """Solution of C x = b, or of C^T x = b; only the lower triangle of C is read."""
    from scipy.linalg import solve_triangular  # noqa: PLC0415

    trans: Literal[0, 1] = 1 if transposed else 0
    with one_thread:
        solution: FloatArray = solve_triangular(lower, right, lower=True, trans=trans, check_finite=False)
    return solution

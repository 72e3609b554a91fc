"""LAPACK called directly gives SciPy's answers digit for digit, and takes no second matrix."""

import tracemalloc

import numpy as np
import pytest
import scipy.linalg

from bem.layer_equation.triangular import equation_factor, solve_lower, solve_positive
from contact import NotConvergedError
from contact.answer.one_thread import one_thread


def kernel(size, seed=22):
    random = np.random.default_rng(seed).uniform(-0.5, 0.5, (size, size)) / size
    return random + random.T


def test_the_factor_is_scipys_in_the_memory_of_the_matrix():
    K, root = kernel(300), np.random.default_rng(1).uniform(0.5, 1.0, 300)
    matrix = K * (2 / np.pi) * root[:, None] * -root
    matrix[np.diag_indices(300)] += 1
    lower = equation_factor(K, root, 1.0)
    # Other numbers of threads add up in another order.
    with one_thread:
        assert np.array_equal(lower, scipy.linalg.cholesky(matrix, lower=True))
    assert np.shares_memory(lower, K)


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("transposed", [False, True])
@pytest.mark.parametrize("shape", [(40,), (40, 3), (40, 0)])
def test_triangular_solutions_are_scipys(order, transposed, shape):
    lower = np.asarray(np.tril(kernel(40)) + np.eye(40), order=order)
    right = np.random.default_rng(2).normal(size=shape)
    expected = scipy.linalg.solve_triangular(lower, right, lower=True, trans=int(transposed))
    assert np.array_equal(solve_lower(lower, right, transposed=transposed), expected)


@pytest.mark.parametrize("transposed", [False, True])
def test_sections_of_large_factors_are_solved_without_a_copy(transposed):
    """LAPACK copies a section of a matrix: at a/h = 159 that took 116 MB for each solution."""
    size = 2300
    whole = np.tril(kernel(size + 100)) + np.eye(size + 100)
    section = whole[:size, :size]
    right = np.random.default_rng(2).normal(size=(size, 2))
    expected = scipy.linalg.solve_triangular(section, right, lower=True, trans=int(transposed))
    tracemalloc.start()
    found = solve_lower(section, right, transposed=transposed)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-13 * np.abs(expected).max())
    assert peak < section.nbytes / 2


def test_positive_solutions_are_scipys():
    matrix, load = kernel(40) + np.eye(40), np.arange(40.0)
    expected = scipy.linalg.cho_solve(scipy.linalg.cho_factor(matrix, lower=True), load)
    assert np.array_equal(solve_positive(matrix, load), expected)


def test_what_is_not_positive_is_told():
    with pytest.raises(NotConvergedError, match="a/h = 3 is singular"):
        equation_factor(np.full((4, 4), 10.0), np.ones(4), 3.0)
    with pytest.raises(np.linalg.LinAlgError, match="order 1"):
        solve_positive(-np.eye(2), np.ones(2))
    with pytest.raises(NotConvergedError, match="row 1"):
        solve_lower(np.diag([1.0, 0.0]), np.ones(2))

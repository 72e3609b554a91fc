"""Factors by blocks are the dense ones to roundings, in a multiple of n numbers."""

import tracemalloc

import numpy as np
import pytest

from bem.layer_equation.factors.blocks import BLOCK, block_factor
from bem.layer_equation.factors.dense import dense_factor
from bem.layer_equation.factors.shifted_kernel import ShiftedKernel
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.polynomials.gauss_panels import gauss_nodes
from contact import NotConvergedError

EPS = np.finfo(float).eps
# Support, Poisson's ratio, panels, width of each in thicknesses and its nodes; the last block is not full in any.
LAYERS = [("bonded", 0.5, 37, 1.0, 12), ("bonded", 0.3, 21, 0.5, 24), ("unbonded", 0.3, 13, 8.0, 36)]


@pytest.fixture(scope="module", params=LAYERS, ids=str)
def factors(request):
    support, poissons_ratio, panels, width, count = request.param
    kernel = FredholmKernel.of_layer(support, poissons_ratio)
    return count, block_factor(kernel, panels, width, count), dense_factor(kernel, panels, width, count)


def test_kernels_left_by_earlier_panels_are_those_of_the_dense_factor(factors):
    """They differ as roundings of the matrix make them differ, which A^-1 multiplies."""
    _, (_, schur), (lower, exact) = factors
    growth = np.linalg.norm(np.linalg.inv(lower.matrix), 2) ** 2
    assert np.max(np.abs(schur - exact)) < 4 * EPS * growth


@pytest.mark.parametrize("transposed", [False, True])
def test_leading_sections_of_every_size_are_solved(factors, transposed):
    """Seen to fail without the columns of a part of a block."""
    count, (blocks, _), (dense, _) = factors
    for size in (count, BLOCK - BLOCK % count, BLOCK - BLOCK % count + count, len(dense)):
        right = np.random.default_rng(size).normal(size=(size, 2))
        found, expected = (lower.solve(right, transposed=transposed) for lower in (blocks, dense))
        section = dense.matrix[:size, :size].T if transposed else dense.matrix[:size, :size]
        # What is left of the equation, and not the solution, is small to roundings.
        assert np.max(np.abs(section @ found - right)) < 200 * EPS * np.abs(expected).max()
        alone = blocks.solve(right[:, 0], transposed=transposed)
        np.testing.assert_allclose(alone, found[:, 0], rtol=0.0, atol=200 * EPS * np.abs(found).max())


def test_rows_and_their_products_are_those_of_the_dense_factor(factors):
    count, (blocks, _), (dense, _) = factors
    growth = np.linalg.norm(np.linalg.inv(dense.matrix), 2)
    for start in range(0, len(dense), count):
        row = blocks.row(start, start + count)
        assert row.shape == (count, start)
        assert np.all(np.abs(row - dense.row(start, start + count)) < 10 * EPS * growth)
    z = np.random.default_rng(1).normal(size=len(dense))
    own = np.array([blocks.row(s, s + count) @ z[:s] for s in range(0, len(dense), count)])
    np.testing.assert_allclose(blocks.from_earlier(z, count), own, rtol=0.0, atol=100 * EPS * np.abs(z).max())
    assert len(blocks) == len(dense)


@pytest.mark.parametrize(("support", "poissons_ratio"), [("bonded", 0.5), ("bonded", 0.45), ("unbonded", 0.0)])
def test_powers_of_the_shift_give_the_kernel_at_any_distance(support, poissons_ratio):
    """Seen to fail with fewer functions, those above 1e-12 of the largest."""
    kernel = FredholmKernel.of_layer(support, poissons_ratio)
    x, weights = gauss_nodes(20)
    joined = ShiftedKernel.of_kernel(kernel, 4.0 * x, 4.0 * weights, 4.0, 40)
    state = joined.mirrored
    for block in range(1, 79):
        exact = kernel.products(4.0 * x, 4.0 * (block + x))
        error = np.sqrt(16.0 * np.multiply.outer(weights, weights)) * np.abs(joined.functions @ state - exact)
        assert error.max() < EPS / 2
        state = joined.shift @ state


def test_blocks_take_a_multiple_of_the_unknowns():
    """The dense factor of so many takes 118 MB."""
    kernel = FredholmKernel.of_layer("bonded", 0.5)
    tracemalloc.start()
    lower, _ = block_factor(kernel, 160, 1.0, 24)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 40e6
    assert sum(part.nbytes for part in [*lower.diagonal, *lower.columns]) < 8e6


def test_a_singular_equation_is_told():
    kernel = FredholmKernel.of_layer("bonded", 0.5)
    stronger = FredholmKernel(kernel.rates, 1.2 * kernel.weights)
    with pytest.raises(NotConvergedError, match="singular to double precision"):
        block_factor(stronger, 30, 1.0, 12)

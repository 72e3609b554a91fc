import numpy as np
import pytest

from bem.grid.transforms import FullTransform, QuarterTransform, convolution_symbol, fast_period, quarter_transform
from contact import InvalidInput

RANDOM = np.random.default_rng(20231113)


def mirrored(quadrant):
    half = np.concatenate([quadrant[::-1], quadrant])
    return np.concatenate([half[:, ::-1], half], axis=1)


def direct_convolution(field, kernel):
    n = len(field)
    i, j = np.indices((n, n))
    return np.array([[np.sum(kernel[abs(i - a), abs(j - b)] * field) for b in range(n)] for a in range(n)])


@pytest.mark.parametrize("period", [24, 30])
def test_padded_filter_is_the_direct_sum(period):
    field, kernel = RANDOM.random((12, 12)), RANDOM.random((period // 2 + 1, period // 2 + 1))
    transform = FullTransform(12, period)
    filtered = transform.filter(field, convolution_symbol(transform, kernel))
    np.testing.assert_allclose(filtered, direct_convolution(field, kernel), rtol=1e-13)


def test_quarter_filter_is_the_quadrant_of_the_full_one():
    quadrant, kernel = RANDOM.random((8, 8)), RANDOM.random((17, 17))
    full, quarter = FullTransform(16, 32), QuarterTransform(8, 32)
    expected = full.filter(mirrored(quadrant), convolution_symbol(full, kernel))[8:, 8:]
    np.testing.assert_allclose(quarter.filter(quadrant, convolution_symbol(quarter, kernel)), expected, rtol=1e-13)


def test_unit_symbol_returns_the_field_and_padding_stays_clean_on_a_second_call():
    for transform in (FullTransform(10, 24), QuarterTransform(5, 24)):
        rows, columns = transform.modes
        unit = np.ones(np.broadcast_shapes(rows.shape, columns.shape))
        for _ in range(2):
            field = RANDOM.random((transform.cells, transform.cells))
            np.testing.assert_allclose(transform.filter(field, unit), field, rtol=1e-13)


def test_results_repeat_bit_by_bit():
    field, kernel = RANDOM.random((16, 16)), RANDOM.random((17, 17))
    transforms = [FullTransform(16, 32) for _ in range(3)]
    first, *others = [t.filter(field, convolution_symbol(t, kernel)) for t in transforms]
    for other in others:
        np.testing.assert_array_equal(first, other)


def test_fast_period_is_even_and_large_enough():
    for least in (7, 64, 1021, 2 * 397):
        assert fast_period(least) >= least
        assert fast_period(least) % 2 == 0


@pytest.mark.parametrize(("cells", "period"), [(1, 4), (8, 6), (8, 15)])
def test_impossible_sizes_are_refused(cells, period):
    with pytest.raises(InvalidInput, match="even period"):
        FullTransform(cells, period)


def test_kernel_of_another_period_is_refused():
    with pytest.raises(InvalidInput, match="shape"):
        convolution_symbol(FullTransform(8, 16), np.ones((8, 8)))


def test_plans_of_one_size_are_made_once():
    assert quarter_transform(15, 60) is quarter_transform(15, 60)

import numpy as np
import pytest

from bem.polynomials.chebyshev import FEW_POWERS, powers


@pytest.mark.parametrize("count", [2, 17])
def test_few_and_many_points_have_the_same_powers_to_the_last_bit(count):
    z = np.random.default_rng(22).uniform(-1.0, 1.0, 3 * FEW_POWERS)
    many = powers(z, count)
    few = np.concatenate([powers(part, count) for part in np.split(z, 3)], axis=1)
    np.testing.assert_array_equal(many, few)
    np.testing.assert_array_equal(many[1], z)
    np.testing.assert_array_equal(many[0], np.ones(z.size))

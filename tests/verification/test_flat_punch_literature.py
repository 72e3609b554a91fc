"""Pressures under flat punches on layers against values that others computed from the same Fredholm equation."""

import numpy as np
import pytest

from contact import Layer
from docs.gallery._flat_punch import FlatPunchValues

# p/p_mean at r/a = 0, .2, .4, .6, .8, .9, .95, bonded, nu = 0.5, to five decimals; same equation, solved by others.
PRESSURE = {
    0.5: (0.57272, 0.57955, 0.60398, 0.66357, 0.83551, 1.11163, 1.52375),
    1.0: (0.77986, 0.77516, 0.76447, 0.76275, 0.83249, 1.01177, 1.31895),
    2.0: (1.03449, 1.02196, 0.98222, 0.91203, 0.83638, 0.87139, 1.02691),
    5.0: (1.33947, 1.31010, 1.22200, 1.07478, 0.85774, 0.71988, 0.68681),
}


@pytest.mark.parametrize("ratio", PRESSURE)
def test_pressure_under_the_punch(ratio):
    rho = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95])
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5)
    computed = FlatPunchValues(layer).smooth_pressure(rho, ratio) / np.sqrt(1 - rho**2)
    np.testing.assert_allclose(computed, PRESSURE[ratio], rtol=0, atol=0.51e-5)

"""Flat punches on layers against tables, and against identities that need no reference.

Values to twelve digits come from the same Fredholm equation solved radius by radius to 1e-12 by others; the tables of
the literature are used within their own accuracy.
"""

import numpy as np
import pytest

from contact import Layer
from docs.gallery._flat_punch import FlatPunchValues

BONDED = {nu: Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu) for nu in (0.3, 0.35, 0.4, 0.45, 0.5)}
LAYERS = BONDED | {"unbonded": Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3, support="unbonded")}
# p/p_mean at r/a = 0, .2, .4, .6, .8, .9, .95, bonded, nu = 0.5, to five decimals; same equation, solved by others.
PRESSURE = {
    0.5: (0.57272, 0.57955, 0.60398, 0.66357, 0.83551, 1.11163, 1.52375),
    1.0: (0.77986, 0.77516, 0.76447, 0.76275, 0.83249, 1.01177, 1.31895),
    2.0: (1.03449, 1.02196, 0.98222, 0.91203, 0.83638, 0.87139, 1.02691),
    5.0: (1.33947, 1.31010, 1.22200, 1.07478, 0.85774, 0.71988, 0.68681),
}


@pytest.mark.first(1)
@pytest.mark.parametrize("layer", LAYERS)
def test_spring_stiffness_is_the_derivative_of_the_contact_stiffness(layer):
    """c_bar = d(xi k_bar)/dxi, Eq. (10): y1^2 against sixth-order differences of k_bar, which err by about 1e-11."""
    solution, xi, step = FlatPunchValues(LAYERS[layer]), np.linspace(0.1, 19.0, 200), 0.01
    area = {k: (xi + k * step) * solution.normalized_contact_stiffness(xi + k * step) for k in range(-3, 4)}
    slope = sum(c * (area[k] - area[-k]) for k, c in [(1, 45), (2, -9), (3, 1)]) / (60 * step)
    np.testing.assert_allclose(solution.normalized_spring_stiffness(xi), slope, rtol=1e-10)


@pytest.mark.parametrize("ratio", PRESSURE)
def test_pressure_under_the_punch(ratio):
    rho = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95])
    computed = FlatPunchValues(LAYERS[0.5]).smooth_pressure(rho, ratio) / np.sqrt(1 - rho**2)
    np.testing.assert_allclose(computed, PRESSURE[ratio], rtol=0, atol=0.51e-5)


@pytest.mark.parametrize("layer", LAYERS)
def test_mean_pressure_is_one_half_in_its_normalisation(layer):
    """int p_bar rho drho = 1/2, with rho = sin(theta); 80 Gauss nodes leave rounding."""
    x, w = np.polynomial.legendre.leggauss(80)
    theta = np.pi / 4 * (1 + x)
    for ratio in (1e-3, 0.3, 1.7, 12.4):
        q = FlatPunchValues(LAYERS[layer]).smooth_pressure(np.sin(theta), ratio)
        assert np.sum(q * np.sin(theta) * w) * np.pi / 4 == pytest.approx(0.5, rel=1e-12, abs=0.0)

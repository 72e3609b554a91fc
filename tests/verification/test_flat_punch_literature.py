"""Flat punches on layers against tables, and against identities that need no reference.

Values to twelve digits come from the same Fredholm equation solved radius by radius to 1e-12 by others; the tables of
the literature are used within their own accuracy.
"""

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from contact import Layer

SOURCE = IntegralEquation()
BONDED = {nu: Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu) for nu in (0.3, 0.35, 0.4, 0.45, 0.5)}
LAYERS = BONDED | {"unbonded": Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3, support="unbonded")}
TWELVE_DIGITS = {  # k_bar at a/h = 0.2, 1, 2
    0.3: (1.20655824090, 2.48352462914, 4.35324429030),
    0.4: (1.23225336443, 2.79376800243, 5.29854688001),
    0.45: (1.25233991738, 3.09140806745, 6.42058801854),
    0.5: (1.28063660581, 3.61873584896, 9.14945045204),
    # The middle value is ours: the source prints 2.19862136617, which differs by 5e-10. A solution with its own
    # quadrature (test_integral_equation_method) gives 2.198621365666 as well, so we take the print to be a slip.
    "unbonded": (1.17102775645, 2.19862136567, 3.72760647995),
}
# Hayes, Keer, Herrmann and Mockros, J. Biomech. 5 (1972) 541, bonded, as quoted in programs that cite the paper. The
# column for nu = 0.5 reads low for large a/h; 0.1 % + 0.8 % a/h is the accuracy that others ascribe to the table.
HAYES = {
    0.3: {0.2: 1.207, 0.4: 1.472, 0.6: 1.784, 0.8: 2.124, 1.0: 2.480, 2.0: 4.336},
    0.45: {0.2: 1.252, 0.4: 1.599, 0.6: 2.031, 0.8: 2.532, 1.0: 3.085, 1.5: 4.638, 2.0: 6.380, 4.0: 14.45, 8.0: 32.15},
    0.5: {0.2: 1.281, 0.4: 1.683, 0.6: 2.211, 0.8: 2.855, 1.0: 3.609, 1.5: 5.970, 2.0: 9.069, 4.0: 30.75, 8.0: 137.7},
}
# p/p_mean at r/a = 0, .2, .4, .6, .8, .9, .95, bonded, nu = 0.5, to five decimals; same equation, solved by others.
PRESSURE = {
    0.5: (0.57272, 0.57955, 0.60398, 0.66357, 0.83551, 1.11163, 1.52375),
    1.0: (0.77986, 0.77516, 0.76447, 0.76275, 0.83249, 1.01177, 1.31895),
    2.0: (1.03449, 1.02196, 0.98222, 0.91203, 0.83638, 0.87139, 1.02691),
    5.0: (1.33947, 1.31010, 1.22200, 1.07478, 0.85774, 0.71988, 0.68681),
}


@pytest.mark.parametrize("layer", TWELVE_DIGITS)
def test_contact_stiffness_to_ten_digits(layer):
    computed = SOURCE.punch(LAYERS[layer]).normalized_contact_stiffness([0.2, 1.0, 2.0])
    np.testing.assert_allclose(computed, TWELVE_DIGITS[layer], rtol=0, atol=1e-11)


@pytest.mark.parametrize("nu", HAYES)
def test_hayes_table(nu):
    ratios = np.array(list(HAYES[nu]))
    computed = SOURCE.punch(BONDED[nu]).normalized_contact_stiffness(ratios)
    assert np.all(np.abs(np.array(list(HAYES[nu].values())) / computed - 1) < 1e-3 + 8e-3 * ratios)


def test_hermanowicz_polynomials():
    """Hermanowicz, Int. J. Mech. Sci. 193 (2021) 106138: 0.02 % bonded, 0.09 % unbonded, 0.1 <= a/h <= 30."""
    t = np.geomspace(0.1, 30.0, 60)
    short = [0.0, 1.127294838473304, 1.2534743855684407, 0.7845575578931572, -0.8066500581952372, 0.25992549153472266]
    long = [-0.32200988000179354, 1.9372155069019295, 0.8542206369854419, 0.1474038965378127]
    bonded = 1 + np.where(t <= 1.2, np.polyval(short[::-1], t), np.polyval(long[::-1], t))
    short = [0.0, 0.7426462444663599, 0.5708600467411756, 0.008619952995014581, -0.1799716509234812, 0.0574929480459991]
    long = [-0.3838553953270864, 1.553893809221951, 0.00138818040746098, -3.107802923772486e-05]
    unbonded = 1 + np.where(t <= 1.65, np.polyval(short[::-1], t), np.polyval(long[::-1], t))
    np.testing.assert_allclose(SOURCE.punch(LAYERS[0.5]).normalized_contact_stiffness(t), bonded, rtol=2e-4)
    layer = LAYERS["unbonded"]
    np.testing.assert_allclose(SOURCE.punch(layer).normalized_contact_stiffness(t), unbonded, rtol=9e-4)


@pytest.mark.parametrize("layer", LAYERS)
def test_spring_stiffness_is_the_derivative_of_the_contact_stiffness(layer):
    """c_bar = d(xi k_bar)/dxi, Eq. (10): y1^2 against sixth-order differences of k_bar, which err by about 1e-11."""
    solution, xi, step = SOURCE.punch(LAYERS[layer]), np.linspace(0.1, 19.0, 200), 0.01
    area = {k: (xi + k * step) * solution.normalized_contact_stiffness(xi + k * step) for k in range(-3, 4)}
    slope = sum(c * (area[k] - area[-k]) for k, c in [(1, 45), (2, -9), (3, 1)]) / (60 * step)
    np.testing.assert_allclose(solution.normalized_spring_stiffness(xi), slope, rtol=1e-10)


def test_edge_density_at_printed_ratios():
    """c_bar, bonded nu = 0.5, as the square of the density at the edge."""
    computed = SOURCE.punch(LAYERS[0.5]).normalized_spring_stiffness([0.3, 1.0, 3.0])
    np.testing.assert_allclose(computed, [2.070687, 7.684546, 51.276522], atol=0.51e-6)


@pytest.mark.parametrize("ratio", PRESSURE)
def test_pressure_under_the_punch(ratio):
    rho = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95])
    computed = SOURCE.punch(LAYERS[0.5]).smooth_pressure(rho, ratio) / np.sqrt(1 - rho**2)
    np.testing.assert_allclose(computed, PRESSURE[ratio], rtol=0, atol=0.51e-5)


@pytest.mark.parametrize("layer", LAYERS)
def test_mean_pressure_is_one_half_in_its_normalisation(layer):
    """int p_bar rho drho = 1/2, with rho = sin(theta); 80 Gauss nodes leave rounding."""
    x, w = np.polynomial.legendre.leggauss(80)
    theta = np.pi / 4 * (1 + x)
    for ratio in (1e-3, 0.3, 1.7, 12.4):
        q = SOURCE.punch(LAYERS[layer]).smooth_pressure(np.sin(theta), ratio)
        assert np.sum(q * np.sin(theta) * w) * np.pi / 4 == pytest.approx(0.5, rel=1e-12, abs=0.0)


def test_the_centre_becomes_the_maximum_at_the_known_ratio():
    """p is flat in the middle (p'' = 0 at r = 0) at a/h = 0.788, bonded nu = 0.5."""
    solution, rho = SOURCE.punch(LAYERS[0.5]), np.array([0.0, 0.03])

    def curvature(ratio):
        middle, beside = solution.smooth_pressure(rho, ratio) / np.sqrt(1 - rho**2)
        return beside - middle

    assert curvature(0.7875) > 0 > curvature(0.7895)

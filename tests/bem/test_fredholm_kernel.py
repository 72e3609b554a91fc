"""The difference kernel N(s) against its definition, integrated in 30 digits on the real axis."""

import mpmath
import numpy as np
import pytest

from bem.kernels.layer import compliance_kernel, zero_mode
from bem.layer_equation.fredholm_kernel import FredholmKernel
from bem.polynomials.gauss_panels import gauss_nodes

LAYERS = [("unbonded", 0.3), ("bonded", 0.0), ("bonded", 0.3), ("bonded", 0.5)]
ROUNDING = 2e-15  # 380 terms of size below 1 are added


def defining_integral(s, support, nu):
    kappa = 3 - 4 * mpmath.mpf(nu)

    def complement(q):
        if support == "unbonded":
            return 1 - 2 * mpmath.sinh(q) ** 2 / (2 * q + mpmath.sinh(2 * q)) if q else mpmath.mpf(1)
        return 1 - (2 * kappa * mpmath.sinh(2 * q) - 4 * q) / (1 + 4 * q**2 + kappa**2 + 2 * kappa * mpmath.cosh(2 * q))

    return mpmath.quad(lambda q: complement(q) * mpmath.cos(q * s), mpmath.linspace(0, 40, 41), maxdegree=4)


@pytest.mark.parametrize(("support", "nu"), LAYERS)
def test_kernel_equals_its_defining_integral(support, nu):
    distances = [0.0, 0.4, 2.0, 5.0]
    with mpmath.workdps(30):
        exact = [float(defining_integral(s, support, nu)) for s in distances]
    np.testing.assert_allclose(FredholmKernel.of_layer(support, nu)(distances), exact, rtol=0, atol=ROUNDING)


@pytest.mark.parametrize(
    ("support", "nu", "order"),
    [("bonded", 0.3, 2), ("unbonded", 0.3, 4), ("bonded", 0.0, 4)],  # chi has no cubic term in the last two
)
def test_tail_is_the_slope_of_chi_at_zero_over_distance_squared(support, nu, order):
    distances = np.array([100.0, 200.0])
    scaled = FredholmKernel.of_layer(support, nu)(distances) * distances**2
    errors = scaled / zero_mode(support, nu) - 1  # -int k cos(ks) dk = 1/s^2 (Abel)
    assert errors[0] / errors[1] == pytest.approx(2.0**order, rel=0.05, abs=0.0)
    assert abs(errors[1]) < 1e-3


def test_tail_of_the_incompressible_bonded_layer_falls_with_the_fourth_power():
    distances = np.array([50.0, 100.0])
    cubic = compliance_kernel(1e-4, "bonded", 0.5) / 1e-12  # 2/3
    scaled = FredholmKernel.of_layer("bonded", 0.5)(distances) * distances**4
    np.testing.assert_allclose(scaled, -6 * cubic, rtol=2e-2)  # int k^3 cos(ks) dk = 6/s^4 (Abel)


@pytest.mark.parametrize(("support", "nu"), LAYERS)
def test_panel_matrix_equals_pointwise_evaluation(support, nu):
    kernel, width, panels, count = FredholmKernel.of_layer(support, nu), 0.7, 4, 6
    x = (width * (np.arange(panels)[:, None] + gauss_nodes(count)[0])).ravel()
    direct = (kernel(abs(x[:, None] - x)) + kernel(x[:, None] + x)) / 2
    np.testing.assert_allclose(kernel.panel_matrix(panels, width, count), direct, rtol=0, atol=ROUNDING)

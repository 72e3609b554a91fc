import numpy as np
import pytest

from bem.grid.calibrated_disc import PixelDisc
from bem.layer_equation.flat_punch_source import IntegralEquation
from contact import Layer

KERNELS = [("bonded", 0.3), ("bonded", 0.5), ("unbonded", 0.0)]


@pytest.fixture(scope="module", params=[False, True], ids=["free space", "periodic"])
def disc(request):
    return PixelDisc.measured(128, periodic=request.param)


def exact(support, nu, ratio):
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu, support=support)
    return IntegralEquation().solution(layer, ratio)


def test_effective_radius_lies_within_half_a_cell_of_the_drawn_one(disc):
    assert disc.radius == pytest.approx(0.97 * 64, abs=0.5)


@pytest.mark.parametrize(("support", "nu"), KERNELS)
def test_stiffness_is_that_of_the_integral_equation(disc, support, nu):
    # independent method; the tolerance is ten times the second-order error measured at s/h = 0.08
    solution = disc.solve(5.0, support, nu, None)
    assert solution.stiffness == pytest.approx(
        exact(support, nu, 5.0).normalized_contact_stiffness(5.0), rel=5e-4, abs=0.0
    )


def test_stiffness_error_is_of_second_order_and_far_below_the_staircase_error():
    errors = []
    for cells in (64, 128, 256):
        punch = PixelDisc.measured(cells, periodic=True).solve(10.0, "bonded", 0.3, None)
        errors.append(punch.stiffness / exact("bonded", 0.3, 10.0).normalized_contact_stiffness(10.0) - 1.0)
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, 2.5, atol=0.7)
    assert abs(errors[-1]) < 1e-5


def test_shape_is_normalised(disc):
    shape = disc.solve(5.0, "bonded", 0.3, None).shape
    theta = (np.arange(2000) + 0.5) * np.pi / 4000
    q = np.polynomial.chebyshev.chebval(2.0 * np.sin(theta) ** 2 - 1.0, shape)
    assert np.sum(q * np.sin(theta)) * np.pi / 4000 == pytest.approx(0.5, rel=1e-6, abs=0.0)


def test_shape_is_near_the_exact_pressure(disc):
    shape = disc.solve(5.0, "bonded", 0.3, None).shape
    rho = np.sin((np.arange(200) + 0.5) * np.pi / 400)
    expected = exact("bonded", 0.3, 5.0).smooth_pressure(rho, 5.0)
    q = np.polynomial.chebyshev.chebval(2.0 * rho**2 - 1.0, shape)
    assert np.max(np.abs(q - expected)) < 0.01 * np.max(expected)


def test_unit_shape_of_the_half_space_is_recovered_for_a_thick_layer(disc):
    # Eq. (14): q = 1/2 everywhere
    if not disc.periodic:
        shape = disc.solve(1e-3, "bonded", 0.5, None).shape
        assert shape[0] == pytest.approx(0.5, rel=1e-6, abs=0.0)
        assert np.max(np.abs(shape[1:])) < 1e-6

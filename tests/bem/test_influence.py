import mpmath
import numpy as np
import pytest

from bem.grid.influence import (
    REACH,
    band_limited_influence,
    correction_function,
    layer_influence,
    rectangle_influence,
)
from bem.kernels.layer import one_minus_kernel

KERNELS = [("bonded", 0.3), ("bonded", 0.5), ("unbonded", 0.0)]


def test_cell_under_its_own_pressure_sinks_by_the_closed_form():
    # int_[-1/2,1/2]^2 dA/r = 4 ln(1 + sqrt 2)
    assert rectangle_influence(3)[0, 0] == pytest.approx(4.0 * np.log(1.0 + np.sqrt(2.0)) / np.pi, rel=1e-14, abs=0.0)


@pytest.mark.parametrize("offset", [(1, 0), (1, 1), (3, 2)])
def test_rectangle_solution_is_the_integral_of_one_over_r(offset):
    i, j = offset
    with mpmath.workdps(20):
        integral = mpmath.quad(
            lambda x, y: 1 / mpmath.sqrt((i - x) ** 2 + (j - y) ** 2), [-0.5, 0, 0.5], [-0.5, 0, 0.5]
        )
    assert rectangle_influence(5)[i, j] == pytest.approx(float(integral) / np.pi, rel=1e-9, abs=0.0)


def test_far_cells_act_as_point_forces_to_the_next_order():
    # int_cell dA/r = 1/r + (1/24) laplacian(1/r) + O(r^-5) = 1/r + 1/(24 r^3)
    r = 400.0
    assert rectangle_influence(400)[400, 0] * np.pi == pytest.approx(1.0 / r + 1.0 / (24.0 * r**3), rel=1e-9, abs=0.0)


@pytest.mark.parametrize(("support", "nu"), KERNELS)
def test_correction_is_the_hankel_integral(support, nu):
    smooth = correction_function(support, nu)
    for rho in (0.0, 0.3, 2.0, 7.0):
        with mpmath.workdps(20):
            integral = mpmath.quad(
                lambda q, rho=rho: -float(one_minus_kernel(float(q), support, nu)) * mpmath.besselj(0, q * rho),
                mpmath.linspace(0, 30, 31),
            )
        assert float(smooth(rho)) == pytest.approx(float(integral), abs=2e-9)


@pytest.mark.parametrize(("support", "nu"), KERNELS)
def test_correction_cancels_the_half_space_far_away(support, nu):
    assert float(correction_function(support, nu)(REACH)) == pytest.approx(-1.0 / REACH, abs=1e-14)


@pytest.mark.parametrize("thickness", [0.3, 2.0, 6.0])
def test_layer_far_field_decays_exponentially(thickness):
    # at 10 h even the slowest kernel has fallen by exp(-7.4); it may be negative: the surface bulges beside a load
    influence = layer_influence(64, thickness, "bonded", 0.5)
    far = int(np.ceil(10 * thickness))
    assert np.max(np.abs(influence[far:])) < 1e-3 * influence[0, 0]
    assert np.all(np.isfinite(influence))


def test_sum_of_the_influence_is_the_response_to_a_uniform_pressure():
    # a uniformly loaded unbonded layer sinks by h chi(q)/q -> 2 * h/2 / E* = h
    influence = layer_influence(200, 3.0, "unbonded", 0.0)
    total = 4.0 * influence[1:, 1:].sum() + 4.0 * influence[0, 1:].sum() + influence[0, 0]
    assert total == pytest.approx(3.0, rel=1e-9, abs=0.0)


def test_infinite_thickness_is_the_half_space():
    np.testing.assert_array_equal(layer_influence(8, np.inf, "bonded", 0.3), rectangle_influence(8))


def test_band_limited_influence_meets_the_point_force_far_away():
    # the trigonometric interpolant of a point has unit area; its tail beyond the lattice's band decays
    influence = band_limited_influence(64)
    assert influence[40, 23] * np.pi * np.hypot(40, 23) == pytest.approx(1.0, rel=5e-3, abs=0.0)

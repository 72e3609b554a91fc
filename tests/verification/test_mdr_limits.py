"""The limits a/h -> 0 and a/h -> infinity of section 2.1, each with the order in which it is approached."""

import numpy as np
import pytest
from scipy.integrate import quad

from bem.flat_punch import IntegralEquation
from bem.kernels.of_layer import surface_kernel
from contact import Cone, InvalidInput, Layer, Paraboloid, TruncatedCone
from mdr.closed_forms.asymptotic import foundation_modulus, is_film, thin_profile, thin_spring_stiffness
from mdr.closed_forms.truncated_cone import thin_cone_force, thin_cone_pressure, thin_cone_profile
from tests.bed import bed_of
from tests.verification.power_law import stiffness_exponent, stiffness_prefactor

SOURCE = IntegralEquation(nodes=16)  # 2e-9 by its own estimate, far below what a limit at finite a/h can show
LAYERS = {
    "unbonded": Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3, support="unbonded"),
    "bonded 0.3": Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3),
    "bonded 0.45": Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.45),
    "bonded 0.5": Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5),
}
RATIOS = np.array([20.0, 40.0, 80.0])


def integral_of_the_kernel(layer):
    """int_0^inf (1 - chi) dk for a thickness of one."""
    kernel = surface_kernel(layer)
    return quad(lambda k: float(kernel.one_minus_chi(np.array([k]))[0]), 0, 25, limit=200, epsabs=1e-11)[0]


def thin_contact_stiffness(layer, contact_radius):
    """k_N [N/m], Eqs. (16), (18) and (21)."""
    a, h = np.asarray(contact_radius, dtype=float), layer.thickness
    if is_film(layer):
        return np.pi * layer.youngs_modulus * a**4 / (8 * h**3)
    return np.pi * foundation_modulus(layer) * a**2 / h


def thin_flat_punch_pressure(layer, rho):
    """p_bar of a flat punch over rho = r/a: constant, or the parabola of Eq. (19)."""
    return 2 * (1 - rho) * (1 + rho) if is_film(layer) else np.ones_like(rho)


def observed_orders(errors):
    """log2 of the ratio of errors when a/h doubles."""
    return np.log2(np.abs(errors[:-1] / errors[1:]))


def assert_first_order(errors):
    """The observed order tends to 1 as a/h doubles and doubles again."""
    away = np.abs(observed_orders(errors) - 1)
    assert away[-1] < 0.12
    assert away[-1] < away[0] + 0.01


@pytest.mark.parametrize("name", LAYERS)
def test_thick_layers_deviate_linearly_with_the_known_slope(name):
    """k_bar = 1 + (2/pi) N(0) a/h + O((a/h)^2), from one step of successive approximation."""
    layer = LAYERS[name]
    slope = 2 / np.pi * integral_of_the_kernel(layer)
    ratios = np.array([4e-3, 2e-3, 1e-3])
    deviation = SOURCE.punch(layer).normalized_contact_stiffness(ratios) - 1
    remainders = deviation / (slope * ratios) - 1
    np.testing.assert_allclose(np.log2(remainders[:-1] / remainders[1:]), 1, atol=0.02)
    assert abs(remainders[-1]) < 2e-3


def test_slopes_of_thick_layers():
    """(2/pi) int (1 - chi) dq to the digits tabulated for popular AFM series."""
    for support, nu, slope in [
        ("bonded", 0.5, 1.126955),
        ("bonded", 0.45, 1.034807),
        ("bonded", 0.3, 0.876533),
        ("bonded", 0.0, 0.770986),
        ("unbonded", 0.3, 0.743303),
    ]:
        value = (
            2
            / np.pi
            * integral_of_the_kernel(Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu, support=support))
        )
        assert value == pytest.approx(slope, abs=0.51e-6)


@pytest.mark.parametrize("name", LAYERS)
def test_contact_stiffness_of_thin_layers(name):
    """Eqs. (16), (18), (21): first order in h/a."""
    layer = LAYERS[name]
    exact = SOURCE.punch(layer).normalized_contact_stiffness(RATIOS) * 2 * layer.contact_modulus * RATIOS
    errors = thin_contact_stiffness(layer, RATIOS) / exact - 1
    assert_first_order(errors)
    assert abs(errors[-1]) < 0.08


def test_thin_layer_errors_as_tabulated():
    """Relative errors of Table 1 at a/h = 10, 20, 50 in percent, to the printed digit."""
    for name, percent in {
        "bonded 0.5": (-41.8, -24.5, -10.9),
        "bonded 0.45": (11.8, 5.7, 2.2),
        "bonded 0.3": (-2.4, -1.2, -0.5),
    }.items():
        layer, ratios = LAYERS[name], np.array([10.0, 20.0, 50.0])
        exact = SOURCE.punch(layer).normalized_contact_stiffness(ratios) * 2 * layer.contact_modulus * ratios
        errors = 100 * (thin_contact_stiffness(layer, ratios) / exact - 1)
        np.testing.assert_allclose(errors, percent, atol=0.051)


@pytest.mark.parametrize("name", LAYERS)
def test_spring_stiffness_of_thin_layers_is_half_the_derivative(name):
    """Eqs. (17), (20), (22) follow from (16), (18), (21) by Eq. (6); central differences of quartics err by 1e-6."""
    layer, x = LAYERS[name], np.array([3.0, 30.0])
    slope = (thin_contact_stiffness(layer, x * 1.001) - thin_contact_stiffness(layer, x * 0.999)) / (0.002 * x)
    np.testing.assert_allclose(thin_spring_stiffness(layer, x), slope / 2, rtol=2e-6)


@pytest.mark.parametrize("name", LAYERS)
def test_paraboloid_depth_of_thin_layers(name):
    """Table 1: a^2/(2R), or a^2/(4R) for the bonded incompressible layer; first order in h/a."""
    layer = LAYERS[name]
    system = bed_of(layer, Paraboloid(radius_of_curvature=1.0), SOURCE)
    limit = RATIOS**2 / (4 if name == "bonded 0.5" else 2)
    np.testing.assert_allclose(thin_profile(layer, Paraboloid(radius_of_curvature=1.0), RATIOS), limit, rtol=1e-14)
    errors = system.mdr_profile(RATIOS) / limit - 1
    assert_first_order(errors)
    assert abs(errors[-1]) < 0.08


@pytest.mark.parametrize("name", LAYERS)
def test_truncated_cone_on_thin_layers(name):
    """Eqs. (36)-(38), b/a = 1/2: first order in h/a for depth and force."""
    layer, depth_errors, force_errors = LAYERS[name], [], []
    for a in RATIOS:
        cone = TruncatedCone(flat_radius=a / 2, slope=0.1)
        system = bed_of(layer, cone, SOURCE)
        depth_errors.append(float(system.mdr_profile(a) / thin_cone_profile(layer, cone, a)) - 1)
        force_errors.append(float(system.elastic_force(a) / thin_cone_force(layer, cone, a)) - 1)
    for errors in (np.array(depth_errors), np.array(force_errors)):
        assert_first_order(errors)
        assert abs(errors[-1]) < 0.12


@pytest.mark.parametrize("name", LAYERS)
def test_thin_cone_pressure_carries_the_thin_cone_force(name):
    """2 pi int p r dr of Eq. (39) is Eq. (38); likewise Eqs. (17), (22) and (36)."""
    layer, cone, a = LAYERS[name], TruncatedCone(flat_radius=3.0, slope=0.1), 5.0
    x, w = np.polynomial.legendre.leggauss(40)
    force = 0.0
    for low, high in [(0.0, 3.0), (3.0, 5.0)]:
        r = (low + high) / 2 + (high - low) / 2 * x
        force += np.sum(2 * np.pi * r * thin_cone_pressure(layer, cone, a, r) * w) * (high - low) / 2
    assert force == pytest.approx(float(thin_cone_force(layer, cone, a)), rel=1e-13, abs=0.0)


def test_mean_height_agrees_with_the_closed_form_of_the_cone():
    """Eq. (20) integrated against Eq. (37)."""
    layer, cone = LAYERS["bonded 0.5"], TruncatedCone(flat_radius=3.0, slope=0.1)
    x = np.array([3.5, 5.0, 50.0])
    np.testing.assert_allclose(thin_profile(layer, cone, x), thin_cone_profile(layer, cone, x), rtol=1e-13)


@pytest.mark.parametrize("name", LAYERS)
def test_flat_punch_pressure_of_thin_layers(name):
    """Eq. (19) and the constant, in the middle of the punch: first order in h/a."""
    solution, rho = SOURCE.punch(LAYERS[name]), np.array([0.0, 0.5])
    limit = thin_flat_punch_pressure(LAYERS[name], rho)
    errors = np.array([solution.smooth_pressure(rho, a) / np.sqrt(1 - rho**2) / limit - 1 for a in RATIOS])
    assert np.all(np.abs(errors[-1]) < 0.08)
    assert np.all(observed_orders(errors) > 0.85)


def test_exponent_and_prefactor_of_the_stiffness_law():
    """m(1) as computed by others from the radius-by-radius integral equation; limits 0, 1 and 3 of Fig. 5."""
    for name, m in {"unbonded": 0.483722, "bonded 0.3": 0.544110, "bonded 0.5": 0.787580}.items():
        assert float(stiffness_exponent(LAYERS[name], 1.0, SOURCE)) == pytest.approx(m, abs=0.51e-6)
        k = SOURCE.punch(LAYERS[name]).normalized_contact_stiffness(1.0)
        assert float(stiffness_prefactor(LAYERS[name], 1.0, SOURCE)) == pytest.approx(float(k), rel=1e-13, abs=0.0)
    for name, limit in {"unbonded": 1.0, "bonded 0.3": 1.0, "bonded 0.5": 3.0}.items():
        thick, thin = stiffness_exponent(LAYERS[name], np.array([1e-4, 80.0]), SOURCE)
        assert thick == pytest.approx(0.0, abs=2e-4)
        assert thin == pytest.approx(limit, rel=0.06, abs=0.0)


def test_a_half_space_has_no_thin_limit():
    half_space = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3)
    with pytest.raises(InvalidInput, match="thickness = inf"):
        thin_profile(half_space, Cone(slope=0.1), 1.0)

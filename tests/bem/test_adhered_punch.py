"""Adhered flat punches: values of another derivation, limits, and the state they must leave on the surface."""

import math

import mpmath
import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from bem.kernels.layer import one_minus_kernel
from bem.kernels.of_layer import UniformKernel
from bem.kernels.stack import Sheet, StackKernel
from bem.layer_equation.stick.adhered_fields import AdheredFields, tanh_sinh
from bem.layer_equation.stick.adhered_punch import adhered_punch, basis_transforms
from bem.layer_equation.stick.coulomb import coulomb_functions
from bem.layer_equation.stick.frictionless_slip import frictionless_punch, rung_of
from contact import Layer
from tests.bem.adhered_punches import adhered_punches

# nu, a/h, support, k_stick/(2 E* a), c_stick/E*, k/(2 E* a) without friction, Q/N, p and q at a/2 over the mean
# pressure, u_r1 at a/2: another program's values, printed to twelve digits.
EXAMPLES = [
    (
        0.0,
        0.5,
        "bonded",
        1.68500985461,
        2.36336658009,
        1.52508019727,
        0.31338907474,
        0.66096202159,
        0.04145084601,
        -0.098731922354,
    ),
    (
        0.3,
        3.0,
        "bonded",
        6.28701835666,
        12.0365004256,
        6.26129233871,
        -0.01321627317,
        0.89779807830,
        -0.01861960901,
        0.048308253567,
    ),
    (
        0.5,
        3.0,
        "bonded",
        30.1147473241,
        100.033103673,
        18.1573993806,
        -0.25735088808,
        1.18808204080,
        -0.17591592057,
        1.119258664940,
    ),
    (
        0.5,
        3.0,
        "unbonded",
        9.80018722994,
        28.1854296931,
        5.28743077143,
        -0.43248900398,
        1.07809491704,
        -0.26916837291,
        0.737253152241,
    ),
]


@pytest.mark.parametrize("example", EXAMPLES)
def test_values_of_another_program(example):
    nu, ratio, support, k, c, k0, shear, p, q, slip = example
    punch = adhered_punch(ratio, UniformKernel(support, nu))
    assert [punch.stiffness, punch.spring_stiffness] == pytest.approx([k, c], rel=5e-12, abs=0)
    fields, mean = AdheredFields(punch), 2.0 * punch.half_force
    half = np.array([0.5])
    assert [fields.pressure(half)[0] / mean, fields.shear(half)[0] / mean] == pytest.approx([p, q], rel=0, abs=1e-11)
    nodes, weights = np.polynomial.legendre.leggauss(200)
    s, area = np.sin((nodes + 1.0) * math.pi / 4.0), weights * np.sin((nodes + 1.0) * math.pi / 2.0)
    assert area @ fields.shear(s) / (area @ fields.pressure(s)) == pytest.approx(shear, rel=0, abs=1e-4)
    frictionless = frictionless_punch(ratio, UniformKernel(support, nu))
    assert 2.0 * punch.material.beta * frictionless.coefficients[0] == pytest.approx(k0, rel=5e-12, abs=0)
    assert frictionless.radial_displacement(half)[0] == pytest.approx(slip, rel=0, abs=2e-12)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45, 0.4999, 0.5])
@pytest.mark.parametrize("support", ["bonded", "unbonded"])
@pytest.mark.parametrize("ratio", [0.02, 0.5, 5.0])
def test_the_surface_below_neither_sinks_unevenly_nor_slides(nu, support, ratio):
    fields = AdheredFields(adhered_punch(ratio, UniformKernel(support, nu)))
    inside = np.array([0.0, 1e-3, 0.3, 0.7, 0.99, 0.9999])
    assert fields.normal_displacement(inside) == pytest.approx(np.ones(6), rel=0, abs=1e-12)
    assert fields.radial_displacement(inside) == pytest.approx(np.zeros(6), rel=0, abs=1e-12)


@pytest.mark.parametrize("support", ["bonded", "unbonded"])
@pytest.mark.parametrize("ratio", [10.0, 50.0])
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45, 0.5])
def test_wide_punches_leave_what_rounding_leaves(nu, ratio, support):
    """u_z = 1 is what is left of terms as large as the stiffness; their matrix's condition counts the roundings.

    Seen to fail by 4e-12 at a/h = 10 while the tanh-sinh weights added up to 1 + 4e-15, and by 1e-11 at nu = 0.45 and
    a/h = 50 with fewer functions; at nu = 1/2 and a/h = 50 more of them change nothing.
    """
    punch = adhered_punch(ratio, UniformKernel(support, nu))
    fields, inside = AdheredFields(punch), np.array([0.0, 1e-3, 0.3, 0.7, 0.99, 0.9999])
    rounding = 1e-12 if nu < 0.5 or ratio <= 10.0 else 40.0 * np.finfo(float).eps * punch.condition
    assert fields.normal_displacement(inside) == pytest.approx(np.ones(6), rel=0, abs=rounding)
    assert fields.radial_displacement(inside) == pytest.approx(np.zeros(6), rel=0, abs=rounding)


def test_half_space_of_mossakovskii():
    """k_stick/k = (1 - nu) ln(3 - 4 nu)/(1 - 2 nu)."""
    for nu in (0.0, 0.2, 0.3, 0.45):
        exact = (1 - nu) * math.log(3 - 4 * nu) / (1 - 2 * nu)
        assert adhered_punch(0.0, StackKernel((), Sheet(np.inf, 1.0, nu, False))).stiffness == pytest.approx(
            exact, rel=1e-14, abs=0
        )
    assert adhered_punch(0.0, StackKernel((), Sheet(np.inf, 1.0, 0.5, False))).stiffness == pytest.approx(
        1.0, rel=1e-14, abs=0
    )


def test_stick_is_continuous_at_an_incompressible_layer():
    at_half = adhered_punch(1.0, UniformKernel("bonded", 0.5)).stiffness
    for below in (1e-12, 1e-9, 1e-6):
        slope = (adhered_punch(1.0, UniformKernel("bonded", 0.5 - below)).stiffness / at_half - 1.0) / below
        assert slope == pytest.approx(-6.087, rel=0, abs=0.01 if below > 1e-11 else 0.1)


def test_thin_limits():
    """A squeeze film between two walls that hold it is four times stiffer than with one: (3 pi/16) X^3 at nu = 1/2."""
    excess = [
        adhered_punch(X, UniformKernel("bonded", 0.5)).stiffness / (3 * math.pi / 16 * X**3) - 1.0
        for X in (50.0, 100.0)
    ]
    assert excess == pytest.approx([0.0344, 0.0169], rel=0, abs=1e-4)
    unbonded = [
        adhered_punch(X, UniformKernel("unbonded", 0.5)).stiffness / (3 * math.pi / 64 * X**3) - 1.0
        for X in (50.0, 100.0)
    ]
    assert unbonded == pytest.approx([0.0243, 0.0113], rel=0, abs=1e-4)


@pytest.mark.parametrize(("nu", "support"), [(0.0, "bonded"), (0.3, "unbonded"), (0.5, "bonded")])
def test_one_factorisation_equals_single_radii(nu, support):
    ratios = np.array([0.02, 0.3, 0.77, 1.5, 2.9, 3.0, 7.3])
    punches = [adhered_punch(float(a), UniformKernel(support, nu)) for a in ratios]
    every = adhered_punches(8.0, UniformKernel(support, nu))
    assert every.stiffness(ratios) == pytest.approx([p.stiffness for p in punches], rel=1e-12, abs=0)
    assert every.spring_stiffness(ratios) == pytest.approx([p.spring_stiffness for p in punches], rel=1e-12, abs=0)


def test_the_frictionless_punch_is_that_of_the_integral_equation():
    for nu, support, ratio in ((0.3, "bonded", 2.0), (0.5, "bonded", 5.0), (0.2, "unbonded", 0.4)):
        layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu, support=support)
        k = float(IntegralEquation().solution(layer, ratio).normalized_contact_stiffness(ratio))
        punch = frictionless_punch(ratio, UniformKernel(support, nu))
        assert 2.0 * punch.material.beta * punch.coefficients[0] == pytest.approx(k, rel=1e-12, abs=0)


@pytest.mark.parametrize("support", ["bonded", "unbonded"])
def test_normal_compliance_is_the_frictionless_kernel(support):
    q = np.geomspace(1e-3, 60.0, 40)
    for nu in (0.0, 0.3, 0.5):
        normal = UniformKernel(support, nu).beyond_half_space(q).ww
        assert normal == pytest.approx(-2.0 * (1.0 - nu) * one_minus_kernel(q, support, nu), rel=1e-13, abs=1e-300)


@pytest.mark.parametrize("charge", [0.1748, -0.1748, 0.02, 0.0])
def test_coulomb_functions_in_extended_precision(charge):
    z = np.array([6e-5, 0.5, 3.0, 30.0, 200.0])
    values = coulomb_functions(charge, z, 40).values
    for n in (0, 1, 7, 39):
        exact = [float(mpmath.exp(mpmath.pi * charge / 2) * mpmath.coulombf(n, charge, x) / x) for x in z]
        assert values[n] * np.maximum(z, 1.0) == pytest.approx(exact * np.maximum(z, 1.0), rel=0, abs=5e-14)


def test_spring_stiffness_is_the_derivative_of_the_contact_stiffness():
    """c = (1/2) dk/da, by a central difference of the stiffness 2 a k_bar."""
    for nu, support in ((0.0, "bonded"), (0.5, "unbonded")):
        a, step = 1.3, 1e-4
        low, high = (2.0 * x * adhered_punch(x, UniformKernel(support, nu)).stiffness for x in (a - step, a + step))
        assert (high - low) / (4.0 * step) == pytest.approx(
            adhered_punch(a, UniformKernel(support, nu)).spring_stiffness, rel=1e-7, abs=0
        )


@pytest.mark.parametrize("ratio", [0.02, 0.5, 5.0, 10.0, 20.0])
@pytest.mark.parametrize("support", ["bonded", "unbonded"])
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45, 0.5])
def test_reciprocity_of_the_two_punches(nu, support, ratio):
    """k_stick = k_0 - int q u_r1 dA, exactly: in transforms k_stick = k_0 - 2 beta int psi v over 2 E* a.

    v = (2/pi) (-eta (1/2) PV int phi_0(s)/(t - s) ds + int D_UW P_0 sin(kappa t) dkappa); PV of P_n is 2 Q_n(t).
    """
    kernel = UniformKernel(support, nu)
    stuck, free = adhered_punch(ratio, kernel), frictionless_punch(ratio, kernel)
    t, rest, weights = tanh_sinh(2)
    psi = AdheredFields(stuck).densities(t, rest).value.imag
    before, here = np.log((1.0 + t) / rest) / 2.0, t * np.log((1.0 + t) / rest) / 2.0 - 1.0
    conjugate = free.coefficients[0] * before
    for n, coefficient in enumerate(free.coefficients[1:], start=1):
        conjugate += coefficient * here
        before, here = here, ((2 * n + 1) * t * here - n * before) / (n + 1)
    beta, eta, kappa = stuck.material.beta, stuck.material.eta, free.transforms.wavenumber
    transforms = basis_transforms(stuck.material.charge, rung_of(ratio), stuck.coefficients.size, longest=2.0)
    sine = stuck.coefficients @ transforms.sine
    assert np.array_equal(transforms.wavenumber, kappa)
    layer = (free.transforms.weights * stuck.compliance(transforms).uw * free.transform) @ sine
    moved = 2.0 / math.pi * (layer - eta * (weights * psi) @ conjugate)
    k_free = 2.0 * beta * free.coefficients[0]
    # Transforms at wavenumbers of 20 a/h lose digits: beyond a/h = 10 other nodes move the stiffness by 2e-13, too.
    rounding = 1e-13 if ratio <= 10.0 else 5e-13
    assert stuck.stiffness == pytest.approx(k_free - 2.0 * beta * moved, rel=rounding, abs=0)


def test_the_shear_of_an_adhered_punch_vanishes_on_the_axis():
    """It is odd in r: a line through the axis."""
    fields = AdheredFields(adhered_punch(1.0, UniformKernel("bonded", 0.3)))
    axis, *near = fields.shear(np.array([0.0, 1e-4, 5e-3, 2e-2]))
    assert axis == 0.0
    assert np.array(near) / [1e-4, 5e-3, 2e-2] == pytest.approx(near[-1] / 2e-2, rel=3e-4, abs=0)

"""Adhered flat punches: values of another derivation, limits, and the state they must leave on the surface."""

import math

import mpmath
import numpy as np
import pytest

from bem.kernels.stack import StackKernel
from bem.numerics import graded
from contact import Layer
from mdr.friction import adhered_punch
from mdr.friction.adhered_punch import Adhered, coulomb
from mdr.friction.statement import _slip


def punch_on(ratio, support, nu):
    return Adhered(StackKernel.single(support, nu), ratio)


def stiffness(ratio, support, nu):
    """k_stick/(2 E* a)."""
    return punch_on(ratio, support, nu).stiffness / ratio


def slip_below(ratio, support, nu):
    """u_r on the surface under the frictionless punch of unit depth, as a function of r/a."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0 - nu**2, poissons_ratio=nu, support=support)
    found = _slip(layer, ratio)[0]
    return lambda s: found(np.arcsin(s))


def over_the_contact(count):
    """Radii over a and weights of int . dA/(2 pi a^2), with panels towards the edge."""
    v, w = graded(count)
    angle = np.pi / 2 * v
    return np.minimum(np.sin(angle), 1 - 1e-15), np.pi / 2 * w * np.sin(angle) * np.cos(angle)


# nu, a/h, support, k_stick/(2 E* a), c_stick/E*, k/(2 E* a) without friction, Q/N, p and q at a/2 over the mean
# pressure, u_r1 at a/2: another program's values, printed to twelve digits.
EXAMPLES = [
    (0.0, 0.5, "bonded",
     1.68500985461, 2.36336658009, 1.52508019727, 0.31338907474, 0.66096202159, 0.04145084601, -0.098731922354),
    (0.3, 3.0, "bonded",
     6.28701835666, 12.0365004256, 6.26129233871, -0.01321627317, 0.89779807830, -0.01861960901, 0.048308253567),
    (0.5, 3.0, "bonded",
     30.1147473241, 100.033103673, 18.1573993806, -0.25735088808, 1.18808204080, -0.17591592057, 1.119258664940),
    (0.5, 3.0, "unbonded",
     9.80018722994, 28.1854296931, 5.28743077143, -0.43248900398, 1.07809491704, -0.26916837291, 0.737253152241),
]  # fmt: skip


@pytest.mark.first(1)
@pytest.mark.parametrize("example", EXAMPLES)
def test_values_of_another_program(example):
    nu, ratio, support, k, c, k0, shear, p, q, slip = example
    punch = punch_on(ratio, support, nu)
    assert [punch.stiffness / ratio, punch.spring] == pytest.approx([k, c], rel=5e-12, abs=0)
    mean, half = 2.0 * punch.stiffness / (math.pi * ratio**2), np.array([0.5])
    assert punch.tractions(half)[:, 0] / mean == pytest.approx([p, q], rel=0, abs=1e-11)
    s, area = over_the_contact(10)
    pressed, pushed = punch.tractions(s)
    assert area @ pushed / (area @ pressed) == pytest.approx(shear, rel=0, abs=1e-7)
    assert area @ pressed * 2.0 * math.pi * ratio**2 == pytest.approx(2.0 * punch.stiffness, rel=1e-7, abs=0)
    assert slip_below(ratio, support, nu)(0.5) == pytest.approx(slip, rel=0, abs=2e-12)
    # Reciprocity: k_stick = k_0 - int q u_r dA.
    moved = 2.0 * math.pi * ratio**2 * (area @ (pushed * slip_below(ratio, support, nu)(s)))
    assert 2.0 * ratio * k0 - moved == pytest.approx(2.0 * punch.stiffness, rel=1e-7, abs=0)


@pytest.mark.parametrize(
    ("nu", "support", "ratio"),
    [
        (0.0, "bonded", 0.02),
        (0.3, "unbonded", 0.5),
        (0.4999, "bonded", 5.0),
        (0.5, "bonded", 50.0),
        (0.5, "unbonded", 50.0),
    ],
)
def test_the_surface_below_neither_sinks_unevenly_nor_slides(nu, support, ratio, monkeypatch):
    """Then what the surface beside the punch leaves of its depth goes on analytically from the density below it."""
    punch = Adhered(StackKernel.single(support, nu), ratio, far=1.01)
    places = 1.0 + np.array([1e-3, 3e-3, 4.9e-3]) / max(1.0, ratio**2 / 25.0)
    beside = punch.beside(places)
    monkeypatch.setattr(adhered_punch, "_POLYNOMIAL_END", 1.1)
    rounding = 1e-12 + 40.0 * np.finfo(float).eps * punch.condition
    assert beside == pytest.approx(punch.beside(places), rel=0, abs=rounding * np.abs(beside).max())


def test_stick_is_continuous_at_an_incompressible_layer():
    at_half = stiffness(1.0, "bonded", 0.5)
    for below in (1e-12, 1e-9, 1e-6):
        slope = (stiffness(1.0, "bonded", 0.5 - below) / at_half - 1.0) / below
        assert slope == pytest.approx(-6.087, rel=0, abs=0.01 if below > 1e-11 else 0.1)


@pytest.mark.parametrize("eps", [0.1748, -0.1748, 0.02, 0.0])
def test_coulomb_functions_in_extended_precision(eps):
    z = np.array([6e-5, 0.5, 3.0, 30.0, 200.0])
    values = coulomb(eps, z, 40)
    for n in (0, 1, 7, 39):
        exact = [float(mpmath.exp(mpmath.pi * eps / 2) * mpmath.coulombf(n, eps, x) / x) for x in z]
        assert values[n] * np.maximum(z, 1.0) == pytest.approx(exact * np.maximum(z, 1.0), rel=0, abs=5e-14)


def test_the_shear_of_an_adhered_punch_vanishes_on_the_axis():
    """It is odd in r: a line through the axis."""
    axis, *near = punch_on(1.0, "bonded", 0.3).tractions(np.array([0.0, 1e-4, 5e-3, 2e-2]))[1]
    assert axis == 0.0
    assert np.array(near) / [1e-4, 5e-3, 2e-2] == pytest.approx(near[-1] / 2e-2, rel=3e-4, abs=0)

"""The closed forms of the library against printed numbers: a slip in an expected number would judge every method."""

import math

import numpy as np
import pytest

from cases.library import (
    flat_punch_adhesion,
    flat_punch_impact,
    flat_punch_stiffness,
    friction_flat_punch,
    half_space_limits,
    paraboloid,
    paraboloid_adhesion,
    thin_layer_limits,
    truncated_cone,
)
from cases.library._common import HAYES, NUMBERS, THICKNESS


@pytest.mark.parametrize(
    ("flat", "depth", "force"),
    [(0.25, 1.318116, 1.560178), (0.5, 1.047198, 1.480210), (0.75, 0.722734, 1.218813), (0.9, 0.451027, 0.843328)],
)
def test_truncated_cone_on_the_half_space(flat, depth, force):
    """Printed: delta/(a tan) and F/(E* a^2 tan) of the Handbook of Contact Mechanics, six decimals."""
    scene = truncated_cone.half_space_scene(flat).scene
    a, modulus = THICKNESS, scene.layer.contact_modulus
    assert truncated_cone.half_space_depth(scene) / (a * truncated_cone.SLOPE) == pytest.approx(depth, abs=5.1e-7)
    expected = force * modulus * a**2 * truncated_cone.SLOPE
    assert truncated_cone.half_space_force(scene) == pytest.approx(expected, rel=1e-6, abs=0.0)


@pytest.mark.parametrize(
    ("damping", "restitution"),
    [
        (0.05, 0.858758),
        (0.1, 0.744079),
        (0.2, 0.571740),
        (0.3, 0.450975),
        (0.5, 0.298436),
        (0.7, 0.210285),
        (0.9, 0.155283),
        (1.0, math.exp(-2)),
        (1.5, 0.075588),
        (2.0, 0.047769),
        (3.0, 0.023770),
    ],
)
def test_kelvin_voigt_restitution(damping, restitution):
    """Printed to six decimals."""
    assert flat_punch_impact.restitution(damping) == pytest.approx(restitution, abs=6e-7)


def test_restitution_is_continuous_through_critical_damping():
    below, at, above = (flat_punch_impact.restitution(d) for d in (1 - 1e-9, 1.0, 1 + 1e-9))
    assert below == pytest.approx(at, rel=1e-8, abs=0.0)
    assert above == pytest.approx(at, rel=1e-8, abs=0.0)


def test_damping_ratio_of_the_scenes():
    """D = eta sqrt(2 a / (M G)), Eq. (50) with kbar = 1, computed the other way round."""
    for damping in (0.1, 1.0, 3.0):
        eta = flat_punch_impact.viscosity(damping)
        a, mass, modulus = flat_punch_impact.RADIUS, flat_punch_impact.MASS, flat_punch_impact.SHEAR_MODULUS
        assert eta * math.sqrt(2 * a / (mass * modulus)) == pytest.approx(damping, rel=1e-12, abs=0.0)


def reference_stiffness(label):
    return [NUMBERS["stiffness"][f"{label} a/h={ratio:g}"][0] for ratio in flat_punch_stiffness.STIFFNESS_RATIOS]


def test_hermanowicz_fits_are_continuous_and_close_to_the_reference():
    for fit, joint in (
        (flat_punch_stiffness.hermanowicz_bonded, 1.2),
        (flat_punch_stiffness.hermanowicz_unbonded, 1.65),
    ):
        assert fit(joint) == pytest.approx(fit(joint * (1 + 1e-12)), rel=1.6e-3, abs=0.0)  # twice 0.08 %
    bonded = [flat_punch_stiffness.hermanowicz_bonded(r) for r in flat_punch_stiffness.STIFFNESS_RATIOS]
    unbonded = [flat_punch_stiffness.hermanowicz_unbonded(r) for r in flat_punch_stiffness.STIFFNESS_RATIOS]
    assert bonded == pytest.approx(reference_stiffness("bonded nu=0.5"), rel=1.2e-4, abs=0.0)
    assert unbonded == pytest.approx(reference_stiffness("unbonded"), rel=8e-4, abs=0.0)


def test_hayes_agrees_with_the_reference_as_well_as_stated():
    for label, at in HAYES.items():
        for ratio, kbar in zip((0.2, 1.0, 2.0), reference_stiffness(label), strict=True):
            assert at[ratio] == pytest.approx(kbar, rel=1e-3 + 8e-3 * ratio, abs=0.0)


def test_hermanowicz_force_of_the_paraboloid():
    for depth, force in paraboloid.PRESCRIBED["bonded nu=0.5"].values():
        assert paraboloid.hermanowicz(depth) == pytest.approx(force, rel=1e-3, abs=0.0)


def test_jkr_state_lies_on_the_jkr_branch():
    """F = 4 E* a^3/(3 R) - sqrt(8 pi E* Delta gamma a^3) at the closed-form radius gives -(3/2) pi R Delta gamma."""
    scene = paraboloid_adhesion.HALF_SPACE[0].scene
    a, modulus = paraboloid_adhesion.jkr_radius(scene), scene.layer.contact_modulus
    radius, gamma = paraboloid_adhesion.RADIUS_OF_CURVATURE, paraboloid_adhesion.WORK_OF_ADHESION
    force = 4 * modulus * a**3 / (3 * radius) - math.sqrt(8 * math.pi * modulus * gamma * a**3)
    assert force == pytest.approx(paraboloid_adhesion.jkr_force(scene), rel=1e-12, abs=0.0)


def test_jkr_depth_turns_at_the_closed_form_radius():
    """d(delta)/da = 0 under displacement control, by a central difference."""
    scene = paraboloid_adhesion.HALF_SPACE[1].scene
    a, modulus = paraboloid_adhesion.jkr_radius(scene), scene.layer.contact_modulus
    gamma = paraboloid_adhesion.WORK_OF_ADHESION

    def depth(radius):
        return radius**2 / paraboloid_adhesion.RADIUS_OF_CURVATURE - math.sqrt(2 * math.pi * gamma * radius / modulus)

    slope = (depth(a * 1.001) - depth(a * 0.999)) / (0.002 * a)
    assert abs(slope) < 1e-3 * a / paraboloid_adhesion.RADIUS_OF_CURVATURE
    assert depth(a) == pytest.approx(paraboloid_adhesion.jkr_depth(scene), rel=1e-12, abs=0.0)


def test_kendall_force_is_stiffness_times_depth():
    scene = flat_punch_adhesion.HALF_SPACE[0].scene
    stiffness = 2 * scene.layer.contact_modulus * scene.indenter.flat_radius
    depth, force = flat_punch_adhesion.kendall_depth(scene), flat_punch_adhesion.kendall_force(scene)
    assert force == pytest.approx(stiffness * depth, rel=1e-12, abs=0.0)


@pytest.mark.parametrize(("nu", "ratio"), [(0.0, 1.09861), (0.3, 1.02863), (0.45, 1.00277), (0.5, 1.0)])
def test_adhered_punch_on_the_half_space(nu, ratio):
    """Printed to six digits: k over that of the frictionless punch."""
    scene = next(s.scene for s in friction_flat_punch.HALF_SPACES if s.scene.layer.poissons_ratio == nu)
    free = 2 * scene.layer.contact_modulus * scene.indenter.flat_radius
    assert friction_flat_punch.stuck_half_space(scene) / free == pytest.approx(ratio, rel=0.0, abs=5.1e-6)


def test_a_thin_layer_that_sticks_is_four_times_as_stiff():
    """Eq. (18) of the frictionless layer with the same a/h and E is a quarter of it."""
    label = "bonded nu=0.5"
    stuck = friction_flat_punch.on_layer(label, 75.0).scene
    free = thin_layer_limits.paraboloid(label, 75.0).scene
    assert friction_flat_punch.thin_stiffness(stuck) == pytest.approx(
        4 * thin_layer_limits.stiffness(free), rel=1e-12, abs=0.0
    )


def test_sneddon_depths_by_quadrature():
    """delta = a int_0^(pi/2) f'(a sin t) dt with r = a sin t, on 60 Gauss points."""
    t, w = np.polynomial.legendre.leggauss(60)
    angle, weight = np.pi / 4 * (t + 1), np.pi / 4 * w
    for case_scene in half_space_limits.CURVED:
        scene = case_scene.scene
        a = float(scene.loading.values[0])
        depth = a * float(weight @ scene.indenter.slope_at(a * np.sin(angle)))
        assert half_space_limits.depth(scene) == pytest.approx(depth, rel=1e-12, abs=0.0)


def test_thin_layer_cone_force_by_quadrature():
    """Eq. (36): the bed's pressure E~ (f(a) - f(r))/h over the contact, on 200 Gauss points either side of the kink."""
    scene = thin_layer_limits.cone("bonded nu=0.3", 75.0).scene
    a, b = float(scene.loading.values[0]), scene.indenter.flat_radius
    t, w = np.polynomial.legendre.leggauss(200)
    total = 0.0
    for low, high in ((0.0, b), (b, a)):
        r, weight = (high - low) / 2 * (t + 1) + low, (high - low) / 2 * w
        pressed = scene.indenter.height(a) - scene.indenter.height(r)
        total += float(weight @ (2 * np.pi * r * pressed)) * scene.layer.confined_modulus / scene.layer.thickness
    assert thin_layer_limits.cone_force(scene) == pytest.approx(total, rel=1e-12, abs=0.0)

"""Every profile keeps the promises of `Profile`; a new class is tested by being listed in PROFILES."""

from __future__ import annotations

import numpy as np
import pytest

from contact.scene.profiles import (
    PROFILES,
    Cone,
    FlatPunch,
    Paraboloid,
    PowerLaw,
    Sphere,
    Spheroconical,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
)

TABLE = np.linspace(0.0, 2.0, 9)
EXAMPLES = (
    FlatPunch(radius=1.0),
    Paraboloid(radius_of_curvature=3.0),
    Sphere(radius=2.0),
    Cone(slope=0.3),
    Spheroconical(radius=1.0, slope=1.2),
    TruncatedCone(flat_radius=0.4, slope=0.3),
    TruncatedParaboloid(flat_radius=0.4, radius_of_curvature=3.0),
    PowerLaw(exponent=3.5, reference_radius=1.0, reference_height=0.2),
    Tabulated(radii=TABLE, heights=0.1 * TABLE**2),
)
SMOOTH_STEP = 1e-6


def test_every_profile_has_an_example():
    assert {type(example) for example in EXAMPLES} == set(PROFILES)


def inside(profile):
    """Radii within the profile and away from its breakpoints."""
    end = min(profile.max_radius, 1.9)
    r = np.linspace(0.02, 0.98 * end, 173)
    return r[np.all(np.abs(r[:, None] - np.array([*profile.breakpoints, -1.0])) > 3e-3, axis=1)]


@pytest.mark.parametrize("profile", EXAMPLES, ids=lambda p: type(p).__name__)
class TestProfile:
    def test_starts_at_zero(self, profile):
        assert profile.height(0.0) == 0.0

    def test_slope_is_the_derivative_of_height(self, profile):
        r = inside(profile)
        numeric = (profile.height(r + SMOOTH_STEP) - profile.height(r - SMOOTH_STEP)) / (2 * SMOOTH_STEP)
        # second-order differences: 1e-12 from the step, 1e-10 from rounding
        assert profile.slope_at(r) == pytest.approx(numeric, abs=2e-9)

    def test_flat_end_is_flat_and_the_rest_is_not(self, profile):
        b = profile.flat_radius
        assert np.all(profile.height(np.linspace(0.0, b, 5)) == 0.0)
        if b < profile.max_radius:
            assert np.all(profile.height(inside(profile)[inside(profile) > b]) > 0.0)

    def test_kinks_are_breakpoints_where_the_slope_jumps(self, profile):
        assert set(profile.kinks) <= set(profile.breakpoints)
        for kink in profile.kinks:
            before, after = profile.slope_at(kink * (1 - 1e-9)), profile.slope_at(kink * (1 + 1e-9))
            assert after - before > 1e-3
            assert profile.slope_at(kink) == pytest.approx(after, rel=1e-8, abs=0.0)  # a kink belongs to the outside

    def test_height_is_continuous_at_breakpoints(self, profile):
        for r in profile.breakpoints:
            if r < profile.max_radius:
                jump = profile.height(r * (1 + 1e-12)) - profile.height(r * (1 - 1e-12))
                assert abs(jump) < 1e-11

    def test_shape_is_kept_and_beyond_the_end_is_infinite(self, profile):
        assert profile.height(np.ones((2, 3))).shape == (2, 3)
        assert profile.slope_at(0.5).shape == ()
        if np.isfinite(profile.max_radius):
            assert np.isinf(profile.height(1.01 * profile.max_radius))


def test_sphere_keeps_its_digits_near_the_tip_and_the_equator():
    sphere = Sphere(radius=1.0)
    assert sphere.height(1e-9) == pytest.approx(0.5e-18, rel=1e-15, abs=0.0)  # closed form r^2/2 + O(r^4)
    near = 1.0 - 2.0**-50
    expected = np.sqrt(2.0**-49 - 2.0**-100)  # sqrt(1 - r^2) with r = 1 - 2^-50, exact in binary
    assert 1.0 - sphere.height(near) == pytest.approx(expected, rel=1e-8, abs=0.0)  # 1 - (1 - x) rounds at eps/x
    assert sphere.slope_at(near) == pytest.approx(near / expected, rel=1e-14, abs=0.0)


def test_table_of_a_paraboloid_converges_at_third_order():
    # PCHIP is third order where its slopes are second order (Fritsch and Carlson 1980)
    errors = []
    for n in (20, 40, 80):
        r = np.linspace(0.0, 2.0, n + 1)
        fine = np.linspace(0.3, 1.7, 1001)
        errors.append(np.max(np.abs(Tabulated(radii=r, heights=np.expm1(r)).height(fine) - np.expm1(fine))))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > 2.8)
    assert errors[-1] < 1e-4

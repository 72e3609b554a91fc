"""Boundary elements against the integral equation, an independent method."""

import numpy as np
import pytest

from bem.method import Bem
from bem.tables import FftTable
from contact import ContactRadii, IndentationDepths, Layer, Paraboloid, Scene, TruncatedCone
from mdr import Mdr

KERNELS = [("bonded", 0.3), ("bonded", 0.5), ("unbonded", 0.3)]
PARABOLOID, CONE = Paraboloid(radius_of_curvature=0.1), TruncatedCone(flat_radius=0.5e-3, slope=0.1)


def layer(support, nu, thickness=1e-3):
    return Layer(thickness=thickness, youngs_modulus=1e6, poissons_ratio=nu, support=support)


@pytest.mark.slow
@pytest.mark.parametrize(("support", "nu"), KERNELS)
def test_mdr_on_a_published_table_agrees_with_mdr_on_the_integral_equation(support, nu):
    for indenter in (PARABOLOID, CONE):
        scene = Scene(layer=layer(support, nu), indenter=indenter, loading=ContactRadii([0.6e-3, 1e-3, 2e-3, 5e-3]))
        published, exact = Mdr(flat_punch=FftTable()).solve(scene), Mdr().solve(scene)
        for name in ("indentation_depth", "normal_force"):
            error = np.abs(getattr(published, name) / getattr(exact, name) - 1.0)
            assert np.all(error <= published.error_estimate[name]), name
            assert np.all(error <= 4e-5), name


def test_contacts_at_round_multiples_of_a_flat_radius():
    """Points that estimates choose may meet the kink, where the pressure is infinite."""
    radii = 0.5e-3 * np.unique([p / q for p in range(2, 6) for q in range(1, p)])
    scene = Scene(layer=layer("bonded", 0.3), indenter=CONE, loading=ContactRadii(radii))
    path, exact = Mdr(flat_punch=FftTable(cells=64, ratios=100)).solve(scene), Mdr().solve(scene)
    assert np.all(path.uncertainty("pressure") > 0.0)
    assert np.all(np.abs(path.normal_force - exact.normal_force) <= path.uncertainty("normal_force"))


@pytest.mark.first(1)
@pytest.mark.parametrize("indenter", [PARABOLOID, CONE], ids=["paraboloid", "truncated cone"])
@pytest.mark.parametrize("ratio", [1.0, 2.0])
def test_direct_contact_at_512(indenter, ratio):
    scene = Scene(layer=layer("bonded", 0.5), indenter=indenter, loading=ContactRadii([ratio * 1e-3]))
    path, exact = Bem(points=512).solve(scene), Mdr().solve(scene)
    for name in ("indentation_depth", "normal_force"):
        assert getattr(path, name)[0] == pytest.approx(getattr(exact, name)[0], rel=5e-5, abs=0.0), name


def test_force_control_and_depth_control_are_inverse():
    scene = Scene(layer=layer("unbonded", 0.3), indenter=PARABOLOID, loading=IndentationDepths([6e-6]))
    force = Bem(points=128).solve(scene).normal_force
    exact = Mdr().solve(scene).normal_force
    np.testing.assert_allclose(force, exact, rtol=2e-4)

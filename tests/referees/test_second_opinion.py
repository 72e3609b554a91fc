"""The referee itself is checked against closed forms and values that other methods agree on."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bem.direct_method import LARGEST_RATIO
from contact import (
    Adhesion,
    ContactPath,
    ContactRadii,
    Cost,
    Detachment,
    InvalidInput,
    Layer,
    Paraboloid,
    Scene,
    Sphere,
)
from mdr import Mdr
from tests.referees.second_opinion import adhesive_states, second_opinion


def answer(scene, radius):
    """A path that claims a contact radius and nothing else of value."""
    cost = Cost(wall_seconds=0.0, cpu_seconds=0.0, peak_memory_bytes=0, unknowns=0, counters={})
    zero = np.zeros(1)
    return ContactPath(
        scene=scene,
        method="none",
        settings={},
        error_estimate={},
        cost=cost,
        contact_radius=np.array([radius]),
        indentation_depth=zero,
        normal_force=zero,
        contact_stiffness=zero,
    )


def test_beyond_its_reach_it_says_so():
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
    radius = 1.01 * LARGEST_RATIO
    scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=1.0), loading=ContactRadii([radius]))
    with pytest.raises(InvalidInput, match="covers ratios up to"):
        second_opinion(answer(scene, radius))


def test_an_adhering_paraboloid_on_the_half_space_is_that_of_johnson_kendall_and_roberts():
    """F = 4 E* a^3/(3 R) - sqrt(8 pi E* Delta gamma a^3), delta = a^2/R - sqrt(2 pi Delta gamma a/E*)."""
    layer = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3)
    work, curvature, modulus = 1e-3, 5.0, layer.contact_modulus
    scene = Scene(
        layer=layer,
        indenter=Paraboloid(radius_of_curvature=curvature),
        loading=Detachment(control="force"),
        effects=(Adhesion(work_of_adhesion=work),),
    )
    a = np.array([0.1, 0.5, 1.0])
    found = adhesive_states(scene, a)
    force = 4 * modulus * a**3 / (3 * curvature) - np.sqrt(8 * np.pi * modulus * work * a**3)
    depth = a**2 / curvature - np.sqrt(2 * np.pi * work * a / modulus)
    np.testing.assert_allclose(found.values["normal_force"], force, rtol=1e-12)
    np.testing.assert_allclose(found.values["indentation_depth"], depth, rtol=1e-12)


def test_the_branch_of_the_fast_method_on_a_layer_is_the_same():
    scene = Scene(
        layer=Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5),
        indenter=Paraboloid(radius_of_curvature=5.0),
        loading=Detachment(control="displacement", initial_contact_radius=2.0),
        effects=(Adhesion(work_of_adhesion=1e-3),),
    )
    branch = Mdr().solve(scene)
    found = adhesive_states(scene, branch.contact_radius[::20])
    for name, values in found.values.items():
        error = np.abs(getattr(branch, name)[::20] - values) / branch.scale(name)[::20]
        assert np.max(error) < 1e-10, name


@pytest.mark.parametrize("share", [0.9, 0.99, 0.9999])
def test_a_sphere_that_is_almost_in_to_its_rim(share):
    """F = E* ((a^2 + R^2)/2 ln((R + a)/(R - a)) - a R), Sneddon 1965: log-singular at a = R."""
    layer, radius = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3), 2.0
    a = share * radius
    scene = Scene(layer=layer, indenter=Sphere(radius=radius), loading=ContactRadii([a]))
    stretched = math.log((radius + a) / (radius - a))
    expected = layer.contact_modulus * ((a**2 + radius**2) / 2 * stretched - a * radius)
    assert second_opinion(Mdr().solve(scene)).values["normal_force"][0] == pytest.approx(expected, rel=1e-13, abs=0.0)

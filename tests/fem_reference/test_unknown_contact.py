from __future__ import annotations

import numpy as np
import pytest

from contact import (
    ContactRadii,
    IndentationDepths,
    InvalidInput,
    Layer,
    NormalForces,
    NotConvergedError,
    Paraboloid,
    Scene,
    Sphere,
    Tabulated,
    TruncatedCone,
    UnsupportedSceneError,
)
from fem_reference import Fem
from fem_reference.contact_set import edge_radius
from fem_reference.equilibria import radius_of_load
from mdr import Mdr
from tests.fem_reference.integral_equation import solve_contact, truncated_cone

LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.5)
QUICK = Fem(growth=0.7, edge_cell=1e-6, truncation=1e-7)


def exact(ratio, kind):
    """Profile, depth [m] and force [N] of contact radius ratio x h, by the integral equation."""
    if kind == "paraboloid":
        contact = solve_contact(ratio, "bonded", 0.5)
        profile, scale = Paraboloid(radius_of_curvature=1e-2), 1e-4
    else:
        contact = solve_contact(ratio, "bonded", 0.5, truncated_cone(ratio / 2), ratio / 2)
        profile, scale = TruncatedCone(flat_radius=ratio * 0.5e-3, slope=0.1), 1e-4
    return profile, contact.depth * scale, contact.force * scale * LAYER.contact_modulus * 1e-3


@pytest.mark.parametrize(("ratio", "kind"), [(1.0, "paraboloid"), pytest.param(0.5, "cone", marks=pytest.mark.slow)])
def test_depth_and_force_control_find_the_same_state(ratio, kind):
    """The truncated cone, which is harder; the paraboloid is slow."""
    profile, depth, force = exact(ratio, kind)
    for loading in (IndentationDepths([depth]), NormalForces([force])):
        path = QUICK.solve(Scene(layer=LAYER, indenter=profile, loading=loading))
        true = {
            "contact_radius": path.contact_radius[0] / (ratio * 1e-3) - 1,
            "indentation_depth": path.indentation_depth[0] / depth - 1,
            "normal_force": path.normal_force[0] / force - 1,
        }
        for name, error in true.items():
            assert abs(error) <= path.error_estimate[name][0] + 1e-12 < 1e-3, name


def test_a_rim_that_presses_more_than_its_neighbour_ends_the_contact():
    radii = np.array([0.0, 1.0, 2.0, 3.0])
    assert edge_radius(radii, np.array([1.0, 1.0, 3.0, 0.0])) == 2.0
    assert edge_radius(radii, np.zeros(4)) == 0.0
    assert edge_radius(radii, np.array([1.0, 0.0, 0.0, 0.0])) == 0.5


@pytest.mark.slow
@pytest.mark.parametrize("flat", [0.99, 0.999, 0.9999])
def test_contact_that_barely_passes_a_flat_end_is_found(flat):
    indenter = TruncatedCone(flat_radius=flat * 1e-3, slope=0.1)
    at_radius = QUICK.solve(Scene(layer=LAYER, indenter=indenter, loading=ContactRadii([1e-3])))
    for loading in (IndentationDepths(at_radius.indentation_depth), NormalForces(at_radius.normal_force)):
        found = QUICK.solve(Scene(layer=LAYER, indenter=indenter, loading=loading))
        assert abs(found.contact_radius[0] / 1e-3 - 1) <= found.error_estimate["contact_radius"][0] < 1e-4
        assert found.normal_force[0] == pytest.approx(at_radius.normal_force[0], rel=1e-4, abs=0.0)


def test_ring_contact_is_refused():
    rings = Tabulated(radii=[0, 0.4e-3, 0.8e-3, 2e-3], heights=[0, -2e-5, 2e-5, 1e-3])
    with pytest.raises(UnsupportedSceneError, match="no single circle"):
        QUICK.solve(Scene(layer=LAYER, indenter=rings, loading=IndentationDepths([1e-6])))


@pytest.mark.slow
def test_contact_close_to_the_end_of_the_profile_is_answered_and_beyond_it_refused():
    scene = Scene(layer=LAYER, indenter=Sphere(radius=0.2e-3), loading=IndentationDepths([0.6e-3]))
    path, exact = QUICK.solve(scene), Mdr().solve(scene)
    assert abs(path.normal_force[0] / exact.normal_force[0] - 1) <= path.error_estimate["normal_force"][0]
    table = Tabulated(radii=[0.0, 1e-4, 2e-4], heights=[0.0, 1e-5, 3e-5])
    with pytest.raises(InvalidInput, match="end of the profile"):
        QUICK.solve(scene.replace(indenter=table))


def test_a_radius_that_never_settles_is_refused():
    flips = iter([(2.0, 2.0), (0.5, 2.0)] * 20)
    with pytest.raises(NotConvergedError, match="settle"):
        radius_of_load(lambda a: next(flips), 1.0, 0.0, np.inf)

"""The contact radius at a prescribed load: how it is found, and what is stated of it."""

from __future__ import annotations

import numpy as np
import pytest

from contact import (
    Cone,
    ContactRadii,
    Layer,
    Paraboloid,
    Scene,
    StageLog,
    TruncatedCone,
)
from fem_reference import Fem
from fem_reference.prescribed_contact import QUICK, solve_contact
from mdr import Mdr
from tests.drawn_scenes import scene_of

LAYER = Layer(thickness=2e-3, youngs_modulus=0.8e6, poissons_ratio=0.49)
TRUNCATED = TruncatedCone(flat_radius=0.5e-3, slope=0.2)


@pytest.mark.parametrize(
    ("indenter", "radius"),
    [(TRUNCATED, 0.6e-3), (Paraboloid(radius_of_curvature=1e-2), 1.2e-3), (Cone(slope=0.1), 3e-3)],
)
def test_a_quick_solution_knows_how_its_depth_grows(indenter, radius):
    """Three cells inside the edge the slope was 5 to 8 per cent off."""
    near = radius * (1 + 1e-3 * np.array([-1.0, 0.0, 1.0]))
    scene = Scene(layer=LAYER, indenter=indenter, loading=ContactRadii(near))
    depth = Mdr().solve(scene).indentation_depth
    found = solve_contact(scene, radius, QUICK, StageLog()).smooth_depth_slope
    assert found == pytest.approx((depth[2] - depth[0]) / (near[2] - near[0]), rel=1e-2, abs=0)


@pytest.mark.slow
def test_the_slope_is_read_where_a_table_is_smooth():
    """In rings across a row of the table the slope was 2e-2 off, and radii at loads up to 1.7 times what was stated."""
    scene = scene_of(5, 16, ratio=(0.1, 5.0))
    path, exact = Fem().solve(scene), Mdr().solve(scene)
    errors = np.abs(path.contact_radius / exact.contact_radius - 1)
    assert np.all(errors < path.error_estimate["contact_radius"] + exact.error_estimate["contact_radius"])


@pytest.mark.parametrize("indenter", [Paraboloid(radius_of_curvature=30.0), Cone(slope=0.05)])
def test_a_coarse_mesh_knows_how_its_depth_grows(indenter):
    """Read in one cell the slope was -770 and -920 times what it is."""
    near = 1 + 1e-4 * np.array([-1.0, 0.0, 1.0])
    scene = Scene(
        layer=Layer(thickness=0.3, youngs_modulus=1.0, poissons_ratio=0.5),
        indenter=indenter,
        loading=ContactRadii(near),
    )
    depth = Mdr().solve(scene).indentation_depth
    found = solve_contact(scene, 1.0, Fem(growth=1.4, truncation=1e-5), StageLog()).smooth_depth_slope
    assert found == pytest.approx((depth[2] - depth[0]) / (near[2] - near[0]), rel=0.1, abs=0)

"""Adhesive branches: errors that pull-offs and the surface state."""

from __future__ import annotations

import numpy as np
import pytest

from contact import (
    Adhesion,
    ContactRadii,
    Layer,
    Paraboloid,
    Profile,
    Scene,
    TruncatedCone,
)
from fem_reference import Fem
from mdr import Mdr
from tests.drawn_scenes import scene_of


@pytest.mark.slow
def test_a_measured_profile_states_what_its_force_misses_between_solved_radii() -> None:
    """Breakpoints inside a piece are interpolated across: the force at loss states 6 %, finer meshes leave 3 %."""
    scene = scene_of(1401, 6, "adhering_table", (0.1, 5.0))
    path, exact = Fem(accuracy=1e-1).solve(scene), Mdr().solve(scene)
    for name in ("pull_off_force", "pull_off_depth", "pull_off_contact_radius", "force_at_loss"):
        error = abs(getattr(path, name) / getattr(exact, name) - 1)
        assert error < path.error_estimate[name][0], name


@pytest.mark.parametrize(
    ("layer", "indenter"),
    [
        (Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.4), Paraboloid(radius_of_curvature=3.0)),
        (Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5), TruncatedCone(flat_radius=0.3, slope=0.2)),
    ],
)
def test_the_surface_beside_an_adhering_contact_keeps_its_stated_error(layer: Layer, indenter: Profile) -> None:
    """Close to the edge, too, where it rises like a root; no error of its own was stated once."""
    scene = Scene(
        layer=layer,
        indenter=indenter,
        loading=ContactRadii(values=np.array([0.4, 2.0])),
        effects=(Adhesion(work_of_adhesion=1e-3),),
    )
    answer, exact = Fem(accuracy=1e-2).solve(scene), Mdr().solve(scene)
    stated = answer.uncertainty("surface_displacement")
    for step, a in enumerate(answer.contact_radius):
        radii = a * np.array([1.0 + 1e-9, 1.0 + 1e-6, 1.0001, 1.001, 1.01, 1.1, 2.0, 5.0])
        error = np.abs(answer.surface_displacement(radii, step) - exact.surface_displacement(radii, step))
        assert error.max() < stated[step], (a, error, stated[step])

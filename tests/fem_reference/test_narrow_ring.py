"""Contacts that reach hardly beyond a flat end: the ring is narrower than any mesh resolves."""

import numpy as np
import pytest

from contact import (
    ContactRadii,
    IndentationDepths,
    Layer,
    NormalForces,
    Scene,
    TruncatedCone,
    TruncatedParaboloid,
)
from fem_reference import Fem
from mdr import Mdr

LAYER = Layer(thickness=0.5, youngs_modulus=1.0, poissons_ratio=0.3)
COARSE = Fem(growth=1.0, edge_cell=1e-3, truncation=1e-6)
NUMBERS = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")
PROFILES = [
    TruncatedCone(flat_radius=1.0, slope=0.01),
    TruncatedParaboloid(flat_radius=1.0, radius_of_curvature=50.0),
]


def assert_covered(path):
    exact = Mdr().solve(path.scene)
    for name in NUMBERS:
        error = np.abs(getattr(path, name) / getattr(exact, name) - 1)
        assert np.all(error <= path.error_estimate[name] + 1e-15), name
        assert np.all(path.error_estimate[name] < 0.5), name


@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("indenter", "quantity"),
    [(PROFILES[0], NormalForces), pytest.param(PROFILES[1], IndentationDepths, marks=pytest.mark.slow)],
)
@pytest.mark.parametrize(
    "load", [2e-8, *(pytest.param(2 * 10.0**-k, marks=pytest.mark.slow) for k in (10, 7, 6, 5, 4))]
)
def test_any_small_load_beside_a_flat_end_is_carried(indenter, quantity, load):
    """Rings of 1e-15 to 1e-4 radii: the secants ended in meshes without area, singular masses or "does not settle"."""
    assert_covered(COARSE.solve(Scene(layer=LAYER, indenter=indenter, loading=quantity(values=[load]))))


@pytest.mark.parametrize("indenter", [PROFILES[0], pytest.param(PROFILES[1], marks=pytest.mark.slow)])
def test_radii_beside_a_flat_end(indenter):
    """At 1e-10 the depth was off by a factor of four where 0.7 was stated, at 1e-13 the mesh had no area."""
    radii = 1.0 + np.array([1e-10, 1e-6])
    assert_covered(COARSE.solve(Scene(layer=LAYER, indenter=indenter, loading=ContactRadii(values=radii))))

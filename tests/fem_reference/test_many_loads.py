"""Many loads in one scene: each state within its stated error."""

from __future__ import annotations

import pickle
from functools import cache

import numpy as np
import pytest

from contact import (
    Cone,
    IndentationDepths,
    Layer,
    NormalForces,
    Paraboloid,
    Scene,
    TruncatedCone,
)
from fem_reference import Fem
from mdr import Mdr

LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.5, support="bonded")
COARSE = Fem(accuracy=1e-2)
BALL = Paraboloid(radius_of_curvature=0.01)
DEPTHS = np.linspace(0.1, 1.0, 8) * 5e-5


def scene(indenter=BALL, loading=None, layer=LAYER):
    return Scene(layer=layer, indenter=indenter, loading=loading or IndentationDepths(DEPTHS))


@cache
def solved(asked):
    return COARSE.solve(asked)


@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("indenter", "loading", "nu"),
    [
        (BALL, IndentationDepths(DEPTHS), 0.5),
        pytest.param(Cone(slope=0.1), NormalForces(np.geomspace(1e-2, 0.1, 5)), 0.3, marks=pytest.mark.slow),
        (TruncatedCone(flat_radius=5e-4, slope=0.1), IndentationDepths(np.linspace(1.0, 0.4, 3) * 5e-5), 0.45),
    ],
)
def test_every_state_is_within_its_stated_error(indenter, loading, nu):
    asked = scene(indenter, loading, LAYER.replace(poissons_ratio=nu))
    path, exact = solved(asked), Mdr().solve(asked)
    for name in path.ARRAYS:
        error = np.abs(getattr(path, name) / getattr(exact, name) - 1)
        assert np.all(error <= path.error_estimate[name] + exact.error_estimate[name] + 1e-14), name
        assert path.error_estimate[name].max() <= COARSE.accuracy
    prescribed = "indentation_depth" if isinstance(loading, IndentationDepths) else "normal_force"
    assert getattr(path, prescribed) == pytest.approx(loading.values, rel=1e-15, abs=0.0)
    assert not path.error_estimate[prescribed].any()


def test_fields_survive_a_trip_between_processes():
    path = pickle.loads(pickle.dumps(solved(scene())))
    exact, step = Mdr().solve(scene()), 7
    radius = path.contact_radius[step] * np.array([0.0, 0.3, 0.6, 1.3])
    inside, mean = radius[:3], exact.normal_force[step] / (np.pi * exact.contact_radius[step] ** 2)
    off = np.abs(path.pressure(inside, step) - exact.pressure(inside, step)).max() / mean
    assert off <= 3 * path.error_estimate["pressure"][step]
    moved = np.abs(path.surface_displacement(radius, step) - exact.surface_displacement(radius, step))
    assert moved.max() <= path.uncertainty("surface_displacement")[step]
    assert path.inside(step).at(0.0, 1e-4).hydrostatic_pressure > 0.0

"""Fields of one of many loads, sent between processes, are those of MDR within their stated errors."""

from __future__ import annotations

import pickle

import numpy as np

from contact import (
    IndentationDepths,
    Layer,
    Paraboloid,
    Scene,
)
from fem_reference import Fem
from mdr import Mdr


def test_fields_survive_a_trip_between_processes():
    scene = Scene(
        layer=Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.5, support="bonded"),
        indenter=Paraboloid(radius_of_curvature=0.01),
        loading=IndentationDepths([1e-5, 2e-5, 5e-5]),
    )
    path = pickle.loads(pickle.dumps(Fem(accuracy=1e-2).solve(scene)))
    exact, step = Mdr().solve(scene), 2
    radius = path.contact_radius[step] * np.array([0.0, 0.3, 0.6, 1.3])
    inside, mean = radius[:3], exact.normal_force[step] / (np.pi * exact.contact_radius[step] ** 2)
    off = np.abs(path.pressure(inside, step) - exact.pressure(inside, step)).max() / mean
    assert off <= 3 * path.error_estimate["pressure"][step]
    moved = np.abs(path.surface_displacement(radius, step) - exact.surface_displacement(radius, step))
    assert moved.max() <= path.uncertainty("surface_displacement")[step]
    assert path.inside(step).at(0.0, 1e-4).hydrostatic_pressure > 0.0

"""A batch is its scenes one by one, whatever the number of scenes: below, at and beyond what is computed at a time."""

from __future__ import annotations

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from contact import (
    Impact,
    IndentationDepths,
    Layer,
    NormalForces,
    NotConvergedError,
    Paraboloid,
    Scene,
    StandardSolid,
)
from mdr import Mdr, batches
from mdr.batches import equilibria, impacts
from mdr.impact import solver as impact_solver

PUNCH = IntegralEquation()
LAYER = Layer.incompressible(thickness=1e-3, shear_modulus=1e6)
VISCOUS = StandardSolid(long_term_shear_modulus=2e5, maxwell_shear_modulus=8e5, viscosity=8e2)
# Prime, so that chunks end with different scenes, and so close together that all share one table and one chunk.
DIFFERENT = 7
OUTCOMES = ("coefficient_of_restitution", "contact_time", "peak_force", "peak_depth", "peak_contact_radius")
CURVATURES = 5e-3 * 1.005 ** np.arange(DIFFERENT)


def scenes(loading, effects=(), count=DIFFERENT):
    own = [
        Scene(layer=LAYER, indenter=Paraboloid(radius_of_curvature=R), loading=loading, effects=effects)
        for R in CURVATURES
    ]
    return [own[i % DIFFERENT] for i in range(count)]


def around(chunk):
    return (1, chunk - 1, chunk, chunk + 1, 2 * chunk, 2 * chunk + 1)


def assert_repeated(together, alone, count, tolerance=1e-9):
    """Each array of the batch is the single answers again and again."""
    for name, expected in alone.items():
        np.testing.assert_allclose(
            getattr(together, name), np.resize(expected, count), rtol=tolerance, atol=0.0, err_msg=name
        )


@pytest.mark.parametrize("size", around(impact_solver.CHUNK)[1:4:2])
def test_impacts_of_every_size(size):
    loading = Impact(mass=0.02, velocity=0.1)
    histories = [Mdr(flat_punch=PUNCH).solve(scene) for scene in scenes(loading, (VISCOUS,))]
    alone = {name: [getattr(history, name) for history in histories] for name in OUTCOMES}
    assert_repeated(impacts(scenes(loading, (VISCOUS,), size), PUNCH), alone, size, tolerance=0.0)


@pytest.mark.parametrize("loading", [NormalForces([0.1]), IndentationDepths([2e-5])])
@pytest.mark.parametrize("size", [1, 513])
def test_equilibria_of_every_size(size, loading):
    paths = [Mdr(flat_punch=PUNCH).solve(scene) for scene in scenes(loading)]
    names = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")
    alone = {name: [getattr(path, name)[0] for path in paths] for name in names}
    assert_repeated(equilibria(scenes(loading, count=size), PUNCH), alone, size)


def test_a_scene_without_an_answer_is_refused(monkeypatch):
    """At first an uncomputed scene of a batch was whatever the memory held."""
    solve = batches._together

    def without_the_last(some, flat_punch):
        return np.where(np.arange(len(some)) < len(some) - 1, solve(some, flat_punch), np.nan)

    monkeypatch.setattr(batches, "_together", without_the_last)
    with pytest.raises(NotConvergedError, match=r"scenes\[6\]: no finite answer"):
        equilibria(scenes(NormalForces([0.1])), PUNCH)

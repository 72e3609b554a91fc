"""Prescribed histories by finite elements: their instants, a force far below the stresses, and a refusal."""

from __future__ import annotations

import numpy as np
import pytest

from contact import (
    DepthHistory,
    FlatPunch,
    ForceHistory,
    KelvinVoigt,
    Layer,
    Paraboloid,
    Scene,
    StandardSolid,
    UnsupportedSceneError,
)
from fem_reference import Fem

G = 1e3
SOLID = StandardSolid(long_term_shear_modulus=G, maxwell_shear_modulus=2 * G, viscosity=2 * G)
DAMPED = KelvinVoigt(shear_modulus=G, viscosity=G)
BALL = Paraboloid(radius_of_curvature=5e-3)
HERTZ = 16 / 3 * np.sqrt(5e-3)  # F = HERTZ G delta^1.5 on an incompressible half-space


def scene(effect, tip, loading):
    """A bonded incompressible layer; its modulus is the effect's at once."""
    layer = Layer.incompressible(thickness=2e-3, shear_modulus=G if effect is DAMPED else 3 * G)
    return Scene(layer=layer, indenter=tip, loading=loading, effects=(effect,))


def test_a_depth_that_a_dashpot_would_answer_with_an_infinite_force_is_refused():
    with pytest.raises(UnsupportedSceneError, match="infinite force"):
        Fem().solve(scene(DAMPED, BALL, DepthHistory(time=[0, 10], depth=[4e-5, 4e-5])))


def test_the_last_instant_of_every_segment_is_the_given_one():
    """One rounding beyond it a force that jumps there would be compared with that of the other side."""
    time = np.array([0.1, 1.16, 1.95, 2.96, 3.59])
    answer = Fem(growth=1.0).solve(
        scene(SOLID, FlatPunch(radius=1e-3), DepthHistory(time=time, depth=1e-6 * np.array([0, 1, 3, 2, 1])))
    )
    assert set(time) <= set(answer.time)


def test_a_force_far_below_the_stresses_of_its_layer_has_a_depth():
    """Its defect stops falling at the rounding of the depth: "no depth has the prescribed force"."""
    layer = Layer.incompressible(thickness=np.inf, shear_modulus=G)
    effect = KelvinVoigt(shear_modulus=G, viscosity=1e4 * G)
    loading = ForceHistory(time=[0, 10], force=[1e-4, 1e-4])
    answer = Fem(growth=1.0).solve(Scene(layer=layer, indenter=BALL, loading=loading, effects=(effect,)))
    exact = (-1e-4 * np.expm1(-answer.time / 1e4) / G / HERTZ) ** (2 / 3)
    assert np.all(np.abs(answer.indentation_depth - exact) <= answer.uncertainty("indentation_depth"))

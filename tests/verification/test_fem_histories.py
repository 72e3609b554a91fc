"""Prescribed histories by finite elements: true errors are within stated ones, against springs and closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from contact import (
    Cone,
    DepthHistory,
    FlatPunch,
    ForceHistory,
    KelvinVoigt,
    Layer,
    Paraboloid,
    PronySeries,
    Scene,
    StandardSolid,
    UnsupportedSceneError,
)
from fem_reference import Fem
from tests.verification.random_histories import coverage

G = 1e3
SOLID = StandardSolid(long_term_shear_modulus=G, maxwell_shear_modulus=2 * G, viscosity=2 * G)
PRONY = PronySeries(long_term_shear_modulus=G, shear_moduli=[G, G], relaxation_times=[0.1, 1.0])
DAMPED = KelvinVoigt(shear_modulus=G, viscosity=G)
BALL, CONE = Paraboloid(radius_of_curvature=5e-3), Cone(slope=0.1)
HERTZ = 16 / 3 * np.sqrt(5e-3)  # F = HERTZ G delta^1.5 on an incompressible half-space


def scene(effect, tip, loading, thickness=2e-3):
    """A bonded incompressible layer; its modulus is the effect's at once."""
    layer = Layer.incompressible(thickness=thickness, shear_modulus=G if effect is DAMPED else 3 * G)
    return Scene(layer=layer, indenter=tip, loading=loading, effects=(effect,))


@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("effect", "tip"), [(SOLID, BALL), (PRONY, CONE), (DAMPED, CONE)], ids=["solid", "prony", "kelvin_voigt"]
)
def test_a_short_ramp_of_depth_is_within_its_stated_error(effect, tip):
    answer = Fem().solve(scene(effect, tip, DepthHistory(time=[0, 0.1, 10], depth=[0, 50e-6, 50e-6])))
    found = coverage(answer, most=25)
    assert found.worst <= 1.0
    assert np.median(found.stated) < 2e-2


@pytest.mark.slow
@pytest.mark.parametrize("effect", [PRONY], ids=["prony"])
def test_a_depth_that_is_there_at_the_first_instant_acts_at_once(effect):
    relaxed, answer = (
        effect.relaxation,
        Fem().solve(scene(effect, BALL, DepthHistory(time=[0, 10], depth=[4e-5, 4e-5]), np.inf)),
    )
    moduli = relaxed.long_term_modulus + np.exp(-answer.time[:, None] / relaxed.times) @ relaxed.moduli
    exact = HERTZ * moduli * 4e-5**1.5
    assert answer.normal_force[0] == pytest.approx(3 * HERTZ * G * 4e-5**1.5, rel=1e-3, abs=0.0)
    assert np.all(np.abs(answer.normal_force - exact) <= answer.uncertainty("normal_force"))


@pytest.mark.slow
@pytest.mark.parametrize("effect", [DAMPED, pytest.param(SOLID, marks=pytest.mark.slow)], ids=["kelvin_voigt", "solid"])
def test_a_force_that_is_there_at_the_first_instant_acts_at_once(effect):
    answer = Fem().solve(scene(effect, BALL, ForceHistory(time=[0, 10], force=[1e-4, 1e-4]), np.inf))
    # Half-space: delta^1.5 = F J(t) / HERTZ.
    compliance = (1 - np.exp(-answer.time)) / G if effect is DAMPED else (1 - 2 / 3 * np.exp(-answer.time / 3)) / G
    exact = (1e-4 * compliance / HERTZ) ** (2 / 3)
    assert np.all(np.abs(answer.indentation_depth - exact) <= answer.uncertainty("indentation_depth"))
    assert answer.normal_force == pytest.approx(np.full(len(answer), 1e-4), rel=1e-9, abs=0.0)


@pytest.mark.slow
def test_a_prony_layer_creeps_under_a_force_that_is_there_at_the_first_instant():
    assert (
        coverage(Fem().solve(scene(PRONY, BALL, ForceHistory(time=[0, 10], force=[1e-4, 1e-4]))), most=25).worst <= 1.0
    )


def test_a_depth_that_a_dashpot_would_answer_with_an_infinite_force_is_refused():
    with pytest.raises(UnsupportedSceneError, match="infinite force"):
        Fem().solve(scene(DAMPED, BALL, DepthHistory(time=[0, 10], depth=[4e-5, 4e-5])))


@pytest.mark.slow
@pytest.mark.parametrize(("ramp", "tau"), [(0.1, 1.0)])
def test_a_ramp_on_a_kelvin_voigt_half_space_follows_its_closed_form(ramp, tau):
    """F = (16/3) sqrt(R) G d^1.5 + 8 eta a d', a = sqrt(R d)."""
    depth, effect = 50e-6, KelvinVoigt(shear_modulus=G, viscosity=tau * G)
    loading = DepthHistory(time=[0, ramp, 2], depth=[0, depth, depth])
    layer = Layer.incompressible(thickness=np.inf, shear_modulus=G)
    answer = Fem().solve(Scene(layer=layer, indenter=BALL, loading=loading, effects=(effect,)))
    d, grows = answer.indentation_depth, answer.time <= ramp
    exact = HERTZ * G * d**1.5 + 8 * tau * G * np.sqrt(5e-3 * d) * np.where(grows, depth / ramp, 0.0)
    error = np.abs(answer.normal_force - exact)
    assert np.all(error <= answer.uncertainty("normal_force"))
    # Stated instant by instant: the force of the hold is better known than that of the ramp.
    stated = answer.error_estimate["normal_force"]
    assert stated[-1] < 0.2 * stated[grows].max()


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

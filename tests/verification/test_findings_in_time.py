"""Scenes in time whose answers once were wrong beyond their stated error, or crashed; found by random scenes."""

from __future__ import annotations

import numpy as np
import pytest

from contact import (
    Cone,
    DepthHistory,
    FlatPunch,
    ForceHistory,
    Impact,
    IndentationDepths,
    KelvinVoigt,
    Layer,
    NotConvergedError,
    Paraboloid,
    Scene,
    StandardSolid,
    Tabulated,
)
from mdr import Mdr

SOFT = Layer.incompressible(thickness=1.0, shear_modulus=1.0)
HISTORY = DepthHistory(time=[0.0, 1.0, 2.0], depth=[0.0, 0.01, 0.0])


def test_a_flat_punch_under_a_falling_depth_on_a_viscous_layer():
    effect = KelvinVoigt(shear_modulus=1.0, viscosity=0.5)
    path = Mdr().solve(Scene(layer=SOFT, indenter=FlatPunch(radius=2.0), loading=HISTORY, effects=(effect,)))
    elastic = Mdr().solve(Scene(layer=SOFT, indenter=FlatPunch(radius=2.0), loading=HISTORY))
    # closed form: F = k_N (delta + tau delta'), tau = eta/G = 0.5 s, delta' = 0.01 m/s before the turn at 1 s
    assert path.normal_force[1] == pytest.approx(1.5 * elastic.normal_force[1], rel=1e-11, abs=0.0)


def test_a_history_of_a_tabulated_profile_ends_at_its_elastic_equilibrium():
    """Sections between thirty breakpoints have springs of their own; across them the history once was refused."""
    rises = np.diff(np.linspace(0.0, 0.1, 31) ** 2) * (1.0 + 0.02 * np.random.default_rng(3).uniform(-1.0, 1.0, 30))
    rough = Tabulated(radii=np.linspace(0.0, 0.1, 31), heights=np.concatenate([[0.0], np.cumsum(rises)]))
    scene = Scene(layer=SOFT, indenter=rough, loading=DepthHistory(time=[0.0, 1.0], depth=[0.0, 0.008]))
    history = Mdr().solve(scene)
    elastic = Mdr().solve(scene.replace(loading=IndentationDepths(values=[0.008])))
    stated = history.error_estimate["normal_force"][-1]
    assert history.normal_force[-1] == pytest.approx(elastic.normal_force[0], rel=stated, abs=0.0)
    assert stated < 1e-5


@pytest.mark.parametrize("viscosity", [0.3, 3.0, 30.0])
def test_the_contact_time_of_a_damped_impact_is_within_its_stated_error(viscosity):
    effect = KelvinVoigt(shear_modulus=1.0, viscosity=viscosity)
    scene = Scene(
        layer=SOFT,
        indenter=Paraboloid(radius_of_curvature=1.0),
        loading=Impact(mass=0.05, velocity=0.1),
        effects=(effect,),
    )
    answer, finer = Mdr().solve(scene), Mdr(accuracy=1e-12).solve(scene)
    distance = abs(answer.contact_time / finer.contact_time - 1.0)
    assert distance <= answer.error_estimate["contact_time"].max() + finer.error_estimate["contact_time"].max()


@pytest.mark.parametrize("time", [1e-3, 1e-4, 1e-6])
def test_a_relaxation_far_faster_than_the_impact_is_an_answer_or_a_named_refusal(time):
    effect = StandardSolid(long_term_shear_modulus=0.1, maxwell_shear_modulus=0.9, viscosity=0.9 * time)
    scene = Scene(
        layer=SOFT,
        indenter=Paraboloid(radius_of_curvature=1.0),
        loading=Impact(mass=0.05, velocity=0.1),
        effects=(effect,),
    )
    try:
        restitution = Mdr().solve(scene).coefficient_of_restitution
    except NotConvergedError:
        return
    # limit tau -> 0: an elastic layer of modulus G_inf; the loss is of the order tau G_1 / (G_inf T), T about 0.3 s
    assert 1.0 - 9.0 * np.pi * time / 0.3 < restitution <= 1.0


@pytest.mark.slow
def test_springs_that_touch_at_one_instant_under_a_force_have_no_infinite_front():
    """Infinite pace times no time was NaN (and a warning, which fails a test)."""
    layer = Layer(thickness=3.37702e-07, youngs_modulus=11772.7, poissons_ratio=0.5, support="unbonded")
    loading = ForceHistory(time=[0.0, 2.66493, 2.72075], force=[0.0, 0.0004327, 0.0])
    effect = KelvinVoigt(shear_modulus=layer.shear_modulus, viscosity=14695.2)
    scene = Scene(
        layer=layer, indenter=Cone(slope=30.3796), loading=loading, effects=(effect,), beyond_small_strains=True
    )
    history = Mdr().solve(scene)
    assert history.contact_radius[2] == 0.0
    assert np.isfinite(history.indentation_depth).all()

"""Histories and impacts with closed forms: liquids, flat punches under a force, and punches that a dashpot stops."""

import math

import numpy as np
import pytest

from bem.kernels.moduli import relaxation_of
from contact import (
    FlatPunch,
    ForceHistory,
    Impact,
    KelvinVoigt,
    Layer,
    Paraboloid,
    PronySeries,
    Scene,
)
from mdr import Mdr
from mdr.history.spring_law import SpringLaw

HALF_SPACE = Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5)
SOLID = PronySeries(long_term_shear_modulus=0.3, shear_moduli=[0.2, 0.5], relaxation_times=[2.0, 0.05])
TIMES = [0.0, 0.6, 1.0, 1.4]


def test_a_liquid_under_a_falling_force_creeps_on_in_closed_form():
    """Springs reached out to 24 million times the depth, and the history was refused."""
    force, tau = np.array([0.03, 0.03, 0.009, 0.012]), 0.05
    liquid = PronySeries(long_term_shear_modulus=0.0, shear_moduli=[1.0], relaxation_times=[tau])
    scene = Scene(
        layer=HALF_SPACE,
        indenter=Paraboloid(radius_of_curvature=10.0),
        loading=ForceHistory(time=TIMES, force=force),
        effects=(liquid,),
    )
    answer = Mdr().solve(scene)
    crept = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(TIMES))]) / tau
    # F = 4/3 E* sqrt(R) delta^(3/2) of a half-space, E* = 4.
    expected = ((force + crept) * 0.75 / (4.0 * math.sqrt(10.0))) ** (2.0 / 3.0)
    np.testing.assert_allclose(answer.indentation_depth, expected, rtol=1e-12)
    np.testing.assert_allclose(answer.contact_radius, np.sqrt(10.0 * expected), rtol=1e-12)
    assert np.all(answer.error_estimate["indentation_depth"] < 1e-12)


def test_a_flat_punch_needs_no_steps_whatever_the_force_does():
    scene = Scene(
        layer=HALF_SPACE,
        indenter=FlatPunch(radius=0.5),
        loading=ForceHistory(time=TIMES, force=[0.0, 0.02, 0.005, 0.0]),
        effects=(SOLID,),
    )
    answer, law = Mdr().solve(scene), SpringLaw.of(relaxation_of(scene))
    # k = 2 E* a.
    np.testing.assert_allclose(
        answer.indentation_depth, law.elastic_force(scene.loading.time, scene.loading.force) / 4.0, rtol=1e-12
    )
    assert answer.contact_radius.tolist() == [0.0, 0.5, 0.5, 0.0]


@pytest.mark.parametrize("viscosity", [3.0, 30.0, 100.0])
def test_a_punch_that_a_dashpot_stops_leaves_when_two_exponentials_say(viscosity):
    """The contact time was 2e-2 off at accuracy 1e-4, and at 1e-6 8e-6 with 5e-6 stated."""
    scene = Scene(
        layer=HALF_SPACE,
        indenter=FlatPunch(radius=0.5),
        loading=Impact(mass=1.0, velocity=0.1),
        effects=(KelvinVoigt(shear_modulus=1.0, viscosity=viscosity),),
    )
    stiffness = 4.0  # 2 E* a
    root = math.sqrt((0.5 * viscosity * stiffness) ** 2 - stiffness)
    fast = -0.5 * viscosity * stiffness - root
    slow = stiffness / fast
    # delta = (exp(slow t) - exp(fast t)) v0/(slow - fast), at the end without acceleration.
    expected = 2.0 * math.log(fast / slow) / (slow - fast)
    for accuracy in (1e-4, 1e-6):
        answer = Mdr(accuracy=accuracy).solve(scene)
        stated = answer.error_estimate["contact_time"].item()
        assert abs(answer.contact_time / expected - 1.0) <= stated <= accuracy

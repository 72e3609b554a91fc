"""Creep and relaxation with and without a first jump, at every instant and on flat punches, against closed forms.

With the creep function J and the relaxation function G of the material, contact that only grows has the depth that an
elastic layer of unit shear modulus has under int J dF, and the force that it has under int G d(F_unit(depth)) (Lee and
Radok 1960, J. Appl. Mech. 27, 438). For nu = 1/2, F_unit = (16/3) sqrt(R) d^(3/2) under a paraboloid, 8 a d under a
flat punch. The case `held_indentation` claims the last force and depth under a paraboloid.
"""

import numpy as np
import pytest
from scipy.integrate import quad

from contact import (
    DepthHistory,
    FlatPunch,
    ForceHistory,
    KelvinVoigt,
    Layer,
    Paraboloid,
    PronySeries,
    Scene,
    StandardSolid,
)
from mdr import Mdr

G, TAU = 1e3, 1.0
TIMES = np.array([0.0, 0.5, 1.0, 2.0, 10.0])
RELAXATIONS = {
    "kelvin_voigt": KelvinVoigt(shear_modulus=G, viscosity=G * TAU),
    "standard_solid": StandardSolid(long_term_shear_modulus=G, maxwell_shear_modulus=G, viscosity=G * TAU),
    "prony": PronySeries(long_term_shear_modulus=G, shear_moduli=[G, 0.5 * G], relaxation_times=[1.0, 1.0]),
}
INSTANTANEOUS = {"kelvin_voigt": G, "standard_solid": 2.0 * G, "prony": 2.5 * G}
PUNCH, BALL = FlatPunch(radius=1e-4), Paraboloid(radius_of_curvature=1e-3)
PUNCH_FORCE, BALL_FORCE = 8e-4, 16 / 3 * np.sqrt(1e-3)  # F_unit = PUNCH_FORCE d, BALL_FORCE d^(3/2)
DEPTH, FORCE = 4e-5, 4e-5


def creep(name, t):
    """J(t): G J is 1 - exp(-t) for Kelvin-Voigt, 1 - (1 - g) exp(-g t) with g = G/(G + G_1) for one branch."""
    if name == "kelvin_voigt":
        return -np.expm1(-t / TAU) / G
    share = G / INSTANTANEOUS[name]
    return (1.0 - (1.0 - share) * np.exp(-share * t / TAU)) / G


def relaxation(name, t):
    """G(t) without the dashpot's impulse."""
    return G + (INSTANTANEOUS[name] - G) * np.exp(-t / TAU)


def solved(indenter, name, loading):
    half_space = Layer.half_space(youngs_modulus=3 * INSTANTANEOUS[name], poissons_ratio=0.5)
    scene = Scene(layer=half_space, indenter=indenter, loading=loading, effects=(RELAXATIONS[name],))
    return Mdr().solve(scene)


def within(answer, quantity, exact):
    """Whether a quantity is within its stated error of the exact values."""
    error = np.abs(getattr(answer, quantity) - exact)
    return bool(np.all(error <= answer.uncertainty(quantity) + 1e-13 * exact.max()))


@pytest.mark.parametrize("name", RELAXATIONS)
@pytest.mark.parametrize("ramp", [0.0, 1.0], ids=["jump", "ramp"])
def test_depth_of_a_flat_punch_under_a_force(name, ramp):
    force = np.where(ramp <= TIMES, FORCE, FORCE * TIMES)
    answer = solved(PUNCH, name, ForceHistory(time=TIMES, force=force))
    if ramp:
        risen = [FORCE * quad(lambda s, t=t: creep(name, t - s), 0.0, min(t, ramp), epsabs=0.0)[0] for t in TIMES]
    else:
        risen = FORCE * creep(name, TIMES)
    assert within(answer, "indentation_depth", np.array(risen) / PUNCH_FORCE)


@pytest.mark.parametrize("name", RELAXATIONS)
@pytest.mark.parametrize("ramp", [0.0, 1.0], ids=["jump", "ramp"])
def test_force_of_a_flat_punch_under_a_depth(name, ramp):
    depth = np.where(ramp <= TIMES, DEPTH, DEPTH * TIMES)
    answer = solved(PUNCH, name, DepthHistory(time=TIMES, depth=depth))
    if not ramp:
        assert within(answer, "normal_force", relaxation(name, TIMES) * PUNCH_FORCE * DEPTH)
        return
    risen = [quad(lambda s, t=t: relaxation(name, t - s), 0.0, min(t, ramp), epsabs=0.0)[0] for t in TIMES]
    # The dashpot adds eta times the rate while the depth grows.
    dashpot = np.where((TIMES > 0) & (ramp >= TIMES), G * TAU, 0.0) * (name == "kelvin_voigt")
    assert within(answer, "normal_force", PUNCH_FORCE * DEPTH * (np.array(risen) + dashpot))


def test_kelvin_voigt_under_many_depths_that_begin_above_zero():
    time = np.linspace(0.0, 1.0, 16)
    depth = DEPTH * (0.1 + time)
    answer = solved(BALL, "kelvin_voigt", DepthHistory(time=time, depth=depth))
    exact = G * BALL_FORCE * depth**1.5 + G * TAU * 8 * np.sqrt(1e-3 * depth) * DEPTH
    assert within(answer, "normal_force", np.append(answer.normal_force[0], exact[1:]))

from __future__ import annotations

from math import atan, exp, sqrt

import numpy as np
import pytest

from contact import (
    DepthHistory,
    FlatPunch,
    ForceHistory,
    Impact,
    InvalidInput,
    KelvinVoigt,
    Layer,
    NotConvergedError,
    Paraboloid,
    PronySeries,
    Scene,
    Sphere,
    StandardSolid,
)
from fem_reference import Fem
from fem_reference.histories import peak
from fem_reference.materials import ShearRelaxation
from fem_reference.memory import proportional_modes
from fem_reference.motions import MAX_STEPS, Strip, simulate_impact

QUICK = Fem(growth=1.0, edge_cell=1e-6, truncation=1e-7)
G1 = 7.5e6
G_INF = G1 / 9
SOLID = StandardSolid(long_term_shear_modulus=G_INF, maxwell_shear_modulus=G1, viscosity=G1 * 1e-3)
IMPACT = Impact(mass=0.02, velocity=0.127479)
BALL = Paraboloid(radius_of_curvature=0.01)


def impact_scene(thickness, nu=0.5, indenter=BALL, effects=(SOLID,)):
    layer = Layer(thickness=thickness, youngs_modulus=2 * (1 + nu) * (G1 + G_INF), poissons_ratio=nu)
    return Scene(layer=layer, indenter=indenter, loading=IMPACT, effects=effects)


def own(effect):
    """The relaxation of an effect as finite elements write it."""
    shared = effect.relaxation
    return ShearRelaxation(shared.long_term_modulus, shared.moduli, shared.times, shared.viscosity)


def single_spring(relaxation, steps):
    """Restitution of one degree of freedom (unit compliance, mass and speed) with so many steps in a half period."""
    modes = proportional_modes(np.eye(1), np.ones(1), np.ones(1), 1)
    motion = simulate_impact(Strip(modes, relaxation, np.zeros(1), 1.0), 1.0, 1.0, np.pi / steps)
    return -motion.velocity[-1], motion


@pytest.mark.parametrize(
    "effect",
    [
        KelvinVoigt(shear_modulus=1.0, viscosity=0.4),
        PronySeries(long_term_shear_modulus=0.5, shear_moduli=[0.3, 0.2], relaxation_times=[0.5, 0.05]),
    ],
    ids=["KelvinVoigt", "Prony"],
)
def test_time_stepping_is_of_second_order(effect):
    restitution = [single_spring(own(effect), n)[0] for n in (50, 100, 200, 800)]
    errors = np.abs(np.array(restitution[:3]) - restitution[3])
    order = np.log2(errors[:-1] / errors[1:])
    assert np.all(order > 1.8)
    assert errors[-1] < 1e-4


def test_kinetic_energy_and_work_balance_exactly():
    _, motion = single_spring(
        own(PronySeries(long_term_shear_modulus=0.5, shear_moduli=[0.5], relaxation_times=[0.3])), 50
    )
    work = np.cumsum((motion.force[1:] + motion.force[:-1]) / 2 * np.diff(motion.depth))
    assert motion.velocity[1:] ** 2 / 2 + work == pytest.approx(0.5, abs=1e-13)


def test_energies_at_the_loss_of_contact_err_by_the_square_of_the_step_wherever_it_is_within_it():
    """Those of the end of the step were answered: errors of first order, with a factor between -128 and -25."""
    damping = 0.33
    relaxation = own(KelvinVoigt(shear_modulus=1.0, viscosity=2 * damping))
    s = sqrt(1 - damping**2)
    restitution = exp(-2 * damping / s * atan(s / damping))  # Eq. (49)
    # Contact ends when the force x + 2 D x' of the oscillator vanishes: x = -2 D x' = 2 D e.
    stored = (2 * damping * restitution) ** 2 / 2
    exact = np.array([stored, 0.5 - restitution**2 / 2 - stored])
    factors = []
    for steps in np.linspace(300, 302, 9):
        motion = single_spring(relaxation, steps)[1]
        factors.append((np.array([motion.stored[-1], motion.dissipated[-1]]) - exact) * steps**2)
    assert np.ptp(factors, axis=0) == pytest.approx(np.zeros(2), rel=0.0, abs=0.01)


def test_every_quantity_of_a_history_has_an_error_bar():
    history = QUICK.solve(impact_scene(2e-3))
    assert set(history.error_estimate) == {
        *history.ARRAYS,
        *history.SCALARS,
        "coefficient_of_restitution",
        "contact_time",
    } - {"time"}
    assert all(np.all(error > 0) for error in history.error_estimate.values())
    layer = Layer.incompressible(thickness=1e-3, shear_modulus=G1 + G_INF)
    loading = DepthHistory(time=[0, 1e-3], depth=[0, 5e-5])
    path = QUICK.solve(Scene(layer=layer, indenter=BALL, loading=loading, effects=(SOLID,)))
    assert set(path.error_estimate) == {"indentation_depth", "normal_force", "contact_radius"}
    assert path.error_estimate["indentation_depth"].tolist() == [0.0] * len(path)  # input


def test_elastic_impact_loses_nothing():
    history = QUICK.solve(impact_scene(2e-3, nu=0.3, effects=()))
    assert history.coefficient_of_restitution == pytest.approx(1.0, abs=1e-3)
    assert history.dissipated_energy.max() == 0


def test_a_body_that_never_comes_off_is_refused(monkeypatch):
    from fem_reference import motions

    monkeypatch.setattr(motions, "MAX_STEPS", 100)
    fluid = PronySeries(long_term_shear_modulus=0.0, shear_moduli=[1.0], relaxation_times=[1e-3])
    assert MAX_STEPS > 100
    with pytest.raises(NotConvergedError, match="come off"):
        single_spring(own(fluid), 50)


def test_a_kelvin_voigt_punch_under_given_depth_or_force():
    # F = k (delta + tau delta'), tau = eta / G; under the force f t: delta = f/k (t - tau (1 - exp(-t/tau)))
    a, tau, k_bar = 1e-3, 0.5, 3.61873584896
    stiffness = 8 * 1e6 * a * k_bar
    scene = Scene(
        layer=Layer.incompressible(thickness=a, shear_modulus=1e6),
        indenter=FlatPunch(radius=a),
        loading=DepthHistory(time=[0, 1, 3], depth=[0, 1e-5, 1.2e-5]),
        effects=(KelvinVoigt(shear_modulus=1e6, viscosity=tau * 1e6),),
    )
    path = QUICK.solve(scene)
    rate = np.where(path.time < 1 + 1e-9, 1e-5, 1e-6)
    exact = stiffness * (path.indentation_depth + tau * rate)
    assert np.all(np.abs(path.normal_force - exact)[1:] <= path.uncertainty("normal_force")[1:])
    path = QUICK.solve(scene.replace(loading=ForceHistory(time=[0, 1], force=[0, 0.3])))
    exact = 0.3 / stiffness * (path.time - tau * (1 - np.exp(-path.time / tau)))
    assert np.all(np.abs(path.indentation_depth - exact) <= path.uncertainty("indentation_depth"))
    assert path.error_estimate["indentation_depth"].max() < 1e-2


def test_history_that_outgrows_or_never_meets_the_profile_is_refused():
    layer = Layer.incompressible(thickness=1e-3, shear_modulus=1e6)
    for loading, match in (
        (DepthHistory(time=[0, 1], depth=[0, 1.2e-3]), "end of the profile"),
        (DepthHistory(time=[0, 1], depth=[0, -1e-6]), "never presses"),
    ):
        with pytest.raises(InvalidInput, match=match):
            QUICK.solve(Scene(layer=layer, indenter=Sphere(radius=0.2e-3), loading=loading))


def test_peak_lies_between_samples():
    t = np.linspace(0, 2, 8)
    assert peak(1 - (t - 1.1) ** 2) == pytest.approx(1.0, rel=1e-14, abs=0.0)


@pytest.mark.slow
def test_a_force_that_goes_back_to_zero_is_zero_in_the_end():
    """Roundings of the ramp left 3e-17 of it; "no depth has the prescribed force"."""
    layer = Layer.incompressible(thickness=1e-3, shear_modulus=G1 + G_INF)
    for peak_force in np.linspace(1.0, 2.0, 3):
        loading = ForceHistory(time=[0.0, 1e-3, 2e-3], force=[0.0, peak_force, 0.0])
        answer = QUICK.solve(Scene(layer=layer, indenter=BALL, loading=loading, effects=(SOLID,)))
        assert answer.normal_force[-1] == answer.contact_radius[-1] == 0.0

from __future__ import annotations

from math import acos, atan, atanh, exp, sqrt

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
    StageLog,
    StandardSolid,
)
from fem_reference import Fem
from fem_reference.histories import peak
from fem_reference.materials import ShearRelaxation
from fem_reference.memory import proportional_modes
from fem_reference.motions import MAX_STEPS, HistorySetup, Strip, simulate_impact
from fem_reference.stated import solve_to_accuracy

QUICK = Fem(growth=1.0, edge_cell=1e-6, truncation=1e-7)
G1 = 7.5e6
G_INF = G1 / 9
SOLID = StandardSolid(long_term_shear_modulus=G_INF, maxwell_shear_modulus=G1, viscosity=G1 * 1e-3)
IMPACT = Impact(mass=0.02, velocity=0.127479)
BALL = Paraboloid(radius_of_curvature=0.01)


def impact_scene(thickness, nu=0.5, indenter=BALL, effects=(SOLID,)):
    layer = Layer(thickness=thickness, youngs_modulus=2 * (1 + nu) * (G1 + G_INF), poissons_ratio=nu)
    return Scene(layer=layer, indenter=indenter, loading=IMPACT, effects=effects)


# restitution of the standard solid sphere impact, from the reduction to springs (an independent method)
@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("thickness", "restitution"),
    [(1e-3, 0.64341), *(pytest.param(*each, marks=pytest.mark.slow) for each in ((2e-3, 0.55924), (3e-3, 0.52344)))],
)
def test_restitution_of_a_sphere_on_an_incompressible_standard_solid(thickness, restitution):
    history = Fem().solve(impact_scene(thickness))
    assert history.coefficient_of_restitution == pytest.approx(restitution, abs=5e-5)
    assert history.error_estimate["coefficient_of_restitution"][0] < 5e-4
    assert history.energy_residual < 1e-4


@pytest.mark.slow
def test_requested_accuracy_of_an_impact_is_reached_or_refused():
    history = Fem(accuracy=1e-3).solve(impact_scene(2e-3))
    assert history.coefficient_of_restitution == pytest.approx(0.55924, rel=1e-3, abs=0.0)
    assert history.error_estimate["peak_force"][0] <= 1e-3
    with pytest.raises(NotConvergedError, match="was not reached"):
        solve_to_accuracy(lambda settings: history, 1e-9, None, moves=True)


@pytest.mark.slow
def test_a_nearly_incompressible_layer_answers_like_an_incompressible_one():
    almost = QUICK.solve(impact_scene(1e-3, 0.49999))
    exactly = QUICK.solve(impact_scene(1e-3))
    assert almost.coefficient_of_restitution == pytest.approx(exactly.coefficient_of_restitution, abs=2e-4)
    assert almost.energy_residual < 1e-3


def kelvin_voigt_restitution(damping):
    """Closed form (49) and its continuation through D = 1."""
    if damping == 1:
        return exp(-2)
    s = sqrt(abs(1 - damping**2))
    angle = atan(s / damping) if damping < 1 else atanh(s / damping)
    return exp(-2 * damping / s * angle)


@pytest.mark.first(1)
@pytest.mark.parametrize("damping", [0.05, 1.0, 3.0])
def test_flat_punch_on_a_kelvin_voigt_layer(damping):
    a, G, mass, k_bar = 1e-3, 1e6, 0.01, 3.61873584896  # k_bar: a/h = 1, nu = 1/2, from the integral equation
    viscosity = damping / sqrt(2 * a * k_bar / (mass * G))
    scene = Scene(
        layer=Layer.incompressible(thickness=a, shear_modulus=G),
        indenter=FlatPunch(radius=a),
        loading=Impact(mass=mass, velocity=0.1),
        effects=(KelvinVoigt(shear_modulus=G, viscosity=viscosity),),
    )
    history = Fem(growth=0.7, edge_cell=1e-6).solve(scene)
    error = history.coefficient_of_restitution / kelvin_voigt_restitution(damping) - 1
    assert abs(error) < 3e-4
    assert abs(error) <= history.error_estimate["coefficient_of_restitution"][0] < 5e-3


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


def test_contact_time_errs_by_the_square_of_the_step_wherever_contact_is_lost_within_it():
    """A straight line to the loss of contact left a factor between 0.47 and 0.69, by the part of the last step."""
    damping = 0.33
    relaxation = own(KelvinVoigt(shear_modulus=1.0, viscosity=2 * damping))
    exact = 2 * acos(damping) / sqrt(1 - damping**2)  # closed form, Eq. (48)
    steps = np.linspace(300, 302, 9)
    times = np.array([single_spring(relaxation, np.pi / exact * n)[1].time[-1] for n in steps])
    factors = (times / exact - 1) * steps**2
    assert np.ptp(factors) < 0.01 * abs(factors.mean())


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
    restitution = kelvin_voigt_restitution(damping)
    # Contact ends when the force x + 2 D x' of the oscillator vanishes: x = -2 D x' = 2 D e.
    stored = (2 * damping * restitution) ** 2 / 2
    exact = np.array([stored, 0.5 - restitution**2 / 2 - stored])
    factors = []
    for steps in np.linspace(300, 302, 9):
        motion = single_spring(relaxation, steps)[1]
        factors.append((np.array([motion.stored[-1], motion.dissipated[-1]]) - exact) * steps**2)
    assert np.ptp(factors, axis=0) == pytest.approx(np.zeros(2), rel=0.0, abs=0.01)


@pytest.mark.first(1)
@pytest.mark.parametrize("damping", [0.3, 0.5, 2.0])
def test_peak_force_of_a_kelvin_voigt_impact_is_within_its_error_bar(damping):
    # a damped oscillator, s = sqrt(1 - D^2), t in units of sqrt(M / k): F is M v_0 sqrt(k / M) times
    # exp(-D t) (2 D cos(s t) + (1 - 2 D^2) / s sin(s t)), with its peak at tan(s t) = s (1 - 4 D^2) / (D (3 - 4 D^2)),
    # or at first touch if D >= 1/2
    a, G, mass, speed, k_bar = 1e-3, 1e6, 0.01, 0.1, 3.61873584896
    stiffness = 8 * G * a * k_bar
    viscosity = damping * 2 * G * sqrt(mass / stiffness)
    unit = sqrt(mass * stiffness) * speed
    s = sqrt(abs(1 - damping**2))
    t = atan(s * (1 - 4 * damping**2) / (damping * (3 - 4 * damping**2))) / s if damping < 0.5 else 0.0
    exact = unit * exp(-damping * t) * (2 * damping * np.cos(s * t) + (1 - 2 * damping**2) / s * np.sin(s * t))
    scene = Scene(
        layer=Layer.incompressible(thickness=a, shear_modulus=G),
        indenter=FlatPunch(radius=a),
        loading=Impact(mass=mass, velocity=speed),
        effects=(KelvinVoigt(shear_modulus=G, viscosity=viscosity),),
    )
    history = Fem(growth=0.7, edge_cell=1e-6).solve(scene)
    assert abs(history.peak_force / exact - 1) <= history.error_estimate["peak_force"][0]
    assert history.normal_force[0] == pytest.approx(2 * damping * unit, rel=1e-4, abs=0.0)


# peaks of a paraboloid, R = h, that hits a standard solid with G_inf = G_0 / 10, by the reduction to springs
@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("velocity", "tau", "growth", "name", "expected"),
    [
        pytest.param(1e-4, 1.0, 0.5, "peak_force", 2.08980381127e-06, marks=pytest.mark.slow),
        (0.1, 0.01232846739, 1.0, "peak_contact_radius", 0.327763089776),
    ],
)
def test_grids_that_agree_at_a_peak_by_accident_do_not_narrow_its_error_bar(velocity, tau, growth, name, expected):
    g = 1 / 3
    solid = StandardSolid(long_term_shear_modulus=0.1 * g, maxwell_shear_modulus=0.9 * g, viscosity=0.9 * g * tau)
    layer = Layer(thickness=1.0, youngs_modulus=3 * g, poissons_ratio=0.5)
    impact = Impact(mass=0.05, velocity=velocity)
    scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=1.0), loading=impact, effects=(solid,))
    history = Fem(growth=growth, order=3, edge_cell=1e-5).solve(scene)
    error = abs(getattr(history, name) / expected - 1)
    assert error <= history.error_estimate[name][0]


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


def test_depth_history_relaxes_to_the_long_term_modulus():
    layer = Layer.incompressible(thickness=1e-3, shear_modulus=G1 + G_INF)
    loading = DepthHistory(time=[0, 1e-6, 20e-3], depth=[0, 5e-5, 5e-5])
    history = QUICK.solve(Scene(layer=layer, indenter=BALL, loading=loading, effects=(SOLID,)))
    at_hold = np.argmin(np.abs(history.time - 1e-6))
    # the force of a held contact relaxes as G(t): G_0 at once (the ramp lasts tau / 1000), G_inf at last
    assert history.normal_force[-1] / history.normal_force[at_hold] == pytest.approx(0.1, rel=2e-3, abs=0.0)
    assert history.contact_radius[at_hold] == pytest.approx(history.contact_radius[-1], rel=2e-2, abs=0.0)


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


@pytest.mark.parametrize("effects", [(), (SOLID,)])
def test_peak_depth_is_of_the_energys_order_in_the_cells(effects):
    """The mesh outside the strip must not hide the third order: it moved the peak by 5e-5 from mesh to mesh."""
    setup = HistorySetup(impact_scene(3e-3, effects=effects), QUICK, StageLog())
    radius, duration = 1.2e-3, 1.6e-5

    def peak_depth(cells):
        strip = setup.strip(radius, cells)
        mass, velocity = IMPACT.mass / ((G1 + G_INF) * radius), IMPACT.velocity / radius
        return peak(simulate_impact(strip, mass, velocity, duration).depth)

    fine = peak_depth(60)
    assert [peak_depth(cells) for cells in (30, 40)] == pytest.approx([fine, fine], rel=1e-5, abs=0.0)


@pytest.mark.slow
def test_a_force_that_goes_back_to_zero_is_zero_in_the_end():
    """Roundings of the ramp left 3e-17 of it; "no depth has the prescribed force"."""
    layer = Layer.incompressible(thickness=1e-3, shear_modulus=G1 + G_INF)
    for peak_force in np.linspace(1.0, 2.0, 3):
        loading = ForceHistory(time=[0.0, 1e-3, 2e-3], force=[0.0, peak_force, 0.0])
        answer = QUICK.solve(Scene(layer=layer, indenter=BALL, loading=loading, effects=(SOLID,)))
        assert answer.normal_force[-1] == answer.contact_radius[-1] == 0.0


@pytest.mark.slow
def test_a_ramp_of_depth_on_a_dashpot_is_that_of_the_half_space():
    """F = (16/3) sqrt(R) G d^1.5 + 8 eta a d'; at equal steps the contact on cells missed 3.5e-3 of the peak."""
    G, R, depth, ramp, eta = 1e6, 0.01, 1e-5, 0.05, 3e4
    scene = Scene(
        layer=Layer.half_space(youngs_modulus=3 * G, poissons_ratio=0.5),
        indenter=Paraboloid(radius_of_curvature=R),
        loading=DepthHistory(time=[0.0, ramp, 1.0], depth=[0.0, depth, depth]),
        effects=(KelvinVoigt(shear_modulus=G, viscosity=eta),),
    )
    answer = Fem().solve(scene)
    d, rate = np.interp(answer.time, [0.0, ramp], [0.0, depth]), np.where(answer.time <= ramp, depth / ramp, 0.0)
    exact = 16 / 3 * np.sqrt(R) * G * d**1.5 + 8 * eta * np.sqrt(R * d) * rate
    error = np.abs(answer.normal_force - exact) / exact.max()
    assert np.all(error <= answer.error_estimate["normal_force"])
    assert error[answer.time > 0.01 * ramp].max() < 3e-4

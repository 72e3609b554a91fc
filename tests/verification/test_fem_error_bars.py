"""Do the error bars hold? Scenes and settings drawn at random (fixed seed), true errors from independent methods."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    Detachment,
    FlatPunch,
    Impact,
    IndentationDepths,
    KelvinVoigt,
    Layer,
    NormalForces,
    Paraboloid,
    PowerLaw,
    Scene,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
    UnsupportedSceneError,
)
from fem_reference import Fem
from mdr import Mdr
from tests.drawn_scenes import random_scene
from tests.referees.second_opinion import second_opinion

LAYER = Layer(thickness=0.5, youngs_modulus=1.0, poissons_ratio=0.3)


@pytest.mark.parametrize("stream", [[2, 13], [3, 23], [6, 0], [6, 7]])
def test_requested_accuracies_of_incompressible_layers_are_covered(stream):
    """Four scenes whose depth or force was off by 1.1 to 1.2 times what was stated: errors fall slower at nu = 1/2."""
    scene = random_scene(np.random.default_rng(stream), "elastic", (0.1, 5.0))
    path = Fem(accuracy=1e-2).solve(scene)
    for name, expected in second_opinion(path).values.items():
        assert np.all(np.abs(getattr(path, name) / expected - 1) <= path.error_estimate[name] + 1e-14), name


def test_error_of_the_edge_cell_follows_the_slope_of_the_depth():
    """The depth of a profile r^9 on a half-space grows like a^9 (closed form), and errs nine times as the radius."""
    indenter = PowerLaw(exponent=9.0, reference_radius=1.0, reference_height=0.1)
    scene = Scene(
        layer=Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.0),
        indenter=indenter,
        loading=ContactRadii(values=np.array([1.0])),
    )
    path = Fem(growth=0.4, edge_cell=1e-3).solve(scene)
    opinion = second_opinion(path).values
    for name in ("indentation_depth", "normal_force"):
        error = abs(getattr(path, name)[0] / opinion[name][0] - 1)
        assert error < path.error_estimate[name][0]


@pytest.mark.parametrize("gap", [1e-3, pytest.param(1e-5, marks=pytest.mark.slow), 1e-7])
def test_contacts_that_are_nearly_flat_punches(gap):
    indenter = TruncatedCone(flat_radius=1 - gap, slope=0.1)
    scene = Scene(layer=LAYER, indenter=indenter, loading=ContactRadii(values=np.array([1.0])))
    path = Fem(order=4, growth=0.6, edge_cell=1e-5).solve(scene)
    opinion = second_opinion(path).values
    for name in ("indentation_depth", "normal_force", "contact_stiffness"):
        error = abs(getattr(path, name)[0] / opinion[name][0] - 1)
        assert error < path.error_estimate[name][0] < 1e-2  # errors were 1e-3 at a gap of 1e-7


def test_a_slow_rebound_states_how_long_its_last_cell_may_stay():
    # The radius halves in times that hardly shorten, so that contact ends long after it is half a cell wide.
    layer = Layer(thickness=1.0, youngs_modulus=3.0, poissons_ratio=0.5)
    relaxes = KelvinVoigt(shear_modulus=1.0, viscosity=5.0)
    scene = Scene(layer=layer, indenter=Cone(slope=0.1), loading=Impact(mass=0.2, velocity=0.05), effects=(relaxes,))
    answer, exact = Fem(growth=1.0).solve(scene), Mdr().solve(scene)
    for name in ("contact_time", "coefficient_of_restitution", "peak_force", "peak_depth"):
        error = abs(getattr(answer, name) / getattr(exact, name) - 1.0)
        assert error < answer.error_estimate[name][0], name


def test_radius_of_an_impact_that_ends_beside_the_flat_end():
    scene = Scene(
        layer=Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.4),
        indenter=TruncatedCone(flat_radius=1.0, slope=0.01),
        loading=Impact(mass=1.0, velocity=5e-4),
    )
    history, exact = Fem(growth=1.0).solve(scene), Mdr().solve(scene)
    assert 1.0 < exact.peak_contact_radius < 1.02  # within a cell of the rim
    for name in ("peak_contact_radius", "peak_force", "coefficient_of_restitution"):
        error = abs(getattr(history, name) / getattr(exact, name) - 1)
        assert error < history.error_estimate[name][0]


@pytest.mark.slow
@pytest.mark.parametrize("control", ["displacement", "force"])
def test_interpolation_of_a_measured_profile_is_judged_in_the_detachment(control):
    radii = np.linspace(0.0, 2.0, 31)
    rises = np.diff(radii**2 / 20) * (1 + 0.02 * np.random.default_rng(7).uniform(-1, 1, 30))
    indenter = Tabulated(radii=radii, heights=np.concatenate([[0.0], np.cumsum(rises)]))
    effects = (Adhesion(work_of_adhesion=2e-4),)
    scene = Scene(layer=LAYER, indenter=indenter, loading=Detachment(control=control), effects=effects)
    path, exact = Fem(growth=1.0, edge_cell=1e-4).solve(scene), Mdr().solve(scene)
    for name in ("pull_off_force", "pull_off_depth", "pull_off_contact_radius"):
        assert abs(getattr(path, name) / getattr(exact, name) - 1) < path.error_estimate[name][0]


@pytest.mark.slow
def test_place_of_a_pull_off_just_inside_the_rim_of_a_punch():
    """Peeling of an incompressible layer is stable from a/h = 0.4619 on: at 0.462 contact is lost beside the rim."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5)
    scene = Scene(
        layer=layer,
        indenter=FlatPunch(radius=0.462),
        loading=Detachment(control="displacement"),
        effects=(Adhesion(work_of_adhesion=1e-4),),
    )
    path, exact = Fem(order=3, edge_cell=1e-5).solve(scene), Mdr().solve(scene)
    error = abs(path.pull_off_contact_radius / exact.pull_off_contact_radius - 1)
    assert error < path.error_estimate["pull_off_contact_radius"][0]  # 6e-10 where the bend was read beyond the rim


@pytest.mark.slow
def test_a_punch_whose_stability_reverses_is_lost_at_the_lowest_turning_point():
    """From a/h = 8 at nu = 0.365 contact jumps to the stable part of the branch and comes off at the maximum of dl."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.365)
    effects = (Adhesion(work_of_adhesion=1e-4),)
    scene = Scene(
        layer=layer, indenter=FlatPunch(radius=8.0), loading=Detachment(control="displacement"), effects=effects
    )
    path = Fem(order=3, edge_cell=1e-5).solve(scene)
    found, stated = path.pull_off_contact_radius, path.error_estimate["pull_off_contact_radius"][0]
    assert abs(found / 1.91953 - 1) < stated  # the maximum of Eq. (42), from the integral equation


def at_loads(random_numbers, settings, family_seed):
    """Stated over true error of every quantity of elastic scenes with prescribed depth or force."""
    ratios = {}
    for number in random_numbers:
        scene = random_scene(np.random.default_rng([family_seed, number]), "elastic", (0.1, 5.0))
        if isinstance(scene.loading, ContactRadii) or isinstance(scene.indenter, FlatPunch):
            continue
        try:
            path = Fem(**settings).solve(scene)
        except UnsupportedSceneError as refusal:
            assert "no single circle" in str(refusal)  # noqa: PT017 - measured profiles need not make one circle
            continue
        opinion = second_opinion(path).values
        for name, expected in opinion.items():
            stated, error = path.error_estimate[name], np.abs(getattr(path, name) / expected - 1)
            ratios.setdefault(name, []).extend((stated / np.maximum(error, 1e-15))[stated > 0])
    return ratios


def assert_covered(ratios):
    for name, stated_over_true in ratios.items():
        assert np.mean(np.array(stated_over_true) >= 1) >= 0.95, name
        assert np.median(stated_over_true) < 50, name


def test_radius_at_a_load_errs_like_the_load_at_the_radius():
    """Also force and depth: their errors at a fixed radius cancel where the radius follows the load."""
    # At a thickness of 0.5 the error of the stiffness passes zero.
    layer = Layer(thickness=0.55, youngs_modulus=1.0, poissons_ratio=0.3)
    loads = IndentationDepths(values=[0.05]), NormalForces(values=[0.1])
    for loading in loads:
        scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=1.0), loading=loading)
        path = Fem().solve(scene)
        for name, expected in second_opinion(path).values.items():
            error = abs(getattr(path, name)[0] / expected[0] - 1)
            stated = path.error_estimate[name][0]
            assert stated == 0 or error < stated, name


def test_coarse_meshes_cover_errors_at_a_load():
    """Errors of depth, force and stiffness at a load fall as fast on coarse meshes as on fine ones."""
    ratios = at_loads((0, 4, 5), {"accuracy": 1e-2}, 3)
    del ratios["contact_radius"]
    assert_covered(ratios)


@pytest.mark.slow
def test_a_load_on_a_coarse_mesh_beside_a_flat_end_is_found():
    """At b/a = 0.9999 neighbouring meshes differ by 8e-3 in the load: three solutions did not settle."""
    scene = random_scene(np.random.default_rng([3, 13]), "elastic", (0.1, 5.0))
    path = Fem(accuracy=1e-2).solve(scene)
    for name, expected in second_opinion(path).values.items():
        stated, error = path.error_estimate[name], np.abs(getattr(path, name) / expected - 1)
        assert np.all(error <= stated + 1e-14), name


@pytest.mark.slow
@pytest.mark.parametrize("number", [0, 1])
def test_a_load_whose_fine_mesh_mistakes_its_growth_is_found(number):
    """At a/b - 1 = 7e-7 and 9e-6 the solution's own growth of the force was 5 and 0.2 where it is 1/2."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5)
    indenter = TruncatedParaboloid(flat_radius=2.8, radius_of_curvature=1e5)
    radii = ContactRadii(values=[2.8 * 1.00000066, 2.8 * 1.00000939])
    exact = Mdr().solve(Scene(layer=layer, indenter=indenter, loading=radii))
    path = Fem().solve(exact.scene.replace(loading=NormalForces(exact.normal_force[number : number + 1])))
    for name, expected in second_opinion(path).values.items():
        assert np.all(np.abs(getattr(path, name) / expected - 1) <= path.error_estimate[name] + 1e-14), name


@pytest.mark.slow
@pytest.mark.parametrize("number", [1, 4])
def test_a_load_that_a_coarse_mesh_does_not_carry_is_solved_on_finer_ones(number):
    """Beside a flat end the first mesh of accuracy 1e-3 ended in a radius that does not settle."""
    scene = random_scene(np.random.default_rng([53, number]), "elastic", (0.1, 5.0))
    path = Fem(accuracy=1e-3).solve(scene)
    assert max(path.error_estimate[name].max() for name in path.ARRAYS) <= 1e-3


@pytest.mark.slow
@pytest.mark.parametrize(("settings", "seed"), [({}, 5), ({"accuracy": 1e-2}, 3), ({"accuracy": 1e-4}, 1)])
def test_errors_at_a_load_are_covered(settings, seed):
    assert_covered(at_loads(range(30), settings, seed))


def test_pressure_at_a_depth():
    """The mesh's radius misses the load's by 1e-5: as much of a flat punch's singular pressure is left in the field."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.04, support="unbonded")
    depth = IndentationDepths(values=[0.15])
    scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=25.0), loading=depth)
    path, exact = Fem().solve(scene), Mdr().solve(scene)
    s, weight = np.polynomial.legendre.leggauss(100)
    r = exact.contact_radius[0] * (1 - ((1 - s) / 2) ** 4)
    weight = weight * (1 - s) ** 3 * r
    expected = exact.pressure(r)
    error = np.sqrt(weight @ (path.pressure(r) - expected) ** 2 / (weight @ expected**2))
    assert error < path.error_estimate["pressure"][0]


PULLED = Scene(
    layer=LAYER,
    indenter=Paraboloid(radius_of_curvature=1.0),
    loading=Detachment(control="displacement"),
    effects=(Adhesion(work_of_adhesion=1e-3),),
)
PULL_OFF = ("pull_off_force", "pull_off_depth", "pull_off_contact_radius")


@cache
def pulled(control):
    """Two tests look at either of these."""
    return Fem(accuracy=1e-3).solve(PULLED.replace(loading=Detachment(control=control)))


@pytest.mark.parametrize("control", ["displacement", "force"])
def test_errors_of_a_pull_off_follow_from_those_at_its_radius(control):
    path = pulled(control)
    exact = Mdr().solve(path.scene)
    errors = [abs(getattr(path, name) / getattr(exact, name) - 1) for name in PULL_OFF]
    ratios = [path.error_estimate[name][0] / error for name, error in zip(PULL_OFF, errors, strict=True)]
    assert min(ratios) > 1


def test_strongest_pull_is_the_extremum_whatever_is_controlled():
    """Under displacement control the force passes its extremum, where pull-off lies under force control."""
    forces = [pulled(control).pull_off_force for control in ("displacement", "force")]
    # Each is refined until its own errors hold.
    assert forces[0] == pytest.approx(forces[1], rel=1e-6, abs=0.0)


def test_two_degrees_that_agree_by_accident_are_not_believed_at_the_edge_of_a_flat_end():
    """k_N' at a/h = 26 erred by 1.2e-3 with both of the last two degrees, whose difference was 9.6e-5."""
    scene = Scene(
        layer=Layer(thickness=1.80411e-5, youngs_modulus=858.075, poissons_ratio=0.420302),
        indenter=TruncatedCone(flat_radius=4.69658e-4, slope=10.3437),
        loading=Detachment(control="displacement", machine_stiffness=9.50663),
        effects=(Adhesion(work_of_adhesion=1.13365e-6),),
        beyond_small_strains=True,
    )
    path, exact = Fem(accuracy=1e-3).solve(scene), Mdr().solve(scene)
    for name in ("pull_off_force", "pull_off_depth", "force_at_loss"):
        assert abs(getattr(path, name) / getattr(exact, name) - 1) <= path.error_estimate[name][0], name


@pytest.mark.slow
@pytest.mark.parametrize(("accuracy", "seed"), [(1e-2, 3), (1e-3, 1)])
def test_errors_of_pull_offs_are_covered(accuracy, seed):
    ratios = {}
    for number in range(20):
        scene = random_scene(np.random.default_rng([seed, number]), "adhesive", (0.1, 5.0))
        path, exact = Fem(accuracy=accuracy).solve(scene), Mdr().solve(scene)
        for name in PULL_OFF:
            error = abs(getattr(path, name) / getattr(exact, name) - 1)
            if path.error_estimate[name][0] > 1e-11:
                ratios.setdefault(name, []).append(path.error_estimate[name][0] / error)
    assert_covered(ratios)


@pytest.mark.slow
@pytest.mark.parametrize("stream", [[3, 23], [41, 20], [41, 24]])
def test_places_of_pull_offs_are_covered(stream):
    """The place was off by 4.3 times what was stated between the points of a table, by 1.06 times of power laws."""
    scene = random_scene(np.random.default_rng(stream), "adhesive", (0.1, 5.0))
    path, exact = Fem(accuracy=1e-2).solve(scene), Mdr().solve(scene)
    error = abs(path.pull_off_contact_radius / exact.pull_off_contact_radius - 1)
    assert error <= path.error_estimate["pull_off_contact_radius"][0]


@pytest.mark.slow
def test_a_pull_off_between_solved_radii_states_their_scatter():
    """The error passes zero between two solved radii, and so does its change by the degree: 1.15 times was missed."""
    scene = Scene(
        layer=Layer(thickness=157.71131, youngs_modulus=1.0, poissons_ratio=0.12775847, support="unbonded"),
        indenter=PowerLaw(exponent=6.0089396, reference_radius=1.6506182, reference_height=0.024663471),
        loading=Detachment(control="force"),
        effects=(Adhesion(work_of_adhesion=5.1372418e-07),),
    )
    path, exact = Fem(accuracy=1e-2).solve(scene), Mdr().solve(scene)
    for name in ("pull_off_force", "force_at_loss"):
        error = abs(getattr(path, name) / getattr(exact, name) - 1)
        assert error < path.error_estimate[name][0], name

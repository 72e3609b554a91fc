from __future__ import annotations

import numpy as np
import pytest

from contact import (
    Adhesion,
    ContactRadii,
    Detachment,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    NormalForces,
    Paraboloid,
    Scene,
    TruncatedCone,
)
from fem_reference import Fem
from fem_reference.settings import Discretisation
from tests.fem_reference.cohesive_zone import CohesivePunch
from tests.fem_reference.integral_equation import solve_contact, truncated_cone

QUICK = Fem(growth=1.0, edge_cell=1e-6, truncation=1e-7)
WORK = 0.05
HALF_SPACE = Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.3)


def adhesive(layer, indenter, loading, work=WORK):
    return Scene(layer=layer, indenter=indenter, loading=loading, effects=(Adhesion(work_of_adhesion=work),))


def unit_layer(nu=0.5, support="bonded"):
    return Layer(thickness=1.0, youngs_modulus=1 - nu**2, poissons_ratio=nu, support=support)  # E* = 1


def test_half_space_paraboloid_at_given_radius():
    # JKR: delta = a^2/R - sqrt(2 pi a dgamma/E*), F = E* (4 a^3/(3R) - 2 a sqrt(2 pi a dgamma/E*))
    a, R, E = 1e-4, 1e-2, HALF_SPACE.contact_modulus
    scene = adhesive(HALF_SPACE, Paraboloid(radius_of_curvature=R), ContactRadii([a]))
    path = QUICK.solve(scene)
    dl = np.sqrt(2 * np.pi * a * WORK / E)
    assert path.indentation_depth[0] == pytest.approx(
        a**2 / R - dl, rel=path.error_estimate["indentation_depth"][0], abs=0.0
    )
    exact_force = E * (4 * a**3 / (3 * R) - 2 * a * dl)
    assert path.normal_force[0] == pytest.approx(exact_force, rel=path.error_estimate["normal_force"][0], abs=0.0)
    assert path.error_estimate["normal_force"][0] < 1e-2


@pytest.mark.parametrize("ratio", [0.5, 2.0])
def test_layer_truncated_cone_at_given_radius(ratio):
    exact = solve_contact(ratio, "bonded", 0.45, truncated_cone(ratio / 2), ratio / 2)
    scene = adhesive(
        unit_layer(0.45), TruncatedCone(flat_radius=ratio / 2, slope=0.1), ContactRadii([ratio]), work=1e-4
    )
    path = QUICK.solve(scene)
    dl = np.sqrt(4 * np.pi * ratio * 1e-4 / exact.stiffness_slope)
    assert path.indentation_depth[0] == pytest.approx(0.1 * exact.depth - dl, rel=1e-3, abs=0.0)
    assert path.normal_force[0] == pytest.approx(0.1 * exact.force - exact.stiffness * dl, rel=1e-3, abs=0.0)


@pytest.mark.slow
def test_sphere_pull_off_from_the_half_space():
    # JKR: F = -(3/2) pi R dgamma under force control; under displacement control F = -(5/6) pi R dgamma at the end
    R = 1e-2
    indenter = Paraboloid(radius_of_curvature=R)
    by_force = QUICK.solve(adhesive(HALF_SPACE, indenter, Detachment(control="force")))
    by_depth = QUICK.solve(adhesive(HALF_SPACE, indenter, Detachment(control="displacement")))
    assert by_force.pull_off_force == pytest.approx(-1.5 * np.pi * R * WORK, rel=3e-4, abs=0.0)
    a = (np.pi * WORK * R**2 / 8 / HALF_SPACE.contact_modulus) ** (1 / 3)  # where d(delta)/da = 0
    assert by_depth.pull_off_contact_radius == pytest.approx(a, rel=1e-3, abs=0.0)
    lost = next(p for p in by_depth.critical_points if p.control == "displacement")
    assert lost.normal_force == pytest.approx(-5 / 6 * np.pi * R * WORK, rel=1e-3, abs=0.0)
    assert np.all(np.diff(by_depth.contact_radius) < 0)


@pytest.mark.slow
def test_flat_punch_on_an_incompressible_layer_detaches_stably_and_then_jumps():
    """The radius at the maximum is where it is flat, and needs a finer mesh: `test_threshold_of_stable_detachment`."""
    method = Fem(order=3, growth=0.7, edge_cell=1e-6, truncation=1e-7)
    path = method.solve(adhesive(unit_layer(), FlatPunch(radius=1.0), Detachment(), work=1e-4))
    # the maximum of the elongation at a/h = 0.461904, its size 0.392203 sqrt(2 pi dgamma h / E*) (integral equation)
    assert path.pull_off_depth == pytest.approx(-0.392203 * np.sqrt(2 * np.pi * 1e-4), rel=1e-3, abs=0.0)
    exact = solve_contact(1.0)
    start = np.sqrt(4 * np.pi * 1e-4 / exact.stiffness_slope)
    assert path.pull_off_force == pytest.approx(-exact.stiffness * start, rel=1e-3, abs=0.0)
    assert [p.kind for p in path.critical_points] == ["start", "start", "pull-off"]
    assert path.stable_displacement_control[path.contact_radius > 0.47].all()
    assert not path.stable_force_control.any()


@pytest.mark.slow
def test_threshold_of_stable_detachment():
    # integral equation: the maximum of the elongation, nu: (a/h, dl / sqrt(2 pi dgamma h / E*))
    for nu, start, radius, elongation in ((0.5, 1.0, 0.461904, 0.392203), (0.45, 1.0, 0.600217, 0.417261)):
        path = Fem().solve(adhesive(unit_layer(nu), FlatPunch(radius=start), Detachment(), work=1e-4))
        assert path.pull_off_contact_radius == pytest.approx(radius, rel=1e-4, abs=0.0)
        assert path.pull_off_depth == pytest.approx(-elongation * np.sqrt(2 * np.pi * 1e-4), rel=1e-5, abs=0.0)


@pytest.mark.slow
def test_small_or_compressible_punch_jumps_at_once():
    for nu, a in ((0.5, 0.3), (0.3, 1.0)):
        path = QUICK.solve(adhesive(unit_layer(nu), FlatPunch(radius=a), Detachment(), work=1e-4))
        assert path.pull_off_contact_radius == a
        # The branch is solved on stretched meshes, the pull-off is not.
        apart = abs(path.pull_off_depth / path.indentation_depth[0] - 1)
        assert apart < path.error_estimate["indentation_depth"][0] + path.error_estimate["pull_off_depth"][0] < 1e-3


@pytest.mark.slow
def test_cavitation_is_announced_where_the_centre_presses_most():
    thin = QUICK.solve(adhesive(unit_layer(), FlatPunch(radius=2.0), Detachment(), work=1e-4))
    thick = QUICK.solve(adhesive(unit_layer(), FlatPunch(radius=0.5), Detachment(), work=1e-4))
    assert "second maximum" in thin.notes[0]
    assert thick.notes == ()


@pytest.mark.slow
def test_depth_and_force_control_on_the_stable_branch():
    indenter = Paraboloid(radius_of_curvature=1.0)
    at_radius = QUICK.solve(adhesive(unit_layer(), indenter, ContactRadii([0.5]), work=1e-3))
    for loading in (IndentationDepths(at_radius.indentation_depth), NormalForces(at_radius.normal_force)):
        found = QUICK.solve(adhesive(unit_layer(), indenter, loading, work=1e-3))
        assert found.contact_radius[0] == pytest.approx(0.5, rel=1e-3, abs=0.0)


@pytest.mark.slow
def test_adhering_flat_punch_takes_tension_until_it_comes_off():
    punch = FlatPunch(radius=0.3)
    start = QUICK.solve(adhesive(unit_layer(), punch, Detachment(), work=1e-4)).pull_off_depth
    path = QUICK.solve(adhesive(unit_layer(), punch, IndentationDepths([0.9 * start, -start]), work=1e-4))
    assert path.contact_radius.tolist() == [0.3, 0.3]
    assert path.normal_force[0] == pytest.approx(-0.9 * path.normal_force[1], rel=1e-12, abs=0.0)
    with pytest.raises(InvalidInput, match="pull-off"):
        QUICK.solve(adhesive(unit_layer(), punch, IndentationDepths([1.1 * start]), work=1e-4))


def test_no_work_of_adhesion_is_elastic_contact():
    indenter = Paraboloid(radius_of_curvature=1.0)
    without = QUICK.solve(adhesive(unit_layer(), indenter, ContactRadii([0.5]), work=0.0))
    elastic = QUICK.solve(Scene(layer=unit_layer(), indenter=indenter, loading=ContactRadii([0.5])))
    assert without.indentation_depth[0] == pytest.approx(elastic.indentation_depth[0], rel=1e-12, abs=0.0)
    assert without.normal_force[0] == pytest.approx(elastic.normal_force[0], rel=1e-12, abs=0.0)


def test_cohesive_zone_converges_to_the_energy_argument_as_it_shrinks():
    punch = CohesivePunch(unit_layer(), 1.0, Discretisation(edge_cell=1e-4, growth=0.3, truncation=1e-6))
    exact, work = solve_contact(1.0), 1e-4
    force = -exact.stiffness * np.sqrt(4 * np.pi * work / exact.stiffness_slope)
    pull_offs = [punch.pull_off(work, strength * np.sqrt(work)) for strength in (5, 10)]
    errors = [abs(p.force / force - 1) for p in pull_offs]
    assert pull_offs[1].zone < 0.3 * pull_offs[0].zone
    assert errors[1] < 0.3 * errors[0]
    assert errors[1] < 0.01


def test_a_zone_that_covers_the_contact_or_no_cell_is_refused():
    punch = CohesivePunch(unit_layer(), 1.0, Discretisation(edge_cell=1e-2, growth=0.5, truncation=1e-4))
    with pytest.raises(InvalidInput, match="covers"):
        punch.pull_off(1e-4, 1e-3)
    with pytest.raises(InvalidInput, match="5 cells"):
        punch.pull_off(1e-4, 10.0)


@pytest.mark.slow
def test_the_pull_off_from_a_layer_is_found_on_a_coarse_mesh():
    """On meshes of their own, interpolated plainly, three accuracies took 154 factorisations."""
    scene = adhesive(
        Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.5),
        Paraboloid(radius_of_curvature=1e-2),
        Detachment(control="force"),
    )
    assert Fem(accuracy=1e-3).solve(scene).cost.counters["factorisations"] < 60


@pytest.mark.slow
def test_contacts_of_a_half_space_share_their_factors():
    scene = adhesive(HALF_SPACE, Paraboloid(radius_of_curvature=1e-2), Detachment(control="force"))
    assert QUICK.solve(scene).cost.counters["factorisations"] < 10

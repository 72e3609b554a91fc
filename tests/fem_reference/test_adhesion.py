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

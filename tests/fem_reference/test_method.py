from __future__ import annotations

import numpy as np
import pytest

from contact import (
    Cone,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    Method,
    NormalForces,
    NotConvergedError,
    Paraboloid,
    Scene,
    TruncatedCone,
)
from fem_reference import Fem, prescribed_contact, stated
from tests.fem_reference.integral_equation import solve_contact, truncated_cone

THICKNESS, MODULUS, SLOPE = 1e-3, 1e6, 0.1
QUICK = Fem(growth=1.0, edge_cell=1e-6, truncation=1e-7)


def told(path):
    """Notes about accuracy; thin nearly incompressible layers tell of friction as well."""
    return tuple(note for note in path.notes if not note.startswith("frictionless: "))


def layer(nu=0.5, support="bonded", thickness=THICKNESS):
    return Layer(thickness=thickness, youngs_modulus=MODULUS, poissons_ratio=nu, support=support)


def cone_scene(ratio, nu=0.5, support="bonded"):
    a = ratio * THICKNESS
    indenter = TruncatedCone(flat_radius=a / 2, slope=SLOPE)
    return Scene(layer=layer(nu, support), indenter=indenter, loading=ContactRadii([a]))


def true_errors(path, ratio, nu, support):
    """Relative errors of depth, force and stiffness against the integral equation."""
    exact = solve_contact(ratio, support, nu, truncated_cone(ratio / 2), ratio / 2)
    modulus = path.scene.layer.contact_modulus
    return {
        "indentation_depth": path.indentation_depth[0] / (exact.depth * SLOPE * THICKNESS) - 1,
        "normal_force": path.normal_force[0] / (exact.force * SLOPE * modulus * THICKNESS**2) - 1,
        "contact_stiffness": path.contact_stiffness[0] / (exact.stiffness * modulus * THICKNESS) - 1,
    }


def assert_covered(path, errors, size):
    for quantity, error in errors.items():
        assert abs(error) <= path.error_estimate[quantity][0] <= size, quantity


@pytest.mark.first(2)
@pytest.mark.parametrize("ratio", [0.1, 20])
@pytest.mark.parametrize(("nu", "support"), [(0.5, "bonded"), (0.45, "bonded"), (0.3, "unbonded")])
def test_truncated_cone_within_its_error_bars(ratio, nu, support):
    path = QUICK.solve(cone_scene(ratio, nu, support))
    assert_covered(path, true_errors(path, ratio, nu, support), 2e-3)


def test_requested_accuracy_is_reached():
    path = Fem(accuracy=1e-4).solve(cone_scene(2, 0.3))
    assert_covered(path, true_errors(path, 2, 0.3, "bonded"), 1e-4)


@pytest.mark.first(1)
@pytest.mark.parametrize("loading", [ContactRadii([1e-3]), IndentationDepths([5e-5]), NormalForces([0.1])], ids=str)
def test_every_loading_is_refined_until_its_own_errors_hold(loading):
    """Where the radius is searched for, it counts too; the pressure states more, and the answer says so."""
    scene = Scene(layer=layer(0.49), indenter=TruncatedCone(flat_radius=0.5e-3, slope=0.1), loading=loading)
    path = Fem(accuracy=1e-4).solve(scene)
    assert max(path.error_estimate[name][0] for name in path.ARRAYS) <= 1e-4
    pressure = path.error_estimate["pressure"][0]
    assert pressure > 1e-4
    assert told(path) == (
        f"less accurate than the 0.0001 asked for, by the stated relative errors: pressure {pressure:.1e}",
    )


def test_an_accuracy_of_the_pressure_is_asked_by_its_own_name():
    path = Fem(accuracy=1e-2, pressure_accuracy=1e-3).solve(cone_scene(1))
    assert (
        path.error_estimate["pressure"][0]
        <= 1e-3
        < Fem(accuracy=1e-2).solve(cone_scene(1)).error_estimate["pressure"][0]
    )
    assert told(path) == ()
    with pytest.raises(InvalidInput, match="besides an accuracy"):
        Fem(pressure_accuracy=1e-3)


def test_an_accuracy_out_of_reach_names_the_quantity(monkeypatch):
    monkeypatch.setattr(stated, "ATTEMPTS", 1)
    with pytest.raises(NotConvergedError, match=r"accuracy 1e-06 of the pressure was not reached"):
        Fem(accuracy=1e-2, pressure_accuracy=1e-6).solve(cone_scene(1))


def test_hertz_pressure_and_displacement():
    # Hertz: p = (2 E*/(pi R)) sqrt(a^2 - r^2), delta = a^2/R, and outside
    # w = ((2a^2 - r^2) arcsin(a/r) + a sqrt(r^2 - a^2)) / (pi R)
    a, R = 1e-3, 0.1
    scene = Scene(
        layer=Layer.half_space(youngs_modulus=MODULUS, poissons_ratio=0.3),
        indenter=Paraboloid(radius_of_curvature=R),
        loading=ContactRadii([a]),
    )
    path = Fem().solve(scene)
    r = np.linspace(0, 0.99 * a, 50)
    exact = 2 * scene.layer.contact_modulus / (np.pi * R) * np.sqrt(a**2 - r**2)
    assert np.abs(path.pressure(r) - exact).max() < 2e-3 * exact[0]
    s = np.array([1.1, 2.0, 5.0]) * a
    outside = ((2 * a**2 - s**2) * np.arcsin(a / s) + a * np.sqrt(s**2 - a**2)) / (np.pi * R)
    assert path.surface_displacement(s) == pytest.approx(outside, rel=1e-5, abs=0.0)
    assert path.surface_displacement(r) == pytest.approx(a**2 / R - r**2 / (2 * R), rel=1e-6, abs=0.0)
    assert path.pressure(s).tolist() == [0, 0, 0]


def test_flat_punch_takes_depths_and_forces():
    a = THICKNESS
    indenter = FlatPunch(radius=a)
    depths = QUICK.solve(Scene(layer=layer(), indenter=indenter, loading=IndentationDepths([1e-6, 2e-6])))
    forces = QUICK.solve(Scene(layer=layer(), indenter=indenter, loading=NormalForces(depths.normal_force)))
    assert forces.indentation_depth == pytest.approx([1e-6, 2e-6], rel=1e-13, abs=0.0)
    # THEORY: k_bar = 3.61873584896 at nu = 1/2, a/h = 1
    exact = 2 * depths.scene.layer.contact_modulus * a * 3.61873584896
    error = depths.error_estimate["contact_stiffness"][0]
    assert abs(depths.contact_stiffness[0] / exact - 1) < error < 1e-2
    assert depths.cost.counters["factorisations"] == 2


def test_unbonded_layer_does_not_see_poissons_ratio():
    paths = [QUICK.solve(cone_scene(1, nu, "unbonded")) for nu in (0.0, 0.5)]
    force = [p.normal_force[0] / p.scene.layer.contact_modulus for p in paths]
    assert force[0] == pytest.approx(force[1], rel=2 * max(p.error_estimate["normal_force"][0] for p in paths), abs=0.0)


def test_a_cone_is_graded_at_its_tip():
    scene = Scene(
        layer=Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3),
        indenter=Cone(slope=SLOPE),
        loading=ContactRadii([1.0]),
    )
    path = QUICK.solve(scene)  # Sneddon: delta = pi a tan / 2
    assert abs(path.indentation_depth[0] / (np.pi / 2 * SLOPE) - 1) < path.error_estimate["indentation_depth"][0]


def test_settings_out_of_range_are_refused():
    for bad in ({"order": 5}, {"growth": 0}, {"edge_cell": 1.0}, {"accuracy": 1e-30}):
        with pytest.raises(InvalidInput, match=str(next(iter(bad.values())))):
            Fem(**bad)


def test_it_is_a_method():
    assert isinstance(Fem(), Method)


def test_energy_and_reaction_stiffness_must_agree(monkeypatch):
    def planted(problem, solutions):
        return (1 + 1e-7) * right(problem, solutions)

    right = prescribed_contact.energy_stiffness
    monkeypatch.setattr(prescribed_contact, "energy_stiffness", planted)
    with pytest.raises(NotConvergedError, match="energy"):
        QUICK.solve(cone_scene(1))

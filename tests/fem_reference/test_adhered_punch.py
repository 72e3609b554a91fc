"""The adhered flat punch by finite elements: MDR within stated errors, requested accuracies and refusals."""

import math

import numpy as np
import pytest

from contact import (
    Adhesion,
    ContactRadii,
    DepthHistory,
    FlatPunch,
    Friction,
    IndentationDepths,
    Layer,
    NormalForces,
    Scene,
    TruncatedCone,
    UnsupportedSceneError,
)
from fem_reference import Fem
from mdr import Mdr

STICK = (Friction(coefficient=math.inf),)
# Rounding that the second method states beside its answer.
ROUNDING = 1e-11


def layer(nu, support="bonded"):
    return Layer(thickness=1.0, youngs_modulus=3.0, poissons_ratio=nu, support=support)


def punch(body, radius=1.0, loading=None, effects=STICK):
    loading = IndentationDepths([1e-3]) if loading is None else loading
    return Scene(layer=body, indenter=FlatPunch(radius=radius), loading=loading, effects=effects)


def weighted_distance(path, fields):
    """Root mean squares of p, q differences over that of p, weighted by 1 - r^2/a^2; r = a sin t avoids the edge."""
    nodes, weights = np.polynomial.legendre.leggauss(200)
    angle = (nodes + 1.0) * math.pi / 4.0
    a = float(path.contact_radius[0])
    r, weight = a * np.sin(angle), weights * np.sin(angle) * np.cos(angle) ** 3
    p = fields.pressure(r, 0)
    of_p = weight @ (path.pressure(r) - p) ** 2
    of_q = weight @ (path.fields.tangential_traction(r, 0) - fields.tangential_traction(r, 0)) ** 2
    return np.sqrt(np.array([of_p, of_q]) / (weight @ p**2))


@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("nu", "support", "ratio"),
    [
        (0.0, "bonded", 0.2),
        (0.5, "bonded", 1.0),
        (0.45, "unbonded", 1.0),
        (0.0, "unbonded", 5.0),
        *(
            pytest.param(*other, marks=pytest.mark.slow)
            for other in (
                (0.3, "bonded", 1.0),
                (0.45, "bonded", 5.0),
                (0.3, "unbonded", 0.2),
                (0.5, "unbonded", 5.0),
            )
        ),
    ],
)
def test_two_methods_agree_within_stated_errors(nu, support, ratio):
    """Each support with a compressible and a nearly incompressible layer; the others are slow."""
    scene = punch(layer(nu, support), ratio)
    elements, exact = Fem().solve(scene), Mdr().solve(scene)
    for name in ("normal_force", "contact_stiffness"):
        stated = float(elements.error_estimate[name][0])
        assert 1e-9 < stated < 5e-5
        assert getattr(elements, name) == pytest.approx(getattr(exact, name), rel=stated + ROUNDING, abs=0.0)
    of_pressure, of_shear = weighted_distance(elements, exact.fields)
    assert of_pressure < elements.error_estimate["pressure"][0] < 5e-3
    assert of_shear < elements.error_estimate["tangential_traction"][0] < 2e-3


def test_surface_inside_the_contact_stays_where_it_touched():
    path = Fem(order=3).solve(punch(layer(0.3), 2.0))
    r = np.array([0.0, 0.7, 1.9])
    assert path.surface_displacement(r) == pytest.approx(np.full(3, 1e-3), rel=1e-12, abs=0.0)
    found = path.inside().at(r, 0.0)
    assert found.axial_displacement == pytest.approx(np.full(3, 1e-3), rel=1e-12, abs=0.0)
    assert found.radial_displacement == pytest.approx(np.zeros(3), rel=0.0, abs=1e-15)


def test_depths_and_forces_are_one_solution_scaled():
    depths = Fem(order=3).solve(punch(layer(0.3), loading=IndentationDepths([1e-3, 3e-3])))
    forces = Fem(order=3).solve(punch(layer(0.3), loading=NormalForces(depths.normal_force)))
    assert forces.indentation_depth == pytest.approx([1e-3, 3e-3], rel=1e-12, abs=0.0)
    assert depths.normal_force[1] == pytest.approx(3.0 * depths.normal_force[0], rel=1e-13, abs=0.0)
    assert forces.uncertainty("indentation_depth") == pytest.approx(
        forces.indentation_depth * depths.error_estimate["normal_force"][1], rel=1e-3, abs=0.0
    )
    assert np.all(forces.uncertainty("normal_force") == 0.0)
    r = np.array([0.2, 0.9])
    first, second = (depths.fields.tangential_traction(r, step) for step in (0, 1))
    assert second == pytest.approx(3.0 * first, rel=1e-12, abs=0.0)


def test_an_accuracy_is_kept():
    scene = punch(layer(0.5), 2.0)
    path = Fem(accuracy=1e-5).solve(scene)
    assert path.error_estimate["normal_force"][0] <= 1e-5
    assert path.normal_force == pytest.approx(Mdr().solve(scene).normal_force, rel=1e-5, abs=0.0)


@pytest.mark.parametrize(
    ("scene", "named"),
    [
        (punch(layer(0.3), effects=(Friction(coefficient=0.3),)), r"FlatPunch .* Friction\.coefficient = 0\.3;"),
        (punch(layer(0.3), effects=(*STICK, Adhesion(work_of_adhesion=1.0))), r"Friction, Adhesion at .* = inf;"),
        (
            Scene(
                layer=layer(0.3),
                indenter=TruncatedCone(flat_radius=0.5, slope=0.1),
                loading=ContactRadii([1.0]),
                effects=STICK,
            ),
            r"a TruncatedCone under ContactRadii with Friction at",
        ),
        (
            punch(layer(0.3), loading=DepthHistory(time=[0.0, 1.0], depth=[0.0, 1e-3])),
            r"FlatPunch under DepthHistory with Friction",
        ),
    ],
)
def test_other_friction_is_refused_by_name(scene, named):
    with pytest.raises(UnsupportedSceneError, match=named):
        Fem().solve(scene)
    with pytest.raises(UnsupportedSceneError, match="it models full stick"):
        Fem().solve(scene)


def test_zero_friction_is_the_frictionless_solution():
    free, zero = (Fem(order=3).solve(punch(layer(0.3), effects=e)) for e in ((), (Friction(coefficient=0.0),)))
    assert free.normal_force[0] == zero.normal_force[0]

"""Finite elements on stacks and graded layers: published digits, limits, MDR on random stacks, lift-off as judge."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from contact import (
    Adhesion,
    ContactPath,
    ContactRadii,
    Detachment,
    ElasticBase,
    ExponentialDepth,
    FlatPunch,
    GradedLayer,
    Layer,
    NormalForces,
    Paraboloid,
    Scene,
)
from fem_reference import Fem
from mdr import Mdr
from tests.verification.lift_off import FORCE_AGREEMENT, judge, random_scene
from tests.verification.test_stacks import stack

PARABOLOID = Paraboloid(radius_of_curvature=1.0)
QUICK = Fem(growth=0.7, edge_cell=1e-6)
QUANTITIES = ("indentation_depth", "normal_force", "contact_stiffness")


def differences(ours: ContactPath, other: ContactPath) -> dict[str, tuple[float, float]]:
    """Relative difference and stated error of each number, the latter without rounding of the other method."""
    return {
        name: (
            float(abs(getattr(ours, name) / getattr(other, name) - 1)[0]),
            float(ours.error_estimate[name][0] + other.error_estimate[name][0]),
        )
        for name in QUANTITIES
        if ours.error_estimate[name][0]
    }


def base(modulus, nu, interface="bonded"):
    return ElasticBase(youngs_modulus=modulus, poissons_ratio=nu, interface=interface)


EXPONENTIAL = GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=4.0), poissons_ratio=0.3)
# Legendre-Galerkin in Fourier space, h_total = 1, R = 1, a = 1 (THEORY_STACKS, section 7; the last to 1e-9).
PUBLISHED = [
    (stack((0.5, 1.0, 0.3), (0.5, 10.0, 0.3)), 4.029072582822, 0.582871322414, 2.373099580873),
    (stack((0.5, 10.0, 0.3), (0.5, 1.0, 0.3)), 0.650379832415, 0.892382241985, 0.657189735505),
    (stack((1.0, 1.0, 0.3), support=base(0.1, 0.3)), 0.208798673980, 2.302830217806, 0.792316748517),
    (EXPONENTIAL, 4.236520213, 0.601148740, 2.612167263),
]


def assert_one_answer(path, other):
    """Two answers of finite elements agree within the errors that both state."""
    for name in QUANTITIES:
        stated = path.error_estimate[name] + other.error_estimate[name]
        assert np.all(np.abs(getattr(path, name) / getattr(other, name) - 1) <= stated), name


@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("layer", "plain"),
    [
        (
            stack((0.3, 2.0, 0.5), (0.7, 2.0, 0.5), support="unbonded"),
            Layer(thickness=1.0, youngs_modulus=2.0, poissons_ratio=0.5, support="unbonded"),
        ),
        (stack((1.0, 2.0, 0.2), support=base(2.0, 0.2)), Layer.half_space(youngs_modulus=2.0, poissons_ratio=0.2)),
    ],
    ids=["equal sublayers", "a layer on its own half-space"],
)
def test_equal_materials_are_one(layer, plain):
    one, other = (
        QUICK.solve(Scene(layer=each, indenter=PARABOLOID, loading=ContactRadii([0.8]))) for each in (layer, plain)
    )
    assert_one_answer(one, other)


CORNERS = {
    "sliding faces": stack(
        (0.3, 1.0, 0.5), (0.2, 10.0, 0.4), (0.5, 3.0, 0.5), interfaces=("unbonded", "bonded"), support="unbonded"
    ),
    "a sheet of great modulus": stack((0.1, 1e4, 0.3), (1.0, 1.0, 0.5)),
    "hardly any modulus at the top": stack((0.1, 1e-4, 0.5), (1.0, 1.0, 0.3), support=base(1e2, 0.0)),
    "sliding on the base": stack((0.3, 1.0, 0.5), support=base(3.0, 0.4, "unbonded")),
    "a thin top": stack((0.02, 1.0, 0.5), (0.98, 20.0, 0.3)),
    "a film on a soft half-space": stack((1.0, 1e4, 0.3), support=base(1.0, 0.3)),
    "ten sublayers": stack(*((0.1, float(E), 0.45) for E in (1, 5, 2, 8, 1, 9, 3, 4, 2, 6))),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", CORNERS)
@pytest.mark.parametrize("radius", [0.1, 1.0, 5.0])
def test_corners_agree_with_mdr_within_stated_errors(name, radius):
    problem = Scene(layer=CORNERS[name], indenter=PARABOLOID, loading=ContactRadii([radius]))
    for error, stated in differences(Fem().solve(problem), Mdr().solve(problem)).values():
        assert error < 2e-5
        assert error < stated


@pytest.mark.slow
@pytest.mark.parametrize("layer", [PUBLISHED[1][0], PUBLISHED[2][0], CORNERS["sliding faces"], EXPONENTIAL])
@pytest.mark.parametrize("indenter", [PARABOLOID, FlatPunch(radius=0.4)])
def test_pull_off_agrees_with_mdr_within_stated_errors(layer, indenter):
    problem = Scene(
        layer=layer,
        indenter=indenter,
        loading=Detachment(control="force"),
        effects=(Adhesion(work_of_adhesion=0.01),),
    )
    ours, other = QUICK.solve(problem), Mdr().solve(problem)
    for name in ("pull_off_force", "pull_off_depth", "pull_off_contact_radius"):
        error = abs(getattr(ours, name) / getattr(other, name) - 1)
        assert error <= ours.error_estimate[name] + 1e-12, name
    assert abs(ours.pull_off_force / other.pull_off_force - 1) < 1e-4


@pytest.mark.slow
@pytest.mark.parametrize("layer", [PUBLISHED[0][0], EXPONENTIAL, CORNERS["sliding on the base"]])
@pytest.mark.parametrize("accuracy", [1e-3, 1e-7])
def test_accuracy_holds_at_a_force(layer, accuracy):
    problem = Scene(layer=layer, indenter=PARABOLOID, loading=NormalForces([0.3]))
    ours, other = Fem(accuracy=accuracy).solve(problem), Mdr().solve(problem)
    for name in ("contact_radius", "indentation_depth", "contact_stiffness"):
        stated = ours.error_estimate[name][0]
        assert abs(getattr(ours, name) / getattr(other, name) - 1)[0] <= stated <= accuracy, name


@pytest.mark.slow
def test_mdr_answers_nowhere_where_the_contact_has_a_gap():
    rng = np.random.default_rng(180)
    verdicts = [judge(random_scene(rng)) for _ in range(40)]
    counts = Counter(verdict.kind for verdict in verdicts)
    assert counts["gap, answered"] == 0
    assert min(counts["gap, refused"], counts["disc, answered"]) >= 5
    assert max(verdict.difference for verdict in verdicts) < FORCE_AGREEMENT

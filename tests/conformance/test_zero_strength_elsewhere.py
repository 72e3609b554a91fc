"""Finite and boundary elements: zero strength equals absence, and other scenes in between change no bit."""

from __future__ import annotations

import pytest

from bem.direct_method import IntegralEquationMethod
from bem.method import Bem
from cases.declare.methods import build
from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    DepthHistory,
    Detachment,
    FlatPunch,
    ForceHistory,
    Impact,
    IndentationDepths,
    KelvinVoigt,
    Layer,
    Paraboloid,
    Scene,
)
from fem_reference import Fem
from tests.conformance.test_zero_strength import VISCOUS, ZERO, difference

LAYER = Layer.incompressible(thickness=1.0, shear_modulus=1.0)
COARSE = Fem(order=2, edge_cell=1e-3, growth=1.0, truncation=1e-4)
COARSE_TABLE = build("mdr_table", {"cells": 64, "ratios": 60, "radii": 100})
CONE, PARABOLOID = Cone(slope=0.1), Paraboloid(radius_of_curvature=5.0)
RADII = Scene(layer=LAYER, indenter=CONE, loading=ContactRadii([0.5, 1.0]))
IMPACT = Scene(layer=LAYER, indenter=PARABOLOID, loading=Impact(mass=0.1, velocity=0.05))
HISTORY = Scene(layer=LAYER, indenter=PARABOLOID, loading=DepthHistory(time=[0.0, 1.0, 2.0], depth=[0.0, 0.05, 0.0]))
CREEP = HISTORY.replace(loading=ForceHistory(time=[0.0, 1.0, 2.0], force=[0.0, 0.05, 0.02]))
PUNCH = Scene(layer=LAYER, indenter=FlatPunch(radius=1.0), loading=IndentationDepths([0.01]))
NUMBERS = ("coefficient_of_restitution", "contact_time", "peak_force", "peak_depth")


def test_finite_elements_without_work_of_adhesion_are_finite_elements_without_adhesion():
    with_zero = COARSE.solve(RADII.replace(effects=(Adhesion(work_of_adhesion=0.0),)))
    assert difference(with_zero, COARSE.solve(RADII), ("contact_radius", "indentation_depth", "normal_force")) < ZERO


@pytest.mark.parametrize("scene", [RADII, RADII.replace(loading=IndentationDepths([0.05]))], ids=["radii", "depths"])
def test_boundary_elements_without_work_of_adhesion_are_boundary_elements_without_adhesion(scene):
    """Adhesion has a solver of its own there (discs under the grid's pressure); without work it is not asked."""
    with_zero = Bem(points=96).solve(scene.replace(effects=(Adhesion(work_of_adhesion=0.0),)))
    bare = Bem(points=96).solve(scene)
    assert difference(with_zero, bare, ("contact_radius", "indentation_depth", "normal_force")) < ZERO


def test_tables_without_work_of_adhesion_are_tables_without_adhesion():
    scene = RADII.replace(indenter=PARABOLOID)
    with_zero = COARSE_TABLE.solve(scene.replace(effects=(Adhesion(work_of_adhesion=0.0),)))
    assert (
        difference(with_zero, COARSE_TABLE.solve(scene), ("contact_radius", "indentation_depth", "normal_force")) < ZERO
    )


@pytest.mark.first(1)
@pytest.mark.parametrize("name", VISCOUS)
def test_finite_elements_without_viscosity_are_an_elastic_impact(name):
    with_zero, elastic = COARSE.solve(IMPACT.replace(effects=(VISCOUS[name],))), COARSE.solve(IMPACT)
    assert difference(with_zero, elastic, NUMBERS) < ZERO


@pytest.mark.first(1)
@pytest.mark.parametrize("name", VISCOUS)
@pytest.mark.parametrize("history", [HISTORY, CREEP], ids=["depth", "force"])
def test_finite_elements_without_viscosity_follow_an_elastic_history(history, name):
    with_zero, elastic = COARSE.solve(history.replace(effects=(VISCOUS[name],))), COARSE.solve(history)
    assert difference(with_zero, elastic, ("normal_force", "indentation_depth")) < ZERO


@pytest.mark.first(1)
@pytest.mark.parametrize(
    "method", [COARSE, Bem(points=96), IntegralEquationMethod(), COARSE_TABLE], ids=["fem", "bem", "direct", "table"]
)
def test_solving_other_scenes_between_changes_no_bit(method):
    """No state is left behind: not by an effect, not by another layer."""
    before = method.solve(PUNCH)
    adhesive = RADII.replace(
        loading=Detachment(control="force", initial_contact_radius=1.0), effects=(Adhesion(work_of_adhesion=1e-3),)
    )
    for scene in (RADII.replace(layer=Layer(thickness=0.5, youngs_modulus=2.0, poissons_ratio=0.3)), adhesive, IMPACT):
        if method.supports(scene) and method is not COARSE:
            method.solve(scene)
    after = method.solve(PUNCH)
    for name in before.ARRAYS:
        assert getattr(before, name).tobytes() == getattr(after, name).tobytes()


def test_effects_of_finite_elements_in_between_change_no_bit():
    before = COARSE.solve(PUNCH)
    COARSE.solve(RADII.replace(effects=(Adhesion(work_of_adhesion=1e-4),)))
    COARSE.solve(HISTORY.replace(effects=(KelvinVoigt(shear_modulus=1.0, viscosity=1e-2),)))
    after = COARSE.solve(PUNCH)
    for name in before.ARRAYS:
        assert getattr(before, name).tobytes() == getattr(after, name).tobytes()


def test_a_little_adhesion_is_seen_by_boundary_elements():
    bare = Bem(points=96).solve(RADII)
    little = Bem(points=96).solve(RADII.replace(effects=(Adhesion(work_of_adhesion=1e-6),)))
    assert difference(little, bare, ("normal_force",)) > ZERO


@pytest.mark.parametrize(
    ("method", "scene"),
    [(Bem(points=96), IMPACT), (IntegralEquationMethod(), IMPACT), (IntegralEquationMethod(), RADII.replace(
        effects=(Adhesion(work_of_adhesion=1e-3),)))],
    ids=["bem, impact", "integral equation, impact", "integral equation, adhesion"],
)  # fmt: skip
def test_an_effect_that_a_method_does_not_model_is_refused_not_ignored(method, scene):
    assert not method.supports(scene)


def test_a_little_viscosity_is_seen():
    little = COARSE.solve(IMPACT.replace(effects=(KelvinVoigt(shear_modulus=1.0, viscosity=1e-6),)))
    assert difference(little, COARSE.solve(IMPACT), ("coefficient_of_restitution",)) > ZERO

"""An effect of zero strength equals its absence to 1e-12, a little is seen, and no scene leaves a state behind."""

from __future__ import annotations

import numpy as np
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
    NormalForces,
    Paraboloid,
    PronySeries,
    Scene,
)
from fem_reference import Fem
from mdr import Mdr

LAYER = Layer.incompressible(thickness=1.0, shear_modulus=1.0)
HALF_SPACE = Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5)
CONE, PARABOLOID, PUNCH = Cone(slope=0.1), Paraboloid(radius_of_curvature=5.0), FlatPunch(radius=1.0)
RADII, DEPTHS = ContactRadii([0.5, 1.0]), IndentationDepths([0.02, 0.05])
IMPACT = Impact(mass=0.1, velocity=0.05)
TIME = [0.0, 1.0, 2.0]
HISTORIES = DepthHistory(time=TIME, depth=[0.0, 0.05, 0.02]), ForceHistory(time=TIME, force=[0.0, 0.05, 0.02])
MDR, BEM, DIRECT = Mdr(), Bem(points=96), IntegralEquationMethod()
FEM = Fem(order=2, edge_cell=1e-3, growth=1.0, truncation=1e-4)
TABLE = build("mdr_table", {"cells": 64, "ratios": 60, "radii": 100})
ZERO = 1e-12  # relative: what "equals absence" means

VISCOUS = {
    "no viscosity": KelvinVoigt(shear_modulus=1.0, viscosity=0.0),
    "a branch without modulus": PronySeries(long_term_shear_modulus=1.0, shear_moduli=[0.0], relaxation_times=[1.0]),
}
NUMBERS = ("coefficient_of_restitution", "contact_time", "peak_force", "peak_depth")
STATE = ("contact_radius", "indentation_depth", "normal_force")


def scene(indenter, loading, layer=LAYER, effects=()):
    return Scene(layer=layer, indenter=indenter, loading=loading, effects=effects)


def named(part):
    """A method by its name, a scene by its indenter and loading."""
    return f"{type(part.indenter).__name__}-{type(part.loading).__name__}" if isinstance(part, Scene) else part.name


def difference(one, other, names):
    return max(
        float(np.max(np.abs(np.asarray(getattr(one, q)) - getattr(other, q))) / np.max(np.abs(getattr(other, q))))
        for q in names
    )


ADHESIVE = [
    scene(indenter, loading, layer)
    for layer in (LAYER, HALF_SPACE)
    for indenter in (PARABOLOID, CONE)
    for loading in (RADII, DEPTHS, NormalForces([0.02, 0.05]))
]


# Boundary elements have a solver of their own for adhesion (discs under the grid's pressure).
@pytest.mark.parametrize(
    ("method", "still"),
    [
        *((MDR, one) for one in ADHESIVE),
        *((method, scene(PARABOLOID, RADII)) for method in (FEM, BEM, TABLE)),
        (BEM, scene(CONE, DEPTHS)),
    ],
    ids=named,
)
def test_no_work_of_adhesion_is_no_adhesion(method, still):
    with_zero = method.solve(still.replace(effects=(Adhesion(work_of_adhesion=0.0),)))
    assert difference(with_zero, method.solve(still), STATE) < ZERO


MOVING = [scene(indenter, loading) for indenter in (PARABOLOID, CONE, PUNCH) for loading in (IMPACT, *HISTORIES)]
COSTLY = [
    pytest.param(FEM, one, name, marks=pytest.mark.slow if one is MOVING[2] or name != "no viscosity" else ())
    for one in MOVING[:3]
    for name in VISCOUS
]


@pytest.mark.parametrize(
    ("method", "moving", "name"), [*((MDR, one, name) for one in MOVING for name in VISCOUS), *COSTLY]
)
def test_no_viscosity_is_an_elastic_motion(method, moving, name):
    with_zero, elastic = method.solve(moving.replace(effects=(VISCOUS[name],))), method.solve(moving)
    if moving.loading is not IMPACT:
        assert difference(with_zero, elastic, ("normal_force", "indentation_depth")) < ZERO
        return
    assert difference(with_zero, elastic, NUMBERS) < ZERO
    assert method is FEM or np.abs(with_zero.dissipated_energy).max() <= ZERO * with_zero.kinetic_energy[0]


IN_BETWEEN = (
    scene(CONE, RADII, Layer(thickness=0.5, youngs_modulus=2.0, poissons_ratio=0.3)),
    scene(CONE, RADII, effects=(Adhesion(work_of_adhesion=1e-3),)),
    scene(
        CONE,
        Detachment(control="force", initial_contact_radius=1.0),
        effects=(Adhesion(work_of_adhesion=1e-3),),
    ),
    *(
        scene(PARABOLOID, loading, effects=(KelvinVoigt(shear_modulus=1.0, viscosity=1e-2),))
        for loading in (IMPACT, HISTORIES[0])
    ),
)


@pytest.mark.parametrize(
    ("method", "still"),
    [
        *((MDR, one) for one in ADHESIVE[:6]),
        (FEM, scene(PUNCH, IndentationDepths([0.01]))),
        *(
            pytest.param(method, scene(PUNCH, IndentationDepths([0.01])), marks=pytest.mark.slow)
            for method in (BEM, DIRECT, TABLE)
        ),
    ],
    ids=named,
)
def test_solving_other_scenes_between_changes_no_bit(method, still):
    """No state is left behind: not by an effect, not by another layer."""
    before = method.solve(still)
    for other in IN_BETWEEN:
        # Detachments and impacts of finite elements take seconds; adhesion and histories load what they would.
        costly = method is FEM and isinstance(other.loading, Detachment | Impact)
        if method.supports(other) and not costly:
            method.solve(other)
    after = method.solve(still)
    for name in before.ARRAYS:
        assert getattr(before, name).tobytes() == getattr(after, name).tobytes()


@pytest.mark.parametrize(
    ("method", "bare", "little", "quantity"),
    [
        (MDR, ADHESIVE[0], Adhesion(work_of_adhesion=1e-10), "normal_force"),
        (BEM, scene(CONE, RADII), Adhesion(work_of_adhesion=1e-6), "normal_force"),
        (FEM, MOVING[0], KelvinVoigt(shear_modulus=1.0, viscosity=1e-6), "coefficient_of_restitution"),
    ],
    ids=["mdr", "bem", "fem"],
)
def test_a_little_of_an_effect_is_seen(method, bare, little, quantity):
    assert difference(method.solve(bare.replace(effects=(little,))), method.solve(bare), (quantity,)) > ZERO


@pytest.mark.parametrize(
    ("method", "other"),
    [
        (BEM, MOVING[0]),
        (DIRECT, MOVING[0]),
        (DIRECT, scene(CONE, RADII, effects=(Adhesion(work_of_adhesion=1e-3),))),
    ],
    ids=["bem, impact", "integral equation, impact", "integral equation, adhesion"],
)
def test_an_effect_that_a_method_does_not_model_is_refused_not_ignored(method, other):
    assert not method.supports(other)

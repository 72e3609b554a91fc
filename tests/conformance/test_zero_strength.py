"""An effect of zero strength equals its absence to 1e-12, and listing nothing is bit-identical run after run."""

from __future__ import annotations

import numpy as np
import pytest

from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    DepthHistory,
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
from mdr import Mdr

LAYER = Layer.incompressible(thickness=1.0, shear_modulus=1.0)
HALF_SPACE = Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5)
INDENTERS = [Paraboloid(radius_of_curvature=5.0), Cone(slope=0.1)]
ZERO = 1e-12  # relative: what "equals absence" means

ADHESIVE = [
    Scene(layer=layer, indenter=indenter, loading=loading)
    for layer in (LAYER, HALF_SPACE)
    for indenter in INDENTERS
    for loading in (ContactRadii([0.5, 1.0]), IndentationDepths([0.02, 0.05]), NormalForces([0.02, 0.05]))
]


def difference(one, other, names):
    return max(
        float(np.max(np.abs(np.asarray(getattr(one, q)) - getattr(other, q))) / np.max(np.abs(getattr(other, q))))
        for q in names
    )


@pytest.mark.parametrize("scene", ADHESIVE, ids=lambda s: f"{type(s.indenter).__name__}-{type(s.loading).__name__}")
def test_no_work_of_adhesion_is_no_adhesion(scene):
    with_zero = Mdr().solve(scene.replace(effects=(Adhesion(work_of_adhesion=0.0),)))
    assert difference(with_zero, Mdr().solve(scene), ("contact_radius", "indentation_depth", "normal_force")) < ZERO


VISCOUS = {
    "no viscosity": KelvinVoigt(shear_modulus=1.0, viscosity=0.0),
    "a branch without modulus": PronySeries(long_term_shear_modulus=1.0, shear_moduli=[0.0], relaxation_times=[1.0]),
}
NUMBERS = ("coefficient_of_restitution", "contact_time", "peak_force", "peak_depth", "peak_contact_radius")


@pytest.mark.parametrize("name", VISCOUS)
@pytest.mark.parametrize("indenter", [*INDENTERS, FlatPunch(radius=1.0)], ids=lambda i: type(i).__name__)
def test_no_viscosity_is_an_elastic_impact(name, indenter):
    scene = Scene(layer=LAYER, indenter=indenter, loading=Impact(mass=0.1, velocity=0.05))
    with_zero, elastic = Mdr().solve(scene.replace(effects=(VISCOUS[name],))), Mdr().solve(scene)
    assert difference(with_zero, elastic, NUMBERS) < ZERO
    assert float(np.max(np.abs(with_zero.dissipated_energy))) <= ZERO * with_zero.kinetic_energy[0]


@pytest.mark.parametrize("name", VISCOUS)
@pytest.mark.parametrize("indenter", [*INDENTERS, FlatPunch(radius=1.0)], ids=lambda i: type(i).__name__)
@pytest.mark.parametrize("kind", ["depth", "force"])
def test_no_viscosity_is_an_elastic_history(name, indenter, kind):
    time = [0.0, 1.0, 2.0]
    loading = (
        DepthHistory(time=time, depth=[0.0, 0.05, 0.02])
        if kind == "depth"
        else ForceHistory(time=time, force=[0.0, 0.05, 0.02])
    )
    scene = Scene(layer=LAYER, indenter=indenter, loading=loading)
    with_zero, elastic = Mdr().solve(scene.replace(effects=(VISCOUS[name],))), Mdr().solve(scene)
    assert difference(with_zero, elastic, ("normal_force", "indentation_depth", "contact_radius")) < ZERO


@pytest.mark.parametrize("scene", ADHESIVE[:6], ids=lambda s: f"{type(s.indenter).__name__}-{type(s.loading).__name__}")
def test_solving_other_scenes_between_changes_no_bit(scene):
    before = Mdr().solve(scene)
    Mdr().solve(scene.replace(effects=(Adhesion(work_of_adhesion=1e-3),)))
    Mdr().solve(Scene(layer=LAYER, indenter=INDENTERS[0], loading=Impact(mass=0.1, velocity=0.05)))
    for loading in (DepthHistory(time=[0.0, 1.0], depth=[0.0, 0.05]), Impact(mass=0.1, velocity=0.05)):
        viscous = KelvinVoigt(shear_modulus=1.0, viscosity=1e-2)
        Mdr().solve(Scene(layer=LAYER, indenter=INDENTERS[0], loading=loading, effects=(viscous,)))
    after = Mdr().solve(scene)
    for name in before.ARRAYS:
        assert getattr(before, name).tobytes() == getattr(after, name).tobytes()


def test_a_little_adhesion_is_seen():
    scene = ADHESIVE[0]
    little = Mdr().solve(scene.replace(effects=(Adhesion(work_of_adhesion=1e-10),)))
    assert difference(little, Mdr().solve(scene), ("normal_force",)) > ZERO

"""Compiled impacts are NumPy's but for roundings, in batches the same bits as alone, and asked for by name."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from cases.declare.quantities import IMPACT_NUMBERS
from contact import (
    Cone,
    ContactRadii,
    FlatPunch,
    Impact,
    InvalidInput,
    KelvinVoigt,
    Layer,
    LayerStack,
    Paraboloid,
    PronySeries,
    Scene,
    Sphere,
    StandardSolid,
    Sublayer,
    TruncatedCone,
)
from mdr import Mdr
from mdr.batches import impacts
from mdr.impact.compiled import choice, integrate, walk
from tests.drawn_scenes import random_scenes

PUNCH = IntegralEquation()
LAYER = Layer.incompressible(thickness=1e-3, shear_modulus=1e6)
SUBLAYERS = (
    Sublayer(thickness=2e-4, youngs_modulus=3e6, poissons_ratio=0.4),
    Sublayer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.3),
)
STACK = LayerStack(sublayers=SUBLAYERS, interfaces=("bonded",))
SOLID = StandardSolid(long_term_shear_modulus=2e5, maxwell_shear_modulus=8e5, viscosity=8e2)
DASHPOT = KelvinVoigt(shear_modulus=1e6, viscosity=1e2)
SERIES = PronySeries(long_term_shear_modulus=1e5, shear_moduli=[5e5, 4e5], relaxation_times=[1e-2, 2e-3])
BALL, STUMP = Paraboloid(radius_of_curvature=5e-3), TruncatedCone(flat_radius=2e-4, slope=0.1)
KINDS = {
    "elastic": (LAYER, BALL, ()),
    "stack": (STACK, Cone(slope=0.1), ()),
    "standard solid": (LAYER, Sphere(radius=5e-3), (SOLID,)),
    "Kelvin-Voigt": (LAYER, STUMP, (DASHPOT,)),
    "Prony": (LAYER, BALL, (SERIES,)),
    "flat punch": (LAYER, FlatPunch(radius=1e-3), (SERIES,)),
    "stiff": (LAYER, BALL, (SOLID.replace(viscosity=8e-3),)),
}
needs_numba = pytest.mark.skipif(
    importlib.util.find_spec("numba") is None, reason="numba, of the extra fast, is not installed"
)


def blow(kind, loading=None):
    layer, indenter, effects = KINDS[kind]
    return Scene(layer=layer, indenter=indenter, loading=loading or Impact(mass=0.02, velocity=0.1), effects=effects)


def numbers(found, n=0):
    return np.array([getattr(found, name)[n] for name in IMPACT_NUMBERS])


def nudged(scene, roundings):
    mass = scene.loading.mass * (1.0 + roundings * np.finfo(float).eps)
    return scene.replace(loading=scene.loading.replace(mass=mass))


def own_scatter(scene, accuracy, value):
    """What a rounding in the mass does to NumPy's numbers: a difference of roundings is no larger."""
    others = impacts([nudged(scene, n) for n in (-2, -1, 1, 2)], PUNCH, accuracy=accuracy)
    return np.max([np.abs(numbers(others, n) / value - 1.0) for n in range(4)], axis=0)


def beyond_roundings(scene, accuracy):
    """Differences between both ways over ten times what roundings in the mass do, and over the stated error."""
    by_numpy = impacts([scene], PUNCH, accuracy=accuracy)
    compiled = impacts([scene], PUNCH, accuracy=accuracy, compiled=True)
    value = numbers(by_numpy)
    moved = np.abs(numbers(compiled) / value - 1.0)
    stated = by_numpy.relative_error[:, 0] + compiled.relative_error[:, 0]
    return (moved / (10.0 * own_scatter(scene, accuracy, value) + 1e-13)).max(), (moved / stated).max()


@pytest.fixture
def plain(monkeypatch):
    """The same loops without a compiler, wherever numba is."""
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    spec = importlib.util.spec_from_file_location("plain_walk", walk.__file__)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setattr(walk, "walked", module.walked)
    monkeypatch.setattr(choice, "find_spec", lambda name: "numba")


# Stiff stretches take long without a compiler.
@pytest.mark.parametrize("kind", sorted(KINDS.keys() - {"stiff"}))
def test_plain_loops_are_numpys_motion(kind, plain):
    roundings, stated = beyond_roundings(blow(kind), 1e-6)
    assert roundings <= 1.0
    assert stated <= 1.0


def test_a_walk_begins_again_with_more_room(plain, monkeypatch):
    scene = blow("standard solid")
    wide = impacts([scene], PUNCH, accuracy=1e-4, compiled=True)
    monkeypatch.setattr(integrate, "_ROOM", 1)
    narrow = impacts([scene], PUNCH, accuracy=1e-4, compiled=True)
    assert numbers(wide).tolist() == numbers(narrow).tolist()


def test_lanes_that_the_walk_leaves_are_numpys(plain, monkeypatch):
    walked, scene = walk.walked, blow("Kelvin-Voigt")
    expected = numbers(impacts([scene], PUNCH, accuracy=1e-6, compiled=True))

    def without_the_first(task):
        walked(task)
        task.ended[0] = walk.LEFT

    monkeypatch.setattr(walk, "walked", without_the_first)
    assert numbers(impacts([scene], PUNCH, accuracy=1e-6, compiled=True)).tolist() != expected.tolist()
    assert numbers(impacts([scene], PUNCH, accuracy=1e-6, compiled=True)) == pytest.approx(expected, rel=1e-11, abs=0.0)


@needs_numba
@pytest.mark.slow
def test_compiled_impacts_are_numpys_on_two_hundred_random_scenes():
    """A motion is as sensitive to a rounding in its mass as to roundings on the way: that is the measure."""
    found = [beyond_roundings(scene, 1e-9) for scene in random_scenes(2201, 200, "impact", (1e-2, 20.0))]
    assert np.max(found) <= 1.0


@needs_numba
@pytest.mark.slow
def test_compiled_batches_are_the_same_bits_as_alone():
    masses = 0.02 * 1.1 ** np.arange(3)
    scenes = [blow(kind, Impact(mass=float(mass), velocity=0.1)) for mass in masses for kind in KINDS]
    together, alone = impacts(scenes, PUNCH, compiled=True), Mdr(flat_punch=PUNCH, compiled=True)
    for n, scene in enumerate(scenes):
        single = alone.solve(scene)
        assert numbers(together, n).tolist() == [getattr(single, name) for name in IMPACT_NUMBERS], n


def test_the_record_says_what_was_compiled(plain):
    method = Mdr(flat_punch=PUNCH, accuracy=1e-4, compiled=True)
    assert method.solve(blow("flat punch")).settings["compiled"] is True
    assert "compiled" not in Mdr(flat_punch=PUNCH, accuracy=1e-4).solve(blow("flat punch")).settings
    assert "compiled" not in method.solve(Scene(layer=LAYER, indenter=BALL, loading=ContactRadii([1e-3]))).settings


def test_compiled_loops_without_numba_are_refused_by_name(monkeypatch):
    monkeypatch.setattr(choice, "find_spec", lambda name: None)
    with pytest.raises(InvalidInput, match=r"contact-verification\[fast\]"):
        Mdr(flat_punch=PUNCH, compiled=True).solve(blow("elastic"))
    with pytest.raises(InvalidInput, match="numba"):
        impacts([blow("elastic")], PUNCH, compiled=True)

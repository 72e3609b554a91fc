"""Finite elements write profiles and relaxation down themselves: the same numbers, from other lines of code."""

import numpy as np
import pytest

from contact import (
    Cone,
    ContactRadii,
    DepthFunction,
    ExponentialDepth,
    FlatPunch,
    GradedLayer,
    Impact,
    IndentationDepths,
    KelvinVoigt,
    Layer,
    LinearDepth,
    Paraboloid,
    PowerLaw,
    PowerLawDepth,
    PronySeries,
    Scene,
    Sphere,
    Spheroconical,
    StandardSolid,
    Tabulated,
    TabulatedDepth,
    TruncatedCone,
    TruncatedParaboloid,
    UnsupportedSceneError,
)
from contact.scene.effects import EFFECTS, Viscoelasticity
from contact.scene.graded_layer import DEPTH_FUNCTIONS
from contact.scene.profiles import PROFILES
from fem_reference import Fem
from fem_reference.materials import at_depths, relaxation_of
from fem_reference.profiles import shape

RADII = np.linspace(0.0, 3.0, 241)
RANDOM = np.random.default_rng(20261122)
STEPS = np.concatenate([[0.0], np.cumsum(RANDOM.uniform(0.01, 0.3, 40))])
# Rising, falling and level stretches: each branch of the formula for slopes.
ROUGH = Tabulated(radii=STEPS, heights=np.concatenate([[0.0], np.round(np.cumsum(RANDOM.normal(0.1, 0.2, 40)), 1)]))
EXAMPLES = (
    FlatPunch(radius=2.0),
    Paraboloid(radius_of_curvature=7.0),
    Sphere(radius=2.9),
    Cone(slope=0.3),
    Spheroconical(radius=2.0, slope=1.2),
    TruncatedCone(flat_radius=0.7, slope=0.3),
    TruncatedParaboloid(flat_radius=0.7, radius_of_curvature=7.0),
    PowerLaw(exponent=2.7, reference_radius=1.3, reference_height=0.2),
    ROUGH,
    Tabulated(radii=[0.0, 1.0, 1.1], heights=[0.0, 0.1, 1.0]),
    Tabulated(radii=[0.0, 1.0, 3.0], heights=[0.0, 1.0, 0.9]),
)


@pytest.mark.parametrize("profile", EXAMPLES, ids=lambda p: type(p).__name__)
def test_heights_and_slopes_are_those_that_other_methods_use(profile):
    own, inside = shape(profile, RADII), np.minimum(RADII, profile.max_radius)
    np.testing.assert_allclose(own.height, profile.height(RADII), rtol=1e-13, atol=1e-14)
    np.testing.assert_allclose(own.slope, profile.slope_at(RADII), rtol=1e-12, atol=1e-13)
    assert np.all(np.isfinite(shape(profile, 0.999 * inside).height))


def test_every_profile_and_every_relaxation_is_written_down():
    assert {type(profile) for profile in EXAMPLES} == set(PROFILES)
    assert {type(effect) for effect in RELAXING} == {e for e in EFFECTS if issubclass(e, Viscoelasticity)}


RELAXING = (
    KelvinVoigt(shear_modulus=1.0, viscosity=0.3),
    StandardSolid(long_term_shear_modulus=0.5, maxwell_shear_modulus=0.5, viscosity=0.2),
    PronySeries(long_term_shear_modulus=0.5, shear_moduli=[0.3, 0.2], relaxation_times=[0.1, 2.0]),
)


@pytest.mark.parametrize("effect", RELAXING, ids=lambda e: type(e).__name__)
def test_relaxation_is_that_which_other_methods_use(effect):
    layer = Layer.incompressible(thickness=1.0, shear_modulus=1.0)
    scene = Scene(
        layer=layer, indenter=FlatPunch(radius=1.0), loading=Impact(mass=1.0, velocity=1.0), effects=(effect,)
    )
    own, other = relaxation_of(scene), effect.relaxation
    assert own.long_term_modulus == other.long_term_modulus
    assert own.viscosity == other.viscosity
    np.testing.assert_array_equal(own.moduli, other.moduli)
    np.testing.assert_array_equal(own.times, other.times)
    assert own.instantaneous_modulus == other.instantaneous_modulus


GRADINGS = (
    ExponentialDepth(surface=2.0, base=7.0),
    LinearDepth(surface=2.0, base=0.5),
    PowerLawDepth(surface=2.0, reference_depth=0.4, exponent=-1.7),
    TabulatedDepth(depths=STEPS, values=1.0 + ROUGH.heights - ROUGH.heights.min()),
    TabulatedDepth(depths=[0.0, 1.5], values=[1.0, 3.0]),
)


@pytest.mark.parametrize("function", GRADINGS, ids=lambda f: type(f).__name__)
def test_moduli_over_depth_are_those_that_other_methods_use(function):
    depth = np.linspace(0.0, 1.5, 301)
    np.testing.assert_allclose(at_depths(function, depth, 1.5), function.at(depth, 1.5), rtol=1e-13, atol=0.0)


def test_every_function_of_depth_is_written_down():
    assert {type(function) for function in GRADINGS} == set(DEPTH_FUNCTIONS)
    with pytest.raises(UnsupportedSceneError, match="finite elements have no formula for DepthFunction"):
        at_depths(DepthFunction(), np.zeros(1), 1.0)


def test_functions_of_depth_reach_no_answer(monkeypatch):
    graded = GradedLayer(thickness=1.0, youngs_modulus=GRADINGS[0], poissons_ratio=0.3)
    scene = Scene(layer=graded, indenter=Paraboloid(radius_of_curvature=5.0), loading=ContactRadii([0.5]))
    before = COARSE.solve(scene)
    right = ExponentialDepth.at
    monkeypatch.setattr(ExponentialDepth, "at", lambda self, depth, thickness: 1.01 * right(self, depth, thickness))
    after = COARSE.solve(scene)
    np.testing.assert_allclose(after.normal_force, before.normal_force, rtol=1e-10, atol=0.0)
    np.testing.assert_allclose(after.indentation_depth, before.indentation_depth, rtol=1e-10, atol=0.0)


LAYER = Layer(thickness=1.0, youngs_modulus=3.0, poissons_ratio=0.5)
COARSE = Fem(accuracy=1e-2)
KNOTS = np.linspace(0.0, 1.0, 9)
SHAPES = (
    Paraboloid(radius_of_curvature=5.0),
    TruncatedCone(flat_radius=0.3, slope=0.1),
    Tabulated(radii=KNOTS, heights=KNOTS**2 / 10),
)


@pytest.mark.first(1)
@pytest.mark.parametrize("indenter", SHAPES, ids=lambda p: type(p).__name__)
@pytest.mark.parametrize("loading", [ContactRadii([0.5]), IndentationDepths([0.05])], ids=lambda x: type(x).__name__)
def test_heights_and_slopes_of_the_scene_reach_no_answer(indenter, loading, monkeypatch):
    scene = Scene(layer=LAYER, indenter=indenter, loading=loading)
    before = COARSE.solve(scene)
    for name in ("height", "slope_at"):
        right = getattr(type(indenter), name)
        monkeypatch.setattr(type(indenter), name, lambda self, radius, right=right: 1.01 * right(self, radius))
    after = COARSE.solve(scene)
    assert (after.normal_force[0], after.contact_radius[0]) == (before.normal_force[0], before.contact_radius[0])


def asked(_):
    raise AssertionError("finite elements asked the effect for its relaxation")


def test_the_relaxation_of_the_effect_reaches_no_answer(monkeypatch):
    loading = Impact(mass=1.0, velocity=0.05)
    hit = Scene(layer=LAYER, indenter=SHAPES[0], loading=loading, effects=(RELAXING[1],))
    monkeypatch.setattr(StandardSolid, "relaxation", property(asked))
    assert 0 < Fem(order=2, growth=0.9).solve(hit).coefficient_of_restitution < 1

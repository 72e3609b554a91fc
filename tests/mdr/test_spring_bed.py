"""The equivalent bed of springs: radius, depth and force belong together, whatever is prescribed."""

from itertools import product

import numpy as np
import pytest

from bem.numerics import EPS
from contact import (
    Cone,
    ContactError,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    NormalForces,
    Paraboloid,
    PowerLaw,
    Scene,
    Sphere,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
    UnsupportedSceneError,
)
from mdr import Mdr
from tests.bed import bed_of
from tests.random_scenes import INDENTERS as EVERY_INDENTER
from tests.random_scenes import drawn_scene

LAYER = Layer(thickness=2e-3, youngs_modulus=1e6, poissons_ratio=0.5)
UNBONDED = Layer(thickness=2e-3, youngs_modulus=1e6, poissons_ratio=0.4, support="unbonded")
HALF_SPACE = Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.3)
LAYERS = [LAYER, UNBONDED, HALF_SPACE]
INDENTERS = [
    Paraboloid(radius_of_curvature=0.1),
    Sphere(radius=0.1),
    Cone(slope=0.1),
    TruncatedCone(flat_radius=1e-3, slope=0.1),
    TruncatedParaboloid(flat_radius=2.7e-3, radius_of_curvature=0.1),
    PowerLaw(exponent=1.7, reference_radius=1e-3, reference_height=1e-4),
    Tabulated(radii=np.linspace(0, 8e-3, 9), heights=5 * np.linspace(0, 8e-3, 9) ** 2),
]


def solved(layer, indenter, loading):
    return Mdr().solve(Scene(layer=layer, indenter=indenter, loading=loading))


@pytest.mark.parametrize("layer", LAYERS, ids=["bonded", "unbonded", "half-space"])
@pytest.mark.parametrize("indenter", INDENTERS, ids=lambda i: type(i).__name__)
def test_radius_depth_and_force_invert_each_other(layer, indenter):
    path = solved(layer, indenter, ContactRadii(np.linspace(indenter.flat_radius, 7e-3, 23)[1:]))
    for loading in IndentationDepths(path.indentation_depth), NormalForces(path.normal_force):
        np.testing.assert_allclose(solved(layer, indenter, loading).contact_radius, path.contact_radius, rtol=2e-13)
        alone = solved(layer, indenter, type(loading)(loading.values[[7]]))
        np.testing.assert_allclose(alone.contact_radius, path.contact_radius[7], rtol=2e-13)


@pytest.mark.parametrize("loading", ["IndentationDepths", "NormalForces"])
@pytest.mark.parametrize("layer", ["half-space", "bonded layer", "unbonded layer"])
def test_radii_of_random_loads_give_the_loads_again(layer, loading):
    """Loads of blunt tips with steep flanks were off by a factor of two: slopes of secants change many times over."""
    quantity = {"IndentationDepths": "indentation_depth", "NormalForces": "normal_force"}[loading]
    compared = 0
    for seed, kind in product((2, 3), sorted(set(EVERY_INDENTER) - {"FlatPunch"})):
        draw = np.random.default_rng([seed, *kind.encode()])
        scene = drawn_scene(draw, layer=layer, indenter=kind, loading=loading, effect="no effect")
        try:
            path = Mdr().solve(scene)
        except ContactError:  # too deep, several contacts
            continue
        flat = scene.indenter.flat_radius
        radius, at = np.unique(path.contact_radius, return_index=True)
        at, radius = at[radius > flat * (1 + 1e-12)], radius[radius > flat * (1 + 1e-12)]
        if radius.size:
            again = Mdr().solve(scene.replace(loading=ContactRadii(radius)))
            off = np.abs(getattr(again, quantity) / getattr(path, quantity)[at] - 1)
            assert (off < 1e-12 + 8 * EPS / (1 - flat / radius)).all(), scene
            compared += 1
    assert compared >= 10


@pytest.mark.parametrize("layer", LAYERS, ids=["bonded", "unbonded", "half-space"])
@pytest.mark.parametrize("indenter", INDENTERS, ids=lambda i: type(i).__name__)
def test_contact_stiffness_is_the_derivative_of_force_by_depth(layer, indenter):
    """dF/d(delta) = k_N along the path, Eq. (5)."""
    bed, a, step = bed_of(layer, indenter), 5.3e-3, 1e-6
    force, depth = (f(np.array([a - step, a + step])) for f in (bed.elastic_force, bed.mdr_profile))
    assert np.diff(force) / np.diff(depth) == pytest.approx(float(bed.contact_stiffness(a)), rel=1e-6, abs=0.0)


@pytest.mark.parametrize("indenter", INDENTERS, ids=lambda i: type(i).__name__)
def test_a_thick_layer_is_a_half_space_to_first_order_in_the_ratio(indenter):
    """delta = g_hs (1 + O(a/h)): the difference shrinks with the thickness."""
    a = 7e-3
    exact = bed_of(HALF_SPACE, indenter).mdr_profile(a)
    thick = [LAYER.replace(thickness=h) for h in (1e3 * a, 1e4 * a)]
    errors = [abs(bed_of(layer, indenter).mdr_profile(a) / exact - 1) for layer in thick]
    assert errors[0] / errors[1] == pytest.approx(10, rel=0.01, abs=0.0)
    assert errors[1] < 2e-4


def test_the_flat_punch_has_no_profile():
    bed = bed_of(LAYER, FlatPunch(radius=4e-3))
    assert bed.mdr_profile(4e-3) == 0.0
    assert bed.force(4e-3, 1e-4) == pytest.approx(float(bed.contact_stiffness(4e-3)) * 1e-4, rel=1e-12, abs=0.0)


def test_units_do_not_matter():
    millimetres = Layer(thickness=2.0, youngs_modulus=1.0, poissons_ratio=0.5)  # mm, MPa: forces in N
    a = bed_of(LAYER, TruncatedCone(flat_radius=1e-3, slope=0.1))
    b = bed_of(millimetres, TruncatedCone(flat_radius=1.0, slope=0.1))
    assert a.mdr_profile(5e-3) == pytest.approx(1e-3 * float(b.mdr_profile(5.0)), rel=1e-13, abs=0.0)
    assert a.elastic_force(5e-3) == pytest.approx(float(b.elastic_force(5.0)), rel=1e-13, abs=0.0)


def test_a_profile_that_falls_again_is_refused_with_the_radius():
    bump = Tabulated(radii=[0.0, 1e-3, 2e-3, 3e-3, 4e-3, 5e-3], heights=[0.0, 1e-4, 2e-4, 1.9e-4, 0.5e-4, 0.2e-4])
    with pytest.raises(UnsupportedSceneError, match=r"contact radius of 0\.00\d+ m"):
        solved(LAYER, bump, ContactRadii([5e-3]))


def test_what_the_indenter_does_not_reach_is_refused_with_the_value():
    with pytest.raises(InvalidInput, match=r"loading.values = 1: the indenter ends at a radius of 0.008 m"):
        solved(LAYER, INDENTERS[-1], IndentationDepths([1.0]))
    with pytest.raises(InvalidInput, match=r"a/h = 1500"):
        solved(LAYER, Cone(slope=0.1), ContactRadii([3.0]))

"""Where an indenter would touch the surface beside its circle of contact, every method refuses to answer."""

import re

import numpy as np
import pytest

from bem.direct_method import IntegralEquationMethod
from bem.flat_punch import IntegralEquation
from bem.method import Bem
from contact import (
    Adhesion,
    Cone,
    ContactError,
    ContactPath,
    ContactRadii,
    DepthHistory,
    Detachment,
    FlatPunch,
    ForceHistory,
    Impact,
    IndentationDepths,
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
from contact.answer.one_circle import Circle, touching_radius
from fem_reference import Fem
from mdr import Mdr
from tests.bed import bed_of
from tests.drawn_scenes import falling_table

LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45)
INCOMPRESSIBLE = Layer.incompressible(thickness=1e-3, shear_modulus=1e6)
MDR, DIRECT, FEM, BEM = Mdr(), IntegralEquationMethod(), Fem(accuracy=1e-3), Bem(points=128)
METHODS = pytest.mark.parametrize("method", [MDR, DIRECT, FEM, BEM], ids=lambda m: m.name)
EXACT_EDGES = pytest.mark.parametrize("method", [MDR, DIRECT, FEM], ids=lambda m: m.name)

# Two measured profiles with a second dip, at r = 2 mm and at r = 0.8 mm.
DIPPED = Tabulated(radii=np.linspace(0, 4e-3, 9), heights=np.array([0, 20, 30, 25, 5, 6, 20, 60, 150]) * 1e-6)
NARROW = Tabulated(
    radii=np.array([0, 0.2, 0.4, 0.6, 0.8, 1, 1.5, 2]) * 1e-3, heights=np.array([0, 6, 8, 3, 2, 8, 30, 80]) * 1e-6
)
# Rises everywhere: a blunt tip, a steep flank, and a plateau that the surface reaches where it bulges up.
STEPPED = Tabulated(
    radii=np.array([0, 0.8, 1.0, 1.1, 2.0, 3.0, 4.0]) * 1e-3, heights=np.array([0, 2, 4, 20, 20.1, 20.2, 60]) * 1e-6
)
TOUCH = r"would touch at r = 0\.00"
ADHESION = Adhesion(work_of_adhesion=1e-4)


def scene_of(indenter, loading, layer=LAYER, effects=()):
    return Scene(layer=layer, indenter=indenter, loading=loading, effects=effects)


@pytest.mark.first(4)
@METHODS
@pytest.mark.parametrize(("indenter", "depth", "dip"), [(DIPPED, 1.5e-5, 2e-3), (NARROW, 4e-6, 0.8e-3)])
def test_a_second_dip_below_the_surface_is_refused_with_its_radius(method, indenter, depth, dip):
    with pytest.raises(UnsupportedSceneError, match="no single circle") as refusal:
        method.solve(scene_of(indenter, IndentationDepths(values=[depth])))
    where = float(re.search(r"touch at r = (\S+) m", str(refusal.value))[1])
    assert where == pytest.approx(dip, rel=0.05, abs=0)


@pytest.mark.first(2)
@METHODS
def test_no_method_answers_where_a_wider_contact_would_swallow_the_dip(method):
    with pytest.raises(ContactError, match="circle"):
        method.solve(scene_of(NARROW, IndentationDepths(values=[6e-6])))


@pytest.mark.first(9)
@EXACT_EDGES
@pytest.mark.parametrize(
    ("indenter", "loading"),
    [
        (NARROW, IndentationDepths(values=[6e-6])),
        (STEPPED, IndentationDepths(values=[3e-5])),
        (DIPPED, ContactRadii(values=[2.4e-3])),
        (NARROW, ContactRadii(values=[0.9e-3])),
        (STEPPED, ContactRadii(values=[2.5e-3])),
    ],
)
def test_rings_and_contacts_that_would_be_pulled_inside_are_refused(method, indenter, loading):
    with pytest.raises(UnsupportedSceneError, match="no single circle"):
        method.solve(scene_of(indenter, loading))


@pytest.mark.parametrize("method", [DIRECT, FEM], ids=lambda m: m.name)
@pytest.mark.parametrize(("indenter", "radius"), [(DIPPED, 3.6e-3), (NARROW, 1.2e-3)])
def test_a_wider_contact_that_presses_everywhere_is_answered(method, indenter, radius):
    path = method.solve(scene_of(indenter, ContactRadii(values=[radius])))
    assert np.all(path.pressure(np.linspace(0.001, 0.999, 200) * radius) > 0.0)


@pytest.mark.first(3)
@METHODS
@pytest.mark.parametrize("loading", [ContactRadii(values=[0.24e-3]), NormalForces(values=[4.9e-3])])
def test_the_same_under_prescribed_radii_and_forces(method, loading):
    with pytest.raises(UnsupportedSceneError, match=TOUCH):
        method.solve(scene_of(DIPPED, loading))


@pytest.mark.parametrize(
    ("method", "loading"),
    [
        (MDR, ContactRadii(values=[0.1e-3, 0.24e-3])),
        (MDR, IndentationDepths(values=[1.5e-5])),
        (MDR, Detachment(initial_contact_radius=0.24e-3)),
        (FEM, ContactRadii(values=[0.24e-3])),
        pytest.param(FEM, Detachment(initial_contact_radius=0.24e-3), marks=pytest.mark.slow),
        (BEM, ContactRadii(values=[0.24e-3])),
        pytest.param(BEM, Detachment(initial_contact_radius=0.24e-3), marks=pytest.mark.slow),
        pytest.param(Bem(points=128, adhesion="cells"), IndentationDepths(values=[1.5e-5]), marks=pytest.mark.slow),
    ],
    ids=lambda value: type(value).__name__,
)
def test_adhering_contacts_are_refused_in_their_own_states(method, loading):
    with pytest.raises(UnsupportedSceneError, match=TOUCH):
        method.solve(scene_of(DIPPED, loading, effects=(ADHESION,)))


def test_adhesion_may_hold_a_dip_above_the_surface_that_pressing_would_touch():
    """The radius whose elastic depth touches the dip is answered where adhesion needs less depth."""
    path = MDR.solve(scene_of(NARROW, ContactRadii(values=[0.08e-3]), effects=(Adhesion(work_of_adhesion=5e-2),)))
    assert gap_beside(path, NARROW).min() >= 0.0
    with pytest.raises(UnsupportedSceneError):
        MDR.solve(scene_of(NARROW, ContactRadii(values=[0.08e-3])))


MOTIONS = [
    Impact(mass=1e-3, velocity=0.02),
    DepthHistory(time=[0.0, 1.0, 2.0], depth=[0.0, 8e-6, 0.0]),
    ForceHistory(time=[0.0, 1.0, 2.0], force=[0.0, 2e-2, 0.0]),
]


@pytest.mark.first(2)
@pytest.mark.parametrize("method", [MDR, FEM], ids=lambda m: m.name)
@pytest.mark.parametrize("loading", MOTIONS, ids=lambda value: type(value).__name__)
def test_motions_are_refused_at_their_largest_contact(method, loading):
    with pytest.raises(UnsupportedSceneError, match="no single circle"):
        method.solve(scene_of(DIPPED, loading, layer=INCOMPRESSIBLE))


def test_a_batch_of_impacts_is_refused_too():
    from mdr.batches import impacts

    with pytest.raises(UnsupportedSceneError, match=TOUCH):
        impacts([scene_of(DIPPED, MOTIONS[0], layer=INCOMPRESSIBLE)], IntegralEquation())


@pytest.mark.parametrize("method", [MDR, DIRECT, FEM], ids=lambda m: m.name)
def test_the_bulge_beside_an_incompressible_layer_touches_a_plateau_higher_than_the_depth(method):
    """At this radius the depth is 19 um, the plateau is 20 um high, and the surface would rise by 3 um there."""
    loading = ContactRadii(values=[1.032e-3])
    with pytest.raises(UnsupportedSceneError, match=TOUCH):
        method.solve(scene_of(STEPPED, loading, layer=INCOMPRESSIBLE))


def random_layer(rng):
    support, ratio = str(rng.choice(["bonded", "unbonded"])), float(rng.choice([0.5, 0.45, 0.3]))
    return Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=ratio, support=support)


def gap_beside(path, indenter):
    """The gap over the depth on many radii outside the contact."""
    r = np.linspace(float(path.contact_radius[0]), indenter.max_radius, 3000)[1:]
    depth = float(path.indentation_depth[0])
    return (indenter.height(r) - depth + path.surface_displacement(r)) / depth


@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("method", "count"), [(MDR, 25), (MDR, 150), (DIRECT, 15), (FEM, 10), (BEM, 15)], ids=lambda v: str(v)[:3]
)
def test_what_is_answered_has_no_negative_gap_beside_the_contact(method, count):
    rng, answered = np.random.default_rng(1), 0
    for _ in range(count):
        (indenter, depth), layer = falling_table(rng, 1e-3), random_layer(rng)
        try:
            path = method.solve(scene_of(indenter, IndentationDepths(values=[depth]), layer=layer))
        except ContactError:
            continue
        answered += 1
        stated = path.error_estimate["contact_radius"][0] + path.error_estimate["normal_force"][0]
        assert gap_beside(path, indenter).min() >= -stated - 1e-9
    assert answered >= count // 5


@pytest.mark.first(2)
@METHODS
def test_a_noisy_table_that_touches_nowhere_else_is_answered(method):
    radii = np.linspace(0.0, 2e-3, 21)
    noise = np.append(0.0, np.random.default_rng(4).uniform(-0.02, 0.02, 20))
    indenter = Tabulated(radii=radii, heights=radii**2 / 0.02 * (1 + noise))
    assert not indenter.is_convex
    path = method.solve(scene_of(indenter, IndentationDepths(values=[2e-5]), layer=INCOMPRESSIBLE))
    assert isinstance(path, ContactPath)


CONVEX = [
    FlatPunch(radius=1.0),
    Paraboloid(radius_of_curvature=1.0),
    Sphere(radius=1.0),
    Cone(slope=1.0),
    TruncatedCone(flat_radius=0.3, slope=1.0),
    TruncatedParaboloid(flat_radius=0.3, radius_of_curvature=1.0),
    PowerLaw(exponent=12.0, reference_radius=1.0, reference_height=1.0),
    PowerLaw(exponent=1.0, reference_radius=1.0, reference_height=1.0),
    Tabulated(radii=np.linspace(0, 1, 9), heights=np.linspace(0, 1, 9) ** 2),
]


@pytest.mark.parametrize("indenter", CONVEX, ids=lambda p: type(p).__name__)
def test_convex_profiles_have_slopes_that_never_fall_and_cost_nothing(indenter):
    assert indenter.is_convex
    slope = indenter.slope_at(np.linspace(0.0, 0.999, 1000))
    assert np.all(np.diff(slope) >= -1e-12)

    def unasked(radius):
        raise AssertionError(f"displacement asked at {radius}")

    assert touching_radius(scene_of(indenter, IndentationDepths(values=[0.1])), Circle(0.5, 0.1, unasked, 0.0)) is None


@pytest.mark.first(1)
@pytest.mark.parametrize(("support", "ratio"), [("bonded", 0.5), ("bonded", 0.48), ("unbonded", 0.3)])
def test_the_mdr_profile_of_every_truncated_cone_rises(support, ratio):
    """So convex profiles, sums of truncated cones, cannot be touched by a bulge beside the contact."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=ratio, support=support)
    for flat in np.geomspace(1e-3, 40.0, 4):
        cone = TruncatedCone(flat_radius=float(flat), slope=1.0)
        excess = np.geomspace(1e-6 * flat, 0.999 * (60.0 - flat), 300)
        assert np.all(np.diff(bed_of(layer, cone).mdr_profile(flat + excess)) > 0.0)


@METHODS
def test_the_surface_under_the_contact_alone_may_be_asked(method):
    """The direct equation once took the largest of no radii outside."""
    answer = method.solve(scene_of(Paraboloid(radius_of_curvature=1e-2), ContactRadii(values=[5e-4])))
    r = np.array([1e-4, 4e-4])
    np.testing.assert_allclose(
        answer.surface_displacement(r), answer.indentation_depth[0] - r**2 / 2e-2, rtol=0, atol=2e-7
    )

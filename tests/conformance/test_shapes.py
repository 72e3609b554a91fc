"""Every shape keeps the promises of `Shape`, and methods that do not model shapes refuse them in words."""

import dataclasses

import numpy as np
import pytest

from bem import Bem
from bem.direct_method import IntegralEquationMethod
from cases.referees.calculix import CalculiX
from cases.referees.grids import ContactMechanics, Tamaas
from cases.units import Units, in_units
from contact import (
    Adhesion,
    ContactRadii,
    Detachment,
    EllipticParaboloid,
    EllipticPunch,
    Friction,
    Harmonics,
    Impact,
    IndentationDepths,
    InvalidInput,
    Layer,
    Paraboloid,
    PolygonalPunch,
    PowerLaw,
    Pyramid,
    Scene,
    UnsupportedSceneError,
    scene_from_mapping,
    scene_to_mapping,
)
from contact.scene.shapes import SHAPES, Flat
from fem_reference import Fem
from mdr import Mdr

TERM = PowerLaw(exponent=3.0, reference_radius=1.0, reference_height=0.1)
EXAMPLES = (
    EllipticParaboloid(first_radius=3.0, second_radius=2.5),
    Pyramid(slope=0.3),
    Pyramid(slope=0.3, sides=3, tip_radius=1.0),
    Harmonics(profile=Paraboloid(radius_of_curvature=3.0), terms={2: 0.1, 3: TERM}),
    PolygonalPunch(inscribed_radius=1.0),
    PolygonalPunch(inscribed_radius=1.0, sides=5, corner_radius=0.2),
    EllipticPunch(first_half_axis=1.1, second_half_axis=0.9),
)
LAYER = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.4)
DEPTH = IndentationDepths([0.05])
ALL = pytest.mark.parametrize("shape", EXAMPLES, ids=lambda s: type(s).__name__)
RADII, ANGLES = np.array([[0.2], [0.5], [0.9]]), np.linspace(0.0, 2.0 * np.pi, 720, endpoint=False)


def press(shape, loading=DEPTH, effects=()):
    return Scene(layer=LAYER, indenter=shape, loading=loading, effects=effects)


def test_every_shape_has_an_example():
    assert {type(example) for example in EXAMPLES} == set(SHAPES)


@ALL
def test_a_shape_is_symmetric_and_starts_at_zero(shape):
    assert np.all(shape.polar(0.0, ANGLES) == 0.0)
    height = shape.polar(RADII, ANGLES)
    for other in (-ANGLES, ANGLES + 2.0 * np.pi / shape.symmetry):
        np.testing.assert_allclose(shape.polar(RADII, other), height, rtol=1e-9)


@ALL
def test_the_mean_is_the_average_over_all_directions(shape):
    if isinstance(shape, Flat):
        assert shape.mean.radius == pytest.approx(np.mean(shape.outline(ANGLES)), rel=1e-4, abs=0.0)
        return
    np.testing.assert_allclose(shape.mean.height(RADII[:, 0]), shape.polar(RADII, ANGLES).mean(axis=1), rtol=1e-4)
    step = 1e-6
    numeric = (shape.polar(RADII + step, ANGLES) - shape.polar(RADII - step, ANGLES)) / (2 * step)
    np.testing.assert_allclose(shape.polar_slope(RADII, ANGLES), numeric, rtol=1e-6)
    orders = (0, *shape.orders)
    sums = shape.harmonic(orders, RADII[:, 0])[0] @ np.cos(np.multiply.outer(orders, ANGLES))
    np.testing.assert_allclose(sums, shape.polar(RADII, ANGLES), rtol=0.1 if isinstance(shape, Pyramid) else 1e-12)


@ALL
def test_files_keep_a_shape(shape):
    assert scene_from_mapping(scene_to_mapping(press(shape))).indenter == shape


@ALL
@pytest.mark.parametrize(
    ("method", "effects"),
    [
        (Fem(), ()),
        (IntegralEquationMethod(), ()),
        (CalculiX(), ()),
        (ContactMechanics(), ()),
        (Tamaas(), ()),
        (Bem(), (Adhesion(work_of_adhesion=1e-3),)),
        (Mdr(), (Adhesion(work_of_adhesion=1e-3),)),
        (Mdr(), (Friction(coefficient=np.inf),)),
    ],
    ids=lambda part: getattr(part, "name", ""),
)
def test_what_does_not_model_a_shape_says_so_and_what_to_take_instead(method, effects, shape):
    scene = press(shape, effects=effects)
    name = type(shape).__name__
    assert name in method.supports(scene).reason
    with pytest.raises(UnsupportedSceneError, match=f"{name}.*take .* in its place"):
        method.solve(scene)


@pytest.mark.parametrize("loading", [Impact(mass=1.0, velocity=1e-3), Detachment()])
def test_motion_and_detachment_of_a_pyramid_name_its_cone(loading):
    effects = (Adhesion(work_of_adhesion=1e-3),) if isinstance(loading, Detachment) else ()
    with pytest.raises(UnsupportedSceneError, match=r"take Cone\(slope=0.265868\) in its place"):
        Mdr().solve(press(Pyramid(slope=0.3), loading, effects))


def test_a_shape_has_no_height_at_a_radius_alone():
    for ask in (Pyramid(slope=0.3).height, Pyramid(slope=0.3).slope_at):
        with pytest.raises(UnsupportedSceneError, match="depends on the direction"):
            ask(0.1)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: press(Pyramid(slope=0.3), ContactRadii([0.1])), "this contact is no circle; give depths or forces"),
        (lambda: Harmonics(profile=Paraboloid(radius_of_curvature=1.0), terms={1: 0.1}), "greater than or equal to 2"),
        (lambda: Harmonics(profile=Paraboloid(radius_of_curvature=1.0), terms={}), "at least one term"),
        (lambda: Harmonics(profile=EXAMPLES[0], terms={2: 0.1}), "profile of revolution"),
        (lambda: PolygonalPunch(inscribed_radius=1.0, corner_radius=2.0), "at most inscribed_radius"),
        (lambda: Pyramid(slope=0.3, sides=6), "sides = 6"),
    ],
)
def test_impossible_shapes_are_refused(make, message):
    with pytest.raises(InvalidInput, match=message):
        make()


def test_a_shape_is_changed_like_any_record():
    assert dataclasses.replace(Pyramid(slope=0.3), sides=3) == Pyramid(slope=0.3, sides=3)


@pytest.mark.first(5)
@pytest.mark.parametrize(
    ("method", "shape"),
    [(Mdr(), shape) for shape in EXAMPLES if getattr(shape, "sides", 4) > 3]
    + [(Bem(points=96), EXAMPLES[1]), (Bem(points=96), EXAMPLES[4])],
    ids=lambda part: getattr(part, "name", type(part).__name__),
)
def test_other_units_give_the_same_answer(method, shape):
    scene = press(shape)
    answer = method.solve(scene)
    for units in (Units(length=2.0**-30, stress=2.0**30, time=1.0), Units(length=2.0**20, stress=2.0**-10, time=1.0)):
        other = method.solve(in_units(scene, units))
        for name in answer.ARRAYS:
            assert getattr(other, name) / units.factor(name) == pytest.approx(getattr(answer, name), rel=1e-9, abs=0.0)


@pytest.mark.slow
def test_refined_settings_and_threads_answer_alike():
    scene = press(Pyramid(slope=0.1))
    for method in (Mdr(), Bem(points=96)):
        path, finer = method.solve(scene), method.refined().solve(scene)
        error = path.uncertainty("normal_force") + finer.uncertainty("normal_force")
        assert abs(path.normal_force - finer.normal_force) <= error
    assert Bem(points=96, threads=2).solve(scene).normal_force == Bem(points=96).solve(scene).normal_force

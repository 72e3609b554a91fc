"""The direct integral equation as a method: against MDR, against closed forms, its own error estimate, refusals."""

import numpy as np
import pytest

from bem.direct import Sizes
from bem.direct_method import IntegralEquationMethod
from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    ElasticBase,
    ExponentialDepth,
    GradedLayer,
    IndentationDepths,
    InvalidInput,
    LayerStack,
    Method,
    NormalForces,
    Paraboloid,
    Scene,
    Sublayer,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
    UnsupportedSceneError,
)
from mdr import Mdr
from tests.mdr.test_method import INDENTERS, LAYERS

RADII = [0.5e-3, 3.7e-3]


def test_it_is_a_method():
    assert isinstance(IntegralEquationMethod(), Method)
    assert IntegralEquationMethod(panel_width=0.5).refined().panel_width == 0.25


@pytest.mark.first(14)
@pytest.mark.parametrize("layer", LAYERS)
@pytest.mark.parametrize("indenter", INDENTERS[:-1], ids=lambda i: type(i).__name__)
def test_direct_solution_agrees_with_mdr(layer, indenter):
    """Independent but for chi; both state errors near 1e-13. Pressure and displacement are compared where smooth."""
    scene = Scene(layer=LAYERS[layer], indenter=indenter, loading=ContactRadii(RADII))
    direct, mdr = IntegralEquationMethod().solve(scene), Mdr().solve(scene)
    for name in ("indentation_depth", "normal_force", "contact_stiffness"):
        difference = np.abs(getattr(direct, name) / getattr(mdr, name) - 1)
        assert np.all(difference <= direct.error_estimate[name] + mdr.error_estimate[name]), name
    inside, outside = np.array([0.1e-3, 0.7e-3, 2.9e-3, 3.6e-3]), np.array([3.71e-3, 5e-3])
    np.testing.assert_allclose(direct.pressure(inside, 1), mdr.pressure(inside, 1), rtol=1e-7)
    scale = mdr.indentation_depth[1]
    np.testing.assert_allclose(
        direct.surface_displacement(outside, 1), mdr.surface_displacement(outside, 1), atol=1e-11 * scale
    )


@pytest.mark.parametrize("layer", LAYERS)
def test_depths_and_forces_find_the_radius(layer):
    indenter = TruncatedCone(flat_radius=0.4e-3, slope=0.2)
    by_radius = IntegralEquationMethod().solve(
        Scene(layer=LAYERS[layer], indenter=indenter, loading=ContactRadii([1e-3]))
    )
    for loading in (IndentationDepths(by_radius.indentation_depth), NormalForces(by_radius.normal_force)):
        path = IntegralEquationMethod().solve(Scene(layer=LAYERS[layer], indenter=indenter, loading=loading))
        np.testing.assert_allclose(path.contact_radius, [1e-3], rtol=1e-12)
        np.testing.assert_allclose(path.normal_force, by_radius.normal_force, rtol=1e-12)


def test_a_contact_no_wider_than_its_flat_end_is_refused():
    """The search once halved the excess for ever."""
    scene = Scene(
        layer=LAYERS["half-space"],
        indenter=TruncatedCone(flat_radius=0.45e-3, slope=0.3),
        loading=IndentationDepths([1e-16]),
    )
    with pytest.raises(InvalidInput, match="as wide as the flat end"):
        IntegralEquationMethod().solve(scene)


PLANTED = {
    "wave numbers": {"waves": 4},
    "largest wave number": {"reach": 4.0},
    "panels": {"nodes": 4, "width": 3.0},
    "transform of the profile": {"slopes": 2},
    "search": {"search": 0.3},
    "panels at the edge of a graded layer": {"corner": 0.5, "nodes": 6},
    "kernel of a graded layer": {"terms": 4},
}


@pytest.mark.first(1)
@pytest.mark.parametrize("fault", PLANTED)
def test_an_error_planted_in_each_discretisation_is_stated(fault, monkeypatch):
    scene = Scene(
        layer=LAYERS["bonded"],
        indenter=TruncatedParaboloid(flat_radius=0.4e-3, radius_of_curvature=0.02),
        loading=NormalForces([3e-2, 1e-1]),
    )
    if "graded" in fault:
        graded = GradedLayer(thickness=1e-3, youngs_modulus=ExponentialDepth(surface=2e6, base=2e7), poissons_ratio=0.3)
        paraboloid = Paraboloid(radius_of_curvature=0.02)
        scene = scene.replace(layer=graded, indenter=paraboloid, loading=ContactRadii([1e-3]))
    exact = IntegralEquationMethod().solve(scene)
    monkeypatch.setattr("bem.direct_method.Sizes", lambda **_: Sizes(**PLANTED[fault]))
    wrong = IntegralEquationMethod().solve(scene)
    error = {name: np.abs(getattr(wrong, name) / getattr(exact, name) - 1) for name in exact.ARRAYS}
    assert max(np.max(one) for one in error.values()) > 1e-10
    for name, one in error.items():
        assert np.all(one <= wrong.error_estimate[name] + exact.error_estimate[name]), name


def measured(rises):
    """A table over two contact radii of 1 mm, from the rises of its steps [um]."""
    heights = 1e-6 * np.concatenate([[0.0], np.cumsum(rises)])
    return Tabulated(radii=np.linspace(0.0, 2e-3, heights.size), heights=heights)


@pytest.mark.parametrize(
    ("rises", "radius", "what"),
    [([9.0, 1.0, 0.1, 0.1], 0.9e-3, "pulled"), ([1.0, 3.0, 5.0, 7.0, 0.1, 0.1, 0.1, 0.1], 0.85e-3, "touch")],
)
def test_contact_that_is_no_single_circle_is_refused(rises, radius, what):
    """One circle presses everywhere inside and touches nowhere outside."""
    scene = Scene(layer=LAYERS["half-space"], indenter=measured(rises), loading=ContactRadii([radius]))
    with pytest.raises(UnsupportedSceneError, match=what):
        IntegralEquationMethod().solve(scene)


def test_pulling_is_refused_where_the_contact_exceeds_its_flat_end_by_roundings():
    """Seen to fail: the pressure was asked at r = a, 0/0 there hid the tension inside, and the contact was answered."""
    film = Sublayer(thickness=0.5, youngs_modulus=10.0, poissons_ratio=0.3)
    layer = LayerStack(sublayers=(film,), interfaces=(), support=ElasticBase(youngs_modulus=1.0, poissons_ratio=0.3))
    scene = Scene(
        layer=layer,
        indenter=TruncatedCone(flat_radius=1.0, slope=1e-3),
        loading=ContactRadii([1.0 + 4 * np.finfo(float).eps]),
    )
    with pytest.raises(UnsupportedSceneError, match=r"pulled at r = 0\.36"):
        IntegralEquationMethod().solve(scene)


def test_refusals():
    adhesive = Scene(
        layer=LAYERS["bonded"],
        indenter=Cone(slope=0.1),
        loading=ContactRadii([1e-3]),
        effects=(Adhesion(work_of_adhesion=0.1),),
    )
    with pytest.raises(UnsupportedSceneError, match="Adhesion"):
        IntegralEquationMethod().solve(adhesive)
    with pytest.raises(UnsupportedSceneError, match="a/h = 200"):
        IntegralEquationMethod().solve(
            Scene(layer=LAYERS["bonded"], indenter=Cone(slope=0.1), loading=ContactRadii([0.2]))
        )
    tip = IntegralEquationMethod().solve(
        Scene(layer=LAYERS["bonded"], indenter=Cone(slope=0.1), loading=ContactRadii([1e-3]))
    )
    with pytest.raises(InvalidInput, match="infinite"):
        tip.pressure([0.0])

"""The direct equation on graded layers: exact rules for the logarithm, any split, MDR, kinks and flat ends."""

from __future__ import annotations

import numpy as np
import pytest
from bem.layer_equation.any_layer.graded_one_radius import GradedDirectDensity
from bem.layer_equation.any_layer.logarithmic_rule import logarithmic_weights
from bem.layer_equation.any_layer.split_kernel import SplitKernel
from scipy.integrate import quad

from bem.direct_method import IntegralEquationMethod
from bem.kernels.of_layer import surface_kernel
from bem.layer_equation.any_layer import graded_one_radius
from bem.layer_equation.any_layer import relative_panels as panels_module
from bem.layer_equation.any_layer.edge_systems import EdgeSystems
from bem.layer_equation.any_layer.point_kernel import PointKernel
from bem.layer_equation.any_layer.relative_panels import RelativePanels, relative_panels
from bem.polynomials.gauss_panels import gauss_nodes
from contact import (
    Cone,
    ContactRadii,
    ElasticBase,
    ExponentialDepth,
    FlatPunch,
    GradedLayer,
    IndentationDepths,
    Layer,
    LinearDepth,
    NormalForces,
    Paraboloid,
    PowerLawDepth,
    Scene,
    Tabulated,
    TabulatedDepth,
    TruncatedCone,
    TruncatedParaboloid,
    UnsupportedSceneError,
)
from mdr import Mdr

PARABOLOID = Paraboloid(radius_of_curvature=1.0)
CONE = TruncatedCone(flat_radius=0.5, slope=0.1)
EXPONENTIAL = GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=4.0), poissons_ratio=0.3)
LAYERS = {
    "exponential": EXPONENTIAL,
    "steep": EXPONENTIAL.replace(youngs_modulus=ExponentialDepth(surface=1.0, base=100.0)),
    "softer below, elastic base": EXPONENTIAL.replace(
        youngs_modulus=ExponentialDepth(surface=1.0, base=0.1),
        support=ElasticBase(youngs_modulus=0.5, poissons_ratio=0.3),
    ),
    "incompressible": EXPONENTIAL.replace(poissons_ratio=0.5),
    "unbonded": EXPONENTIAL.replace(support="unbonded"),
    "power law": EXPONENTIAL.replace(youngs_modulus=PowerLawDepth(surface=1.0, reference_depth=0.1, exponent=1.0)),
}
QUANTITIES = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")


@pytest.mark.parametrize("target", [0.0503, 0.101, 0.3, 0.9999, 1.0, 1.01, 1.3, 5.0, -0.2, -3.0])
def test_polynomials_times_a_logarithm_are_integrated_exactly(target):
    ends, count = np.array([0.0, 0.1, 0.5, 1.0]), 12
    t = (ends[:-1, None] + np.diff(ends)[:, None] * gauss_nodes(count)[0]).ravel()
    found = logarithmic_weights(ends, count, np.array([target]))[0] @ (1 + t**7)
    inside = [target] if 0 < target < 1 else None
    expected, _ = quad(lambda s: (1 + s**7) * np.log(abs(target - s)), 0, 1, points=inside, epsabs=1e-13, limit=200)
    assert found == pytest.approx(expected, rel=1e-12, abs=1e-13)


@pytest.mark.parametrize("length", [0.3, 1.0, 3.0])
def test_the_kernel_by_another_path_and_any_split(length):
    """Complex wavenumbers against real ones: nothing but 1 - chi is shared."""
    surface = surface_kernel(EXPONENTIAL)
    s = np.geomspace(1e-9, 40.0, 40)
    np.testing.assert_allclose(SplitKernel(surface, length)(s), PointKernel.of_surface(surface)(s), rtol=0, atol=3e-13)


@pytest.mark.parametrize("x", [0.3, 1.99, 3.9])
def test_what_is_left_of_the_resolvent_starts_from_an_exact_integral(x):
    """Of two kernels' product, by adaptive quadrature. The layer's images are closest where x is two thicknesses."""
    systems = EdgeSystems(PointKernel.of_surface(surface_kernel(LAYERS["softer below, elastic base"])), 12)
    t = np.array([0.01, 0.4, 0.97]) * x

    def product(s: float, at: float) -> float:
        N = systems.kernel
        left, right = N(np.array([abs(at - s)])) + N(np.array([at + s])), N(np.array([x - s])) + N(np.array([x + s]))
        return float((left * right)[0]) / np.pi**2

    expected = [
        sum(quad(product, a, b, args=(at,), epsabs=1e-12, epsrel=1e-12, limit=200)[0] for a, b in ((0, at), (at, x)))
        for at in t
    ]
    np.testing.assert_allclose(systems._iterated(x, t), expected, rtol=0, atol=1e-10)


@pytest.mark.parametrize("x", [0.01, 2.4])
def test_the_kernel_goes_on_like_its_logarithm(x):
    """Held constant below 2^-40 thicknesses it left 4e-12 out of this integral, whatever the panels."""
    kernel = PointKernel.of_surface(surface_kernel(LAYERS["power law"]))
    found = float(EdgeSystems(kernel, 16).matrix(x, relative_panels(16, 2))[-1].sum())
    assert found == pytest.approx(float(kernel.integral(np.array([2 * x]))[0]) / np.pi, rel=0, abs=2e-13)


def test_the_rule_beside_a_target_has_nodes_enough(monkeypatch):
    """With 20 nodes the edge value was 6e-12 off: polynomials in s = v^6 are of degree 66 in v."""
    kernel, ends = PointKernel.of_surface(surface_kernel(LAYERS["incompressible"])), relative_panels(12, 2).ends
    found = EdgeSystems(kernel, 12).at(4.0).edge_density
    monkeypatch.setattr(panels_module, "SINGULAR_NODES", 48)
    monkeypatch.setattr(EdgeSystems, "panels", lambda self, x: RelativePanels(ends, 12))
    assert found == pytest.approx(EdgeSystems(kernel, 12).at(4.0).edge_density, rel=1e-12, abs=0)


def test_errors_behind_a_rim_are_stated_by_what_the_resolvent_leaves_out():
    """About 2e-12 is wrong here, where 3.6e-10 was stated."""
    layer = LAYERS["softer below, elastic base"]
    scene = Scene(layer=layer, indenter=CONE, loading=ContactRadii([0.8]))
    ours, other = Mdr().solve(scene), IntegralEquationMethod().solve(scene)
    for quantity in ("indentation_depth", "normal_force"):
        error = np.abs(getattr(ours, quantity) / getattr(other, quantity) - 1)
        assert np.all(error <= ours.error_estimate[quantity]), quantity
        assert np.all(ours.error_estimate[quantity] < 1e-10), quantity


@pytest.mark.slow
def test_what_the_resolvent_leaves_out_counts_where_its_first_order_has_a_node_at_the_rim():
    """On 16 nodes, seen to fail: a depth 4.1e-12 off where 3.4e-12 was stated, without what ends of pieces magnify."""
    softer, base = LinearDepth(surface=2.0, base=1.0), ElasticBase(youngs_modulus=1.0, poissons_ratio=0.3)
    layer = EXPONENTIAL.replace(youngs_modulus=softer, support=base)
    scene = Scene(layer=layer, indenter=CONE, loading=ContactRadii([1.4307503132360648]))
    ours, other = Mdr().solve(scene), IntegralEquationMethod(nodes=18).solve(scene)
    for quantity in ("indentation_depth", "normal_force"):
        error = np.abs(getattr(ours, quantity) / getattr(other, quantity) - 1)
        assert np.all(error <= ours.error_estimate[quantity]), quantity
        assert np.all(ours.error_estimate[quantity] < 1e-11), quantity


def test_the_kernel_keeps_its_digits_at_the_ends_of_octaves():
    """Seen to fail: 1.7e-12 off at four thicknesses, by 18 nodes on octaves beside which an image lies."""
    kernel = PointKernel.of_surface(surface_kernel(LAYERS["incompressible"]))
    s = 2.0 ** np.arange(-3.0, 5.0)
    np.testing.assert_allclose(kernel(s), kernel.exponentials(s), rtol=0, atol=3e-14)


def test_the_answer_does_not_depend_on_the_split(monkeypatch):
    whole = GradedDirectDensity.solve(EXPONENTIAL, PARABOLOID, 1.0, 0.75, 12)
    monkeypatch.setattr(graded_one_radius, "SPLIT_LENGTH", 3.0)
    other = GradedDirectDensity.solve(EXPONENTIAL, PARABOLOID, 1.0, 0.75, 12)
    assert other.split.length != whole.split.length
    assert other.force(other.depth) == pytest.approx(whole.force(whole.depth), rel=1e-13, abs=0.0)
    assert other.depth == pytest.approx(whole.depth, rel=1e-13, abs=0.0)


MEASURED = Tabulated(radii=[0.0, 0.2, 0.5, 1.5], heights=[0.0, 0.01, 0.07, 0.71])
CONTACTS = {
    "paraboloid": (PARABOLOID, ContactRadii([0.1, 1.0, 5.0])),
    "paraboloid, force": (PARABOLOID, NormalForces([0.5])),
    "cone, depth": (Cone(slope=0.1), IndentationDepths([0.05])),
    "cone, small": (Cone(slope=0.1), ContactRadii([0.2, 0.5])),
    "flat punch": (FlatPunch(radius=1.0), NormalForces([1.0])),
    "truncated cone": (CONE, ContactRadii([0.8])),
    "truncated, from beside the rim to wide": (CONE, ContactRadii([0.51, 1.03, 3.0])),
    "small flat end": (TruncatedParaboloid(flat_radius=0.05, radius_of_curvature=1.0), ContactRadii([0.06, 0.4])),
    "bends": (MEASURED, ContactRadii([0.3, 0.8, 1.2])),
}


def compared(layer, indenter, loading, tolerance=1e-8, beside=1e-10):
    scene = Scene(layer=layer, indenter=indenter, loading=loading)
    ours, other = Mdr().solve(scene), IntegralEquationMethod().solve(scene)
    for quantity in QUANTITIES:
        one, two = getattr(ours, quantity), getattr(other, quantity)
        np.testing.assert_allclose(one, two, rtol=tolerance / 10)
        stated = ours.error_estimate[quantity] + other.error_estimate[quantity] + 1e-15
        assert np.all(np.abs(one / two - 1) <= stated), quantity
    a = float(ours.contact_radius[0])
    inside, outside = a * np.array([0.1, 0.5, 0.9, 0.99]), a * np.array([1.001, 1.1, 2.0, 4.0])
    np.testing.assert_allclose(ours.pressure(inside, 0), other.pressure(inside, 0), rtol=1e-6)
    np.testing.assert_allclose(
        ours.surface_displacement(outside, 0),
        other.surface_displacement(outside, 0),
        rtol=0,
        atol=beside * ours.indentation_depth[0],
    )


# Behind flat ends and bends, 1e-8 as required on graded layers; the test asks for a tenth of a tolerance.
BEHIND_RIMS = {
    name: {"tolerance": 1e-7, "beside": 1e-8}
    for name in ("truncated cone", "truncated, from beside the rim to wide", "small flat end", "bends")
}


@pytest.mark.parametrize("contact", ["flat punch", "truncated cone"])
def test_mdr_agrees(contact):
    """Without and with a flat end that is left; all contacts on all layers are slow."""
    compared(LAYERS["softer below, elastic base"], *CONTACTS[contact], **BEHIND_RIMS.get(contact, {}))


@pytest.mark.slow
@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize("name", LAYERS)
def test_mdr_agrees_on_every_layer(name, contact):
    compared(LAYERS[name], *CONTACTS[contact], **BEHIND_RIMS.get(contact, {}))


def solved(layer, indenter, loading, **settings):
    return IntegralEquationMethod(**settings).solve(Scene(layer=layer, indenter=indenter, loading=loading))


@pytest.mark.parametrize("indenter", [CONE, pytest.param(MEASURED, marks=pytest.mark.slow)], ids=["cone", "measured"])
def test_kinks_and_bends_on_a_uniform_table_are_those_of_one_layer(indenter):
    """A table of one modulus is a graded layer without a logarithm; panels shrink towards its kinks all the same."""
    plain = Layer(thickness=2.0, youngs_modulus=3.0, poissons_ratio=0.4)
    table = TabulatedDepth(depths=[0.0, 1.0, 2.0], values=[3.0, 3.0, 3.0])
    graded = GradedLayer(thickness=2.0, youngs_modulus=table, poissons_ratio=0.4)
    one, other = (solved(layer, indenter, ContactRadii([0.8])) for layer in (plain, graded))
    for quantity in QUANTITIES:
        np.testing.assert_allclose(getattr(other, quantity), getattr(one, quantity), rtol=1e-10)
    inside = np.array([0.1, 0.45, 0.55, 0.79])
    np.testing.assert_allclose(other.pressure(inside, 0), one.pressure(inside, 0), rtol=1e-7)


@pytest.fixture(scope="module")
def on_many_nodes():
    return solved(EXPONENTIAL, CONE, ContactRadii([0.6, 1.0]), nodes=20)


@pytest.mark.parametrize("nodes", [10, 12])
def test_fewer_nodes_stay_within_the_stated_errors(nodes, on_many_nodes):
    """Flat ends on a layer with a logarithm."""
    coarse = solved(EXPONENTIAL, CONE, ContactRadii([0.6, 1.0]), nodes=nodes)
    for quantity in QUANTITIES[1:]:
        change = np.abs(getattr(coarse, quantity) / getattr(on_many_nodes, quantity) - 1)
        assert np.all(change <= coarse.error_estimate[quantity] + on_many_nodes.error_estimate[quantity]), quantity
        assert np.all(coarse.error_estimate[quantity] < 1e-8), quantity


def test_wide_contacts_are_refused_with_the_limit():
    with pytest.raises(UnsupportedSceneError, match=r"a/h = 20: .* ratios up to 16"):
        solved(EXPONENTIAL, PARABOLOID, ContactRadii([20.0]))

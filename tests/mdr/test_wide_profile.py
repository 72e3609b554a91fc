"""Profiles on layers up to a thousand times thinner than the contact is wide."""

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from contact import (
    Cone,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    LayerStack,
    NormalForces,
    Paraboloid,
    Scene,
    Sphere,
    Sublayer,
    Tabulated,
    TruncatedCone,
)
from mdr import Mdr

LAYERS = {
    "bonded 0.5": Layer(thickness=1.0, youngs_modulus=0.75, poissons_ratio=0.5),
    "bonded 0.3": Layer(thickness=1.0, youngs_modulus=0.91, poissons_ratio=0.3),
    "unbonded": Layer(thickness=1.0, youngs_modulus=0.91, poissons_ratio=0.3, support="unbonded"),
    "half-space": Layer.half_space(youngs_modulus=0.91, poissons_ratio=0.3),
}
TWO_LAYERS = LayerStack(
    sublayers=tuple(Sublayer(thickness=h, youngs_modulus=0.91, poissons_ratio=0.3) for h in (1.0, 20.0)),
    interfaces=("bonded",),
)
INDENTERS = [Paraboloid(radius_of_curvature=1.0), Cone(slope=1.0), TruncatedCone(flat_radius=30.0, slope=1.0)]
SOURCE = IntegralEquation(nodes=20)


@pytest.mark.slow
@pytest.mark.parametrize("radius", [300.0, 1000.0])
def test_pressure_in_the_middle_of_thin_layers(radius):
    """Closed forms of the film, exact but for exp(-(a - r)/h): chi(q)/q = 1/2 + O(q^4), 2 q^2/3 + O(q^4) at nu = 1/2.

    Unbonded p = E* (delta - f)/h. Bonded compressible p = M delta/h, M the confined modulus. Bonded incompressible
    Laplacian of p = -3 E* delta/(4 h^3).
    """
    r = radius * np.array([0.1, 0.5, 0.9])
    path = _pressed("unbonded", 0.3, INDENTERS[0], ContactRadii([radius]))
    expected = path.scene.layer.contact_modulus * (path.indentation_depth[0] - r**2 / 2)
    np.testing.assert_allclose(path.pressure(r), expected, rtol=1e-7)
    punch, depth = FlatPunch(radius=radius), IndentationDepths([1e-3])
    confined = 0.7 / (1.3 * 0.4)
    np.testing.assert_allclose(_pressed("bonded", 0.3, punch, depth).pressure(r), 1e-3 * confined, rtol=1e-7)
    path = _pressed("bonded", 0.5, punch, depth)
    fall = path.pressure(r[:1]) - path.pressure(r[1:])
    expected = 3 / 16 * path.scene.layer.contact_modulus * 1e-3 * (r[1:] ** 2 - r[0] ** 2)
    np.testing.assert_allclose(fall, expected, rtol=path.error_estimate["pressure"][0])


def _pressed(support, nu, indenter, loading):
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu, support=support)
    return Mdr(flat_punch=SOURCE).solve(Scene(layer=layer, indenter=indenter, loading=loading))


@pytest.mark.parametrize("radius", [162.0, 176.4, 200.0])
def test_a_sphere_close_to_its_equator_is_answered_on_a_thin_layer(radius):
    """The indenter was once asked for further out than the contact reaches."""
    loading = ContactRadii([0.99999 * radius])
    path = Mdr().solve(Scene(layer=LAYERS["bonded 0.3"], indenter=Sphere(radius=radius), loading=loading))
    again = Mdr().solve(path.scene.replace(loading=IndentationDepths(path.indentation_depth)))
    np.testing.assert_allclose(again.normal_force, path.normal_force, rtol=1e-11)


@pytest.mark.first(3)
@pytest.mark.parametrize("radius", [160.01, 162.0, 165.0])
@pytest.mark.parametrize("ratio", [159.84, 160.0])
def test_a_sphere_whose_equator_is_near_is_answered_by_its_own_depth_and_force(radius, ratio):
    """The trial beyond a/h = 160 asked for the sphere out to 168 h; radii were answered, their depths refused."""
    scene = Scene(layer=LAYERS["bonded 0.3"], indenter=Sphere(radius=radius), loading=ContactRadii([ratio]))
    path = Mdr().solve(scene)
    for loading in IndentationDepths(path.indentation_depth), NormalForces(path.normal_force):
        np.testing.assert_allclose(Mdr().solve(scene.replace(loading=loading)).contact_radius, ratio, rtol=1e-12)


@pytest.mark.parametrize("name", ["half-space", "bonded 0.5"])
def test_a_depth_that_asks_for_the_equator_is_refused(name):
    for radius in 26.562805794370153, 0.9, 4e-3:
        for loading in IndentationDepths([40 * radius]), NormalForces([1e16]):
            scene = Scene(layer=LAYERS[name], indenter=Sphere(radius=radius), loading=loading)
            with pytest.raises(InvalidInput, match="the sphere has sunk to its equator; press less"):
                Mdr().solve(scene)


@pytest.mark.parametrize("left", [1e-9, 1.1952075995580458e-09, 3.7e-7, 4.6e-5])
def test_depth_and_force_keep_their_digits_beside_an_equator(left):
    """At 1.2e-9 before it both were 1.1e-8 off: nodes were rounded, and polynomials magnify that beyond the last."""
    radius = 0.06309257125121798
    a = radius * (1 - left)
    scene = Scene(layer=LAYERS["half-space"], indenter=Sphere(radius=radius), loading=ContactRadii([a]))
    path = Mdr().solve(scene)
    logarithm = np.log1p(2 * a / (radius - a))
    np.testing.assert_allclose(path.indentation_depth, a * logarithm / 2, rtol=1e-13)
    force = (a**2 + radius**2) / 2 * logarithm - a * radius  # F/E*, Hertz-type integral of x artanh(x/R)
    np.testing.assert_allclose(path.normal_force, scene.layer.contact_modulus * force, rtol=1e-13)


def test_the_last_number_before_an_equator_is_refused_in_words():
    """Nodes were rounded onto the equator, and the logarithm of zero was taken."""
    layer, radius = Layer(thickness=1.1097018302282244, youngs_modulus=1e6, poissons_ratio=0.5), 26.562805794370153
    scene = Scene(layer=layer, indenter=Sphere(radius=radius), loading=ContactRadii([np.nextafter(radius, 0.0)]))
    with pytest.raises(InvalidInput, match="the sphere has sunk to its equator; stay a little below"):
        Mdr().solve(scene)


@pytest.mark.slow
@pytest.mark.parametrize("layer", [LAYERS["unbonded"], TWO_LAYERS], ids=["layer", "stack"])
def test_what_is_answered_at_the_last_radii_that_data_cover_is_answered_by_depth_and_force(layer):
    """The search went five percent beyond the radius and was refused, at a/h = 1020."""
    indenter, last = Paraboloid(radius_of_curvature=1e6), 980.0 if isinstance(layer, Layer) else 314.0
    path = Mdr().solve(Scene(layer=layer, indenter=indenter, loading=ContactRadii([last])))
    for loading in IndentationDepths(path.indentation_depth), NormalForces(path.normal_force):
        again = Mdr().solve(path.scene.replace(loading=loading))
        np.testing.assert_allclose(again.contact_radius, last, rtol=1e-9)


def test_a_table_that_falls_at_two_places_is_answered_before_the_first():
    """Up to the first node at which it falls it fell at another one of a finer grid, and the force was refused."""
    radii = [0.0, 49.5, 92.9, 136.5, 163.9, 177.4, 201.3, 215.3, 240.1, 279.4]
    heights = [0.0, 0.0194, 0.1393, 0.3065, 0.5609, 0.4620, 0.7690, 0.8595, 1.0394, 1.9706]
    layer = Layer(thickness=21.132, youngs_modulus=252708.0, poissons_ratio=0.5, support="unbonded")
    scene = Scene(layer=layer, indenter=Tabulated(radii=radii, heights=heights), loading=IndentationDepths([0.10738]))
    path = Mdr().solve(scene)
    again = Mdr().solve(scene.replace(loading=NormalForces(path.normal_force)))
    np.testing.assert_allclose(again.indentation_depth, path.indentation_depth, rtol=1e-13)


@pytest.mark.slow
def test_roundings_beside_an_equator_are_no_fall_of_the_profile():
    """At 1e-12 of the radius they are 1e-5 of the depth, and the contact was said to be no single circle."""
    layer = Layer(thickness=1 / 156.42000000015997, youngs_modulus=1e6, poissons_ratio=0.3)
    scene = Scene(layer=layer, indenter=Sphere(radius=1.0), loading=ContactRadii([1 - 1e-12]))
    path = Mdr().solve(scene)
    assert 1e-7 < path.error_estimate["indentation_depth"][0] < 1e-2


@pytest.mark.slow
def test_more_resolution_than_needed_changes_no_pressure():
    """At a/h = 10 and nu = 1/2, far more polynomials than wave numbers of the default would resolve."""
    scene = Scene(layer=LAYERS["bonded 0.5"], indenter=INDENTERS[0], loading=ContactRadii([10.0]))
    scene = scene.replace(beyond_small_strains=True)
    usual, finer = (
        Mdr(flat_punch=IntegralEquation(nodes=nodes, panel_width=width)).solve(scene).pressure(np.array([0.0, 5.0]))
        for nodes, width in ((24, 1.0), (64, 0.1))
    )
    np.testing.assert_allclose(finer, usual, rtol=1e-11)


@pytest.mark.slow
@pytest.mark.parametrize("layer", ["bonded 0.3", "bonded 0.5"])
def test_pressures_next_to_a_kink_of_a_very_wide_contact_are_within_their_stated_error(layer):
    """Two refinements change p by 4e-5 of its mean within a thickness of the kink at nu = 0.3."""
    radius, flat = 600.0, 300.0
    scene = Scene(
        layer=LAYERS[layer],
        indenter=TruncatedCone(flat_radius=flat, slope=0.01),
        loading=ContactRadii([radius]),
        beyond_small_strains=True,
    )
    path, finer = Mdr().solve(scene), Mdr().refined().refined().solve(scene)
    r = np.append(flat + np.array([-1.0, -0.6, 0.3, 1.0]), radius * np.array([0.3, 0.48, 0.52, 0.7, 0.95]))
    mean = path.normal_force[0] / (np.pi * radius**2)
    assert np.abs(path.pressure(r) - finer.pressure(r)).max() <= path.error_estimate["pressure"][0] * mean

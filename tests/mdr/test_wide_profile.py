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
    NormalForces,
    Paraboloid,
    Scene,
    Sphere,
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


def test_a_table_that_falls_at_two_places_is_answered_before_the_first():
    """Up to the first node at which it falls it fell at another one of a finer grid, and the force was refused."""
    radii = [0.0, 49.5, 92.9, 136.5, 163.9, 177.4, 201.3, 215.3, 240.1, 279.4]
    heights = [0.0, 0.0194, 0.1393, 0.3065, 0.5609, 0.4620, 0.7690, 0.8595, 1.0394, 1.9706]
    layer = Layer(thickness=21.132, youngs_modulus=252708.0, poissons_ratio=0.5, support="unbonded")
    scene = Scene(layer=layer, indenter=Tabulated(radii=radii, heights=heights), loading=IndentationDepths([0.10738]))
    path = Mdr().solve(scene)
    again = Mdr().solve(scene.replace(loading=NormalForces(path.normal_force)))
    np.testing.assert_allclose(again.indentation_depth, path.indentation_depth, rtol=1e-13)

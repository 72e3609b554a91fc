"""The second kernel of layered bodies, and the shape test: they see a kernel that all methods share."""

import numpy as np
import pytest

from bem.kernels.of_layer import surface_kernel
from cases.declare.quantities import values_of
from cases.library import film_on_substrate, graded_layer, three_zone_cartilage, two_layers
from cases.library._second_kernel import surface_compliance
from cases.library._shape_test import COMPARED, Pressed
from cases.library._stacks import base, pressed, stack
from contact import FlatPunch, InvalidInput, Layer
from mdr import Mdr

LAYERS = {
    **two_layers.LAYERS,
    **three_zone_cartilage.LAYERS,
    **graded_layer.LAYERS,
    "film on a slipping base": stack((1.0, 1.0, 0.3), support=base(0.01, 0.5, "unbonded")),
}


def relative(layer, wavenumber, factor=1.0):
    """Distance of the second kernel from that of all methods."""
    own = surface_compliance(layer, wavenumber) * layer.contact_modulus / 2
    return np.abs(factor * own / surface_kernel(layer).chi(wavenumber * layer.surface.thickness) - 1)


@pytest.mark.first(12)
@pytest.mark.parametrize("name", LAYERS)
def test_two_kernels_agree(name):
    """One linear system loses digits like (k h)^-3 of thin layers, so long waves are left out."""
    layer = LAYERS[name]
    shortest = min([one.thickness for one in getattr(layer, "sublayers", ())], default=layer.thickness)
    assert relative(layer, np.geomspace(0.3, 40.0, 12) / shortest).max() < 1e-11


def test_the_closed_form_of_a_film_agrees():
    for contrast in film_on_substrate.CONTRASTS:
        layer = film_on_substrate.film(contrast, 1.0).scene.layer
        wavenumber = np.geomspace(0.05, 40.0, 12) / layer.thickness
        closed = film_on_substrate.closed_form(layer, wavenumber)
        np.testing.assert_allclose(closed, surface_compliance(layer, wavenumber), rtol=1e-12)


def missed(case_scene, compliance):
    """What the pressure of MDR leaves of delta - f, relative to delta."""
    scene, rings = case_scene.scene, case_scene.sampling.rings
    path = Mdr().solve(scene)
    own = Pressed(rings, path.pressure(rings.radius.ravel(), 0), singular=isinstance(scene.indenter, FlatPunch))
    radius, depth = COMPARED * rings.edges[-1], values_of(path, "indentation_depth")[0]
    found = own.displacement(scene.layer, compliance, radius, 24.0 / scene.layer.surface.thickness)
    return float(np.max(np.abs(found - depth + scene.indenter.height(radius)))) / depth


@pytest.mark.parametrize("indenter", ["paraboloid", "flat punch"])
@pytest.mark.parametrize("wrong", [1.0, 1.01])
def test_the_shape_test_sees_a_kernel_one_per_cent_wrong(indenter, wrong):
    """Only the layer's own share is changed, as a slip in a denominator would."""
    layer = two_layers.LAYERS["soft on stiff"]

    def slipped(body, wavenumber):
        right = surface_compliance(body, wavenumber)
        half_space = 2 / body.contact_modulus
        return half_space + wrong * (right - half_space)

    residual = missed(pressed("soft on stiff", layer, 1.0, indenter), slipped)
    assert residual < 1e-12 if wrong == 1.0 else residual > 1e-4


def test_other_layers_have_no_second_kernel():
    with pytest.raises(InvalidInput, match="layer = Layer"):
        surface_compliance(Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3), np.ones(1))


def test_limits_of_films():
    """A plate: l = 11.86 h at a contrast of 1e4, and k_N within one per cent; C of two incompressible layers."""
    scene = film_on_substrate.PLATES[1].scene
    length = film_on_substrate.bending_length(scene) / scene.layer.thickness
    assert length == pytest.approx((1e4 / 6) ** (1 / 3), rel=1e-12, abs=0.0)
    found = Mdr().solve(scene).contact_stiffness[0]
    assert film_on_substrate.bent_plate(scene) == pytest.approx(found, rel=1e-2, abs=0.0)
    flowing = two_layers.THIN[0].scene
    even = flowing.replace(layer=stack((0.5, 1.0, 0.5), (0.5, 1.0, 0.5)))
    thickness, young, a = even.layer.thickness, even.layer.surface.youngs_modulus, even.indenter.flat_radius
    one = np.pi * young * a**4 / (8 * thickness**3)
    assert two_layers.flowing(even) == pytest.approx(one, rel=1e-12, abs=0.0)

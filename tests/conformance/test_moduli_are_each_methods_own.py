"""Each method derives its moduli from E and nu itself: a mistake in the layer's own properties reaches none of them."""

import pytest

from cases.declare.methods import build
from contact import ContactRadii, Layer, Paraboloid, Scene

LAYER = Layer(thickness=1.0, youngs_modulus=3.0, poissons_ratio=0.4)
SCENE = Scene(layer=LAYER, indenter=Paraboloid(radius_of_curvature=5.0), loading=ContactRadii([0.5]))
METHODS = {"mdr": {}, "integral_equation": {}, "bem": {"points": 96}, "fem": {"accuracy": 1e-2}}


def asked(_):
    raise AssertionError("a method asked the layer for a modulus")


@pytest.mark.parametrize("method", METHODS)
def test_no_method_asks_the_layer_for_a_modulus(method, monkeypatch):
    for name in ("contact_modulus", "shear_modulus", "confined_modulus"):
        monkeypatch.setattr(Layer, name, property(asked))
    assert build(method, METHODS[method]).solve(SCENE).normal_force[0] > 0


@pytest.mark.parametrize(
    ("place", "method"),
    [
        ("bem.kernels.moduli:contact_modulus", "mdr"),
        ("fem_reference.materials:shear_modulus", "fem"),
    ],
)
def test_a_modulus_one_per_cent_wrong_parts_the_methods(place, method, monkeypatch):
    from tests.planted.planting import forget_computed, swap

    right = {name: build(name, METHODS[name]).solve(SCENE).normal_force[0] for name in ("mdr", "fem")}
    forget_computed()
    swap(place, lambda modulus: lambda layer: 1.01 * modulus(layer))(monkeypatch)
    wrong = {name: build(name, METHODS[name]).solve(SCENE).normal_force[0] for name in ("mdr", "fem")}
    forget_computed()
    moved = {name: wrong[name] / right[name] for name in right}
    assert moved.pop(method) == pytest.approx(1.01, rel=1e-6, abs=0.0)
    assert next(iter(moved.values())) == 1.0

"""What an answer without friction says about it: on thin, nearly incompressible layers only, and never too little."""

import re

import pytest

from contact import ContactRadii, IndentationDepths, Layer, LayerStack, Paraboloid, Scene, Sublayer
from contact.answer.friction import _SLIDES
from fem_reference import Fem
from mdr import Mdr
from mdr.friction.statement import _slip, friction_effect


def scene(nu, radius, support="bonded"):
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu, support=support)
    return Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=400.0), loading=ContactRadii([radius]))


@pytest.mark.parametrize("support", ["bonded", "unbonded"])
@pytest.mark.parametrize("nu", [0.49, 0.5])
def test_the_note_is_above_the_bound(nu, support):
    path = Mdr().solve(scene(nu, 2.0, support))
    (note,) = path.notes
    percent = float(re.search(r"up to (\S+) %", note).group(1))
    upper = float(friction_effect(path, 0.1).upper[0])
    assert upper < percent / 100.0 < 3.0 * upper


@pytest.mark.parametrize(("nu", "radius"), [(0.3, 5.0), (0.48, 2.0), (0.5, 0.5)])
def test_other_layers_have_no_note(nu, radius):
    assert Mdr().solve(scene(nu, radius)).notes == ()


def test_a_half_space_has_no_note():
    layer = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.5)
    assert Mdr().solve(scene(0.5, 2.0).replace(layer=layer)).notes == ()


@pytest.mark.parametrize(("nu", "radius", "notes"), [(0.5, 2.0, 1), (0.3, 2.0, 0), (0.5, 0.9, 0)])
def test_stacks_with_a_thin_soft_surface_point_at_the_bound(nu, radius, notes):
    """Seen to fail: only plain layers had a note."""
    sublayers = tuple(Sublayer(thickness=1.0, youngs_modulus=E, poissons_ratio=n) for E, n in ((1.0, nu), (10.0, 0.3)))
    layer = LayerStack(sublayers=sublayers, interfaces=("bonded",), support="bonded")
    found = Mdr().solve(scene(nu, radius).replace(layer=layer)).notes
    assert len(found) == notes
    assert all("advise bounds it" in note for note in found)


def test_finite_elements_say_it_too():
    (note,) = Fem(order=3).solve(scene(0.5, 2.0)).notes
    assert note == Mdr().solve(scene(0.5, 2.0)).notes[0]
    depths = scene(0.5, 2.0).replace(loading=IndentationDepths([0.05]))
    assert "more than half" in Mdr().solve(depths).notes[0]


@pytest.mark.slow
@pytest.mark.parametrize("support", ["bonded", "unbonded"])
def test_no_layer_slides_farther(support):
    for nu in (0.45, 0.47, 0.49, 0.5):
        own = Layer(thickness=1.0, youngs_modulus=1.0 - nu**2, poissons_ratio=nu, support=support)
        slid = [_slip(own, x)[1] / x for x in (0.5, 1.0, 2.0, 5.0, 20.0)]
        assert max(slid) < _SLIDES[support]

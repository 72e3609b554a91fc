"""Records of several layers and of graded ones: what they refuse, what files hold, and other units."""

from __future__ import annotations

import numpy as np
import pytest

from cases.units import Units, in_units
from contact import (
    ContactRadii,
    ElasticBase,
    ExponentialDepth,
    GradedLayer,
    InvalidInput,
    KelvinVoigt,
    Layer,
    LayerStack,
    LinearDepth,
    Paraboloid,
    PowerLawDepth,
    Scene,
    Sublayer,
    TabulatedDepth,
    scene_from_mapping,
    scene_to_mapping,
)

TOP = Sublayer(thickness=0.2e-3, youngs_modulus=1e6, poissons_ratio=0.5)
LOWER = Sublayer(thickness=0.8e-3, youngs_modulus=5e6, poissons_ratio=0.3)
BASE = ElasticBase(youngs_modulus=2e9, poissons_ratio=0.2, interface="unbonded")
TABLE = TabulatedDepth(depths=[0.0, 0.4e-3, 1e-3], values=[1e6, 2e6, 5e6])
RATIOS = TabulatedDepth(depths=[0.0, 2e-3], values=[0.2, 0.5])
STACK = LayerStack(sublayers=(TOP, LOWER), interfaces=("bonded",))

LAYERS = {
    "stack": STACK,
    "slipping stack on an unbonded base": STACK.replace(interfaces=("unbonded",), support="unbonded"),
    "film on a half-space": LayerStack(sublayers=(TOP,), support=BASE),
    "exponential": GradedLayer(
        thickness=1e-3, youngs_modulus=ExponentialDepth(surface=1e6, base=4e6), poissons_ratio=0.3
    ),
    "linear": GradedLayer(
        thickness=1e-3, youngs_modulus=LinearDepth(surface=4e6, base=1e6), poissons_ratio=0.5, support="unbonded"
    ),
    "power law": GradedLayer(
        thickness=1e-3,
        youngs_modulus=PowerLawDepth(surface=1e6, reference_depth=1e-4, exponent=0.5),
        poissons_ratio=RATIOS,
        support=BASE,
    ),
    "tabulated": GradedLayer(thickness=1e-3, youngs_modulus=TABLE, poissons_ratio=0.4),
}


def scene_of(layer):
    return Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=1e-2), loading=ContactRadii([1e-3]))


def test_sublayers_and_interfaces_may_be_lists():
    assert LayerStack(sublayers=[TOP, LOWER], interfaces=["bonded"]) == STACK


@pytest.mark.parametrize("layer", LAYERS.values(), ids=LAYERS)
def test_other_units_change_moduli_and_lengths_only(layer):
    units = Units(length=2.0**10, stress=2.0**-20)
    other = in_units(scene_of(layer), units).layer
    assert other.thickness == 2.0**10 * layer.thickness
    assert other.contact_modulus == 2.0**-20 * layer.contact_modulus
    assert other.surface.poissons_ratio == layer.surface.poissons_ratio
    assert in_units(scene_of(other), Units(length=2.0**-10, stress=2.0**20)).layer == layer


def test_a_stack_of_one_is_the_layer():
    for support in ("bonded", "unbonded"):
        layer = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.3, support=support)
        one = Sublayer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.3)
        assert scene_of(LayerStack(sublayers=(one,), support=support)) == scene_of(layer)


def test_moduli_are_those_of_the_surface():
    assert STACK.contact_modulus == pytest.approx(1e6 / 0.75, rel=1e-15, abs=0.0)
    assert STACK.shear_modulus == pytest.approx(1e6 / 3.0, rel=1e-15, abs=0.0)
    assert STACK.thickness == pytest.approx(1e-3, rel=1e-15, abs=0.0)
    assert LAYERS["power law"].contact_modulus == pytest.approx(1e6 / 0.96, rel=1e-15, abs=0.0)
    assert not STACK.is_incompressible
    assert LayerStack(sublayers=(TOP, TOP), interfaces=("bonded",)).is_incompressible


@pytest.mark.parametrize(
    ("function", "middle", "slope"),
    [
        (ExponentialDepth(surface=1.0, base=4.0), 2.0, 2.0 * np.log(4.0) / 2.0),
        (LinearDepth(surface=1.0, base=4.0), 2.5, 1.5),
        (PowerLawDepth(surface=2.0, reference_depth=0.5, exponent=2.0), 18.0, 24.0),
        (TabulatedDepth(depths=[0.0, 1.0, 2.0], values=[1.0, 3.0, 5.0]), 3.0, 2.0),
    ],
)
def test_depth_functions_and_their_slopes(function, middle, slope):
    np.testing.assert_allclose(function.at(1.0, 2.0), middle, rtol=1e-14)
    np.testing.assert_allclose(function.slope(1.0, 2.0), slope, rtol=1e-14)
    scaled = function.scaled(2.0, 3.0)
    np.testing.assert_allclose(scaled.at(0.5, 1.0), middle / 3.0, rtol=1e-14)


REFUSED = {
    "as many interfaces as meet": (
        lambda: LayerStack(sublayers=(TOP, LOWER)),
        r"interfaces: 2 sublayers meet at 1 interfaces, got 0",
    ),
    "an unknown interface": (
        lambda: LayerStack(sublayers=(TOP, LOWER), interfaces=("glued",)),
        r"LayerStack\.interfaces\[0\] = 'glued'",
    ),
    "no sublayer": (lambda: LayerStack(sublayers=()), r"a stack has 1 to 1000, got 0"),
    "no modulus at the surface": (
        lambda: PowerLawDepth(surface=0.0, reference_depth=1.0, exponent=0.5),
        r"surface = 0\.0: must be positive and finite; a modulus of zero at the surface leaves no contact modulus",
    ),
    "no modulus at the surface of a table": (
        lambda: GradedLayer(
            thickness=1.0, youngs_modulus=TabulatedDepth(depths=[0.0, 1.0], values=[0.0, 1.0]), poissons_ratio=0.3
        ),
        r"entry 0 is 0; a modulus of zero at the surface leaves no contact modulus",
    ),
    "a table that ends too early": (
        lambda: GradedLayer(thickness=2e-3, youngs_modulus=TABLE, poissons_ratio=0.3),
        r"the table ends at z = 0\.001 m, above the base at 0\.002 m",
    ),
    "a table that begins below the surface": (
        lambda: TabulatedDepth(depths=[0.1, 1.0], values=[1.0, 1.0]),
        r"a table starts at the surface z = 0, got 0\.1",
    ),
    "a ratio beyond one half": (
        lambda: LAYERS["tabulated"].replace(poissons_ratio=RATIOS.replace(values=[0.2, 0.6])),
        r"GradedLayer\.poissons_ratio: must lie in \[0, 0\.5\], but the table holds 0\.6",
    ),
    "a viscoelastic model at odds with the surface": (
        lambda: scene_of(STACK).replace(effects=(KelvinVoigt(shear_modulus=1.0, viscosity=1.0),)),
        r"that of the layer, .* is 333333\.3333 Pa",
    ),
    "an unknown kind in a file": (
        lambda: scene_from_mapping({**scene_to_mapping(scene_of(STACK)), "layer": {"kind": "foam"}}),
        r"layer\.kind = 'foam': must be one of graded_layer, layer, layer_stack",
    ),
    "a bad sublayer in a file": (
        lambda: scene_from_mapping(
            {**scene_to_mapping(scene_of(STACK)), "layer": {"kind": "layer_stack", "sublayers": [{"thickness": -1.0}]}}
        ),
        r"layer\.sublayers\[0\]\.thickness = -1\.0: must be positive",
    ),
    "interfaces that are no list": (
        lambda: scene_from_mapping(
            {**scene_to_mapping(scene_of(STACK)), "layer": {"kind": "layer_stack", "interfaces": "bonded"}}
        ),
        r"layer\.interfaces = 'bonded': must be a list",
    ),
}


@pytest.mark.parametrize(("make", "message"), REFUSED.values(), ids=REFUSED)
def test_bad_layers_are_refused_by_name(make, message):
    with pytest.raises(InvalidInput, match=message):
        make()

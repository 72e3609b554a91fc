"""Fields inside by the direct integral equation, which shares no density with MDR."""

from __future__ import annotations

import numpy as np
import pytest

from bem.direct_method import IntegralEquationMethod
from contact import (
    Cone,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    LayerStack,
    Paraboloid,
    PowerLaw,
    Scene,
    Sphere,
    Sublayer,
    Tabulated,
    TruncatedCone,
)
from mdr import Mdr

NAMES = ("radial_stress", "hoop_stress", "axial_stress", "shear_stress", "hydrostatic_pressure")
HEIGHTS = np.linspace(0.0, 2.0, 9) ** 2 / 20.0
INDENTERS = [
    TruncatedCone(flat_radius=0.3, slope=0.1),
    Sphere(radius=1.02),
    PowerLaw(exponent=1.7, reference_radius=1.0, reference_height=0.1),
    Tabulated(radii=np.linspace(0.0, 2.0, 9), heights=HEIGHTS),
    Cone(slope=0.1),
    Paraboloid(radius_of_curvature=10.0),
    FlatPunch(radius=1.0),
]
STIFF_BELOW = LayerStack(
    sublayers=tuple(Sublayer(thickness=0.5, youngs_modulus=E, poissons_ratio=0.3) for E in (1.0, 10.0)),
    interfaces=("bonded",),
    support="bonded",
)
LAYERS = [
    Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5),
    Layer(thickness=0.2, youngs_modulus=1.0, poissons_ratio=0.3, support="unbonded"),
    Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3),
    STIFF_BELOW,
]


@pytest.mark.parametrize("layer", LAYERS, ids=["incompressible", "thin", "half-space", "stack"])
@pytest.mark.parametrize("indenter", INDENTERS, ids=lambda one: type(one).__name__)
def test_fields_are_those_of_mdr_within_the_stated_errors(layer, indenter):
    loading = IndentationDepths([1e-3]) if isinstance(indenter, FlatPunch) else ContactRadii([1.0])
    scene = Scene(layer=layer, indenter=indenter, loading=loading)
    direct, mdr = IntegralEquationMethod().solve(scene).inside(), Mdr().solve(scene).inside()
    draw = np.random.default_rng(4)
    deepest = min(layer.thickness, 2.0)
    r, z = draw.uniform(0.0, 1.5, 12), deepest * draw.uniform(0.0, 1.0, 12) ** 3
    found, exact = direct.at(r, z), mdr.at(r, z)
    largest = max(float(np.abs(getattr(exact, name)).max()) for name in NAMES)
    stated = found.error_estimate["stress"] + exact.error_estimate["stress"]
    assert stated < 1e-6
    for name in NAMES:
        assert np.abs(getattr(found, name) - getattr(exact, name)).max() <= stated * largest, name


def test_the_same_refusals():
    scene = Scene(layer=LAYERS[0], indenter=Cone(slope=0.1), loading=ContactRadii([1.0]))
    inside = IntegralEquationMethod().solve(scene).inside()
    with pytest.raises(InvalidInput, match="depth = 2: points must lie in the layer, between 0 and 1 m"):
        inside.at(0.0, 2.0)
    with pytest.raises(InvalidInput, match="stresses are infinite at this sharp rim"):
        inside.at(0.0, 0.0)
    worst, same = inside.largest("von_mises"), Mdr().solve(scene).inside().largest("von_mises")
    assert [worst.radius, worst.depth, worst.value] == pytest.approx(
        [same.radius, same.depth, same.value], rel=1e-6, abs=1e-7
    )


GRID_CONTACTS = {
    "bonded": (Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3), Paraboloid(radius_of_curvature=10.0), 0.0),
    "incompressible": (Layer(thickness=0.5, youngs_modulus=1.0, poissons_ratio=0.5), Cone(slope=0.1), 0.0),
    "kink": (Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3), INDENTERS[0], 0.0),
    "half-space": (LAYERS[2], Paraboloid(radius_of_curvature=10.0), 0.0),
    "punch": (Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5), FlatPunch(radius=1.0), 0.0),
    "adhering": (
        Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3),
        Paraboloid(radius_of_curvature=10.0),
        1e-4,
    ),
}

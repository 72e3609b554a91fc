"""Fields inside by the direct integral equation, which shares no density with MDR."""

from __future__ import annotations

import numpy as np
import pytest

from bem.direct_method import IntegralEquationMethod
from contact import (
    Cone,
    ContactRadii,
    FlatPunch,
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


def test_the_direct_equation_gives_no_fields_inside():
    scene = Scene(layer=LAYERS[0], indenter=Cone(slope=0.1), loading=ContactRadii([1.0]))
    with pytest.raises(InvalidInput, match="integral_equation gives no fields inside the body; ask mdr or fem"):
        IntegralEquationMethod().solve(scene).inside()


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

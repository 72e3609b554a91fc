"""Stresses at a depth that is the sum of thicknesses are the upper layer's, however the sum is rounded."""

import numpy as np
import pytest

from contact import ContactRadii, ElasticBase, LayerStack, Paraboloid, Scene, Sublayer
from mdr import Mdr


@pytest.mark.parametrize("thickness", [0.05, 0.59, 0.83])
@pytest.mark.parametrize("interface", ["bonded", "unbonded"])
def test_the_base_interface_is_the_upper_layers(thickness, interface):
    stack = LayerStack(
        sublayers=(
            Sublayer(thickness=thickness, youngs_modulus=2.0, poissons_ratio=0.3),
            Sublayer(thickness=1.0 - thickness, youngs_modulus=1.0, poissons_ratio=0.4),
        ),
        interfaces=("bonded",),
        support=ElasticBase(youngs_modulus=0.2, poissons_ratio=0.2, interface=interface),
    )
    scene = Scene(layer=stack, indenter=Paraboloid(radius_of_curvature=1.0), loading=ContactRadii([0.8]))
    inside = Mdr().solve(scene).inside()
    above, at = inside.at(0.4, 1.0 - 1e-9), inside.at(0.4, 1.0)
    for name in ("radial_stress", "hoop_stress", "axial_stress", "shear_stress", "radial_displacement"):
        scale = float(np.abs(above.hoop_stress) + np.abs(above.axial_stress))
        assert float(getattr(at, name)) == pytest.approx(float(getattr(above, name)), rel=0.0, abs=1e-7 * scale), name

"""The limits a/h -> 0 and a/h -> infinity of section 2.1, each with the order in which it is approached."""

import numpy as np
import pytest

from contact import Cone, InvalidInput, Layer, TruncatedCone
from docs.gallery._thin_layers import thin_cone_force, thin_cone_pressure, thin_cone_profile, thin_profile

LAYERS = {
    "unbonded": Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3, support="unbonded"),
    "bonded 0.3": Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3),
    "bonded 0.45": Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.45),
    "bonded 0.5": Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5),
}


@pytest.mark.parametrize("name", LAYERS)
def test_thin_cone_pressure_carries_the_thin_cone_force(name):
    """2 pi int p r dr of Eq. (39) is Eq. (38); likewise Eqs. (17), (22) and (36)."""
    layer, cone, a = LAYERS[name], TruncatedCone(flat_radius=3.0, slope=0.1), 5.0
    x, w = np.polynomial.legendre.leggauss(40)
    force = 0.0
    for low, high in [(0.0, 3.0), (3.0, 5.0)]:
        r = (low + high) / 2 + (high - low) / 2 * x
        force += np.sum(2 * np.pi * r * thin_cone_pressure(layer, cone, a, r) * w) * (high - low) / 2
    assert force == pytest.approx(float(thin_cone_force(layer, cone, a)), rel=1e-13, abs=0.0)


def test_mean_height_agrees_with_the_closed_form_of_the_cone():
    """Eq. (20) integrated against Eq. (37)."""
    layer, cone = LAYERS["bonded 0.5"], TruncatedCone(flat_radius=3.0, slope=0.1)
    x = np.array([3.5, 5.0, 50.0])
    np.testing.assert_allclose(thin_profile(layer, cone, x), thin_cone_profile(layer, cone, x), rtol=1e-13)


def test_a_half_space_has_no_thin_limit():
    half_space = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.3)
    with pytest.raises(InvalidInput, match="thickness = inf"):
        thin_profile(half_space, Cone(slope=0.1), 1.0)

"""Coated pairs: Eqs. (23) to (25), and the error of unequal thickness."""

import numpy as np
import pytest

from contact import CoatedPair, ContactRadii, InvalidInput, Layer, Paraboloid, Scene
from mdr import Mdr
from tests.coated_pairs import mean_thickness_error, pair_springs


def pair(first, second, *, nu=0.5, support="bonded", radii=(1e-3,)):
    return CoatedPair(
        first_radius=20e-3,
        second_radius=30e-3,
        first_thickness=first,
        second_thickness=second,
        youngs_modulus=1e6,
        poissons_ratio=nu,
        support=support,
        loading=ContactRadii(list(radii)),
    )


def test_equal_coatings_are_one_layer_of_half_the_modulus():
    path = Mdr().solve(pair(1e-3, 1e-3).scene())
    layer = Layer(thickness=1e-3, youngs_modulus=0.5e6, poissons_ratio=0.5)  # Eq. (24)
    indenter = Paraboloid(radius_of_curvature=12e-3)  # Eq. (23): 1/20 + 1/30 = 1/12
    single = Mdr().solve(Scene(layer=layer, indenter=indenter, loading=ContactRadii([1e-3])))
    assert path.normal_force[0] == pytest.approx(single.normal_force[0], rel=1e-13, abs=0.0)
    exact = pair_springs(pair(1e-3, 1e-3)).states(np.array([1e-3]))
    assert exact.force == pytest.approx(path.normal_force, rel=1e-12, abs=0.0)


@pytest.mark.parametrize(("support", "nu"), [("bonded", 0.5), ("bonded", 0.3), ("unbonded", 0.3)])
def test_the_error_is_quadratic_in_the_difference(support, nu):
    radii = np.array([0.5e-3, 1e-3, 2e-3])
    errors = [
        mean_thickness_error(pair(1e-3 * (1.0 - d), 1e-3 * (1.0 + d), nu=nu, support=support), radii)
        for d in (0.05, 0.1)
    ]
    for name in ("contact_stiffness", "indentation_depth", "normal_force"):
        small, large = (getattr(e, name) for e in errors)
        np.testing.assert_allclose(large / small, 4.0, rtol=0.05)
        assert np.abs(large).max() < 0.05


def test_thin_incompressible_coatings_do_not():
    """k_N goes as 1/h^3, so compliances add as h_1^3 + h_2^3: Eq. (25) overestimates k by 1 + 3 d^2 - 1."""
    d = 0.1
    unequal = pair(1e-3 * (1.0 - d), 1e-3 * (1.0 + d))
    error = mean_thickness_error(unequal, np.array([40e-3])).contact_stiffness[0]
    assert error == pytest.approx(3.0 * d**2, rel=0.15, abs=0.0)


def test_hopelessly_unequal_coatings_are_refused():
    with pytest.raises(InvalidInput, match="thinner coating"):
        pair_springs(pair(1e-6, 1e-3))

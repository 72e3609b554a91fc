"""The numbers that `docs/theory.md` computes by hand, beside the solution with all polynomials."""

import numpy as np
import pytest
from scipy.integrate import quad

from contact import ContactRadii, Layer, Paraboloid, Scene
from mdr import Mdr

RATIO = 0.2


def chi(q):
    """Eq. (31) at nu = 1/2, kappa = 1."""
    return (2 * np.sinh(2 * q) - 4 * q) / (2 + 4 * q**2 + 2 * np.cosh(2 * q))


ALPHA = 2 / np.pi * quad(lambda q: 1 - chi(q), 0, 40, limit=200)[0]


@pytest.fixture(scope="module")
def path():
    layer = Layer(thickness=1.0, youngs_modulus=0.75, poissons_ratio=0.5, support="bonded")
    return Mdr().solve(Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=1.0), loading=ContactRadii([RATIO])))


def test_the_first_polynomial_gives_stiffness_depth_and_force(path):
    assert pytest.approx(1.126955, abs=1e-6, rel=0.0) == ALPHA
    assert f"{1 / (1 - ALPHA * RATIO):.3f}" == "1.291"
    depth = RATIO**2 * (1 - 2 / 3 * ALPHA * RATIO)
    force = 2 * RATIO / (1 - ALPHA * RATIO) * (depth - RATIO**2 / 3)
    assert f"{depth:.4f}, {force:.5f}" == "0.0340, 0.01067"
    assert path.contact_stiffness[0] / (2 * RATIO) == pytest.approx(1.28063660581, rel=1e-11, abs=0.0)
    assert f"{path.indentation_depth[0]:.6f}, {path.normal_force[0]:.6f}" == "0.034253, 0.010733"

"""The first order of the force in the coefficient of friction against quadrature over pressure and slip."""

import numpy as np
import pytest

from contact import (
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    Layer,
    Scene,
    TruncatedCone,
)
from mdr import Mdr
from mdr.friction.statement import friction_effect


@pytest.mark.parametrize("nu", [0.0, 0.5])
def test_the_first_order_under_a_truncated_cone_is_the_integral_over_pressure_and_slip(nu):
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu)
    worn = Scene(layer=layer, indenter=TruncatedCone(flat_radius=0.5, slope=0.1), loading=ContactRadii([1.0]))
    path = Mdr().solve(worn)
    punch = Mdr().solve(Scene(layer=layer, indenter=FlatPunch(radius=1.0), loading=IndentationDepths([1.0]))).inside()
    # r = sin(angle); between the kink and the ends nodes crowd towards both, as the pressure is logarithmic there.
    u, weights = np.polynomial.legendre.leggauss(60)
    u, weights = (1.0 + u) / 2.0, weights / 2.0
    total = 0.0
    for low, high in ((0.0, np.arcsin(0.5)), (np.arcsin(0.5), np.pi / 2.0)):
        angle = low + (high - low) * u**2 * (3.0 - 2.0 * u)
        step = (high - low) * 6.0 * u * (1.0 - u) * weights
        radius = np.minimum(np.sin(angle), 1.0 - 1e-9)
        slip = punch.at(radius, np.zeros_like(angle)).radial_displacement
        total += np.sum(step * np.cos(angle) * 2.0 * np.pi * radius * path.pressure(radius, 0) * slip)
    exact = 0.3 * abs(total) / path.normal_force[0]
    assert friction_effect(path, 0.3).first_order[0] == pytest.approx(exact, rel=1e-6, abs=0.0)

"""Truncated cone, b = a/2, on thick and thin layers: every number within its stated error of the integral equation."""

from __future__ import annotations

import numpy as np
import pytest

from contact import ContactRadii, Layer, Scene, TruncatedCone
from fem_reference import Fem
from tests.fem_reference.integral_equation import gauss, smooth_pressure, solve_contact, truncated_cone

SLOPE = 0.1
LAYERS = [("unbonded", 0.3), ("bonded", 0.3), ("bonded", 0.45), ("bonded", 0.5)]


def solve(method, ratio, support, nu):
    layer = Layer(thickness=1.0, youngs_modulus=1 - nu**2, poissons_ratio=nu, support=support)
    indenter = TruncatedCone(flat_radius=ratio / 2, slope=SLOPE)
    return method.solve(Scene(layer=layer, indenter=indenter, loading=ContactRadii([ratio])))


def pressure_errors(path, ratio, support, nu):
    """Relative 2 pi r-weighted L2 error, and the relative error of the load of rings around the kink."""
    b = ratio / 2
    r, w = gauss(np.unique(np.concatenate([b - b * np.geomspace(1e-4, 1, 8), b + b * np.geomspace(1e-4, 1, 8)])), 8)
    exact, weight = SLOPE * smooth_pressure(ratio, r, support, nu, b), 2 * np.pi * r * w
    difference = path.pressure(r) - exact
    norm = np.sqrt(weight @ difference**2 / (weight @ exact**2))
    near = np.abs(r - b) < 0.1 * b
    ring = abs(weight[near] @ difference[near]) / (weight[near] @ exact[near])
    return norm, ring


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.1, 1, 2, 5, 20])
@pytest.mark.parametrize(("support", "nu"), LAYERS)
def test_within_1e_5_and_the_stated_error(ratio, support, nu):
    path = solve(Fem(), ratio, support, nu)
    exact = solve_contact(ratio, support, nu, truncated_cone(ratio / 2), ratio / 2)
    for quantity, value in {
        "indentation_depth": SLOPE * exact.depth,
        "normal_force": SLOPE * exact.force,
        "contact_stiffness": exact.stiffness,
    }.items():
        error = abs(getattr(path, quantity)[0] / value - 1)
        assert error <= path.error_estimate[quantity][0], quantity
        assert error < 1e-5, quantity
    norm, ring = pressure_errors(path, ratio, support, nu)
    assert norm <= path.error_estimate["pressure"][0] < 2e-3
    assert ring < 2e-3


def test_pressure_of_one():
    path = solve(Fem(growth=0.7), 1, "bonded", 0.5)
    norm, ring = pressure_errors(path, 1, "bonded", 0.5)
    assert norm <= path.error_estimate["pressure"][0] < 2e-3
    assert ring < 2e-3

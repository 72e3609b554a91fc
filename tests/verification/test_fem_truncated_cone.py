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
    r, w = gauss(np.unique(np.concatenate([b - b * np.geomspace(1e-8, 1, 20), b + b * np.geomspace(1e-8, 1, 20)])), 8)
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
    assert norm <= path.error_estimate["pressure"][0] < min(2e-3, 20 * norm)
    assert ring < 2e-3


def half_space_pressure(r, b):
    """Contact radius and slope one: p = (E*/pi) int_max(r,b)^1 [arccos(b/x) + b/sqrt(x^2-b^2)] / sqrt(x^2-r^2) dx."""
    s, w = gauss(np.concatenate([[0.0], np.geomspace(1e-5, 1, 24)]), 12)
    low = np.maximum(r, b)[:, None]
    rise = (1 - low) * s**2  # x = low + rise removes the roots at r and b
    x = low + rise
    root = np.sqrt(((low - b) + rise) * (x + b))
    integrand = (np.arctan2(root, b) + b / root) / np.sqrt(((low - r[:, None]) + rise) * (x + r[:, None]))
    return np.sum(2 * (1 - low) * s * w * integrand, axis=1) / np.pi


@pytest.mark.parametrize("b", [0.25, pytest.param(0.75, marks=pytest.mark.slow)])
def test_pressure_on_the_half_space(b):
    """A wider flat end is slow."""
    layer = Layer.half_space(youngs_modulus=0.91, poissons_ratio=0.3)  # E* = 1
    scene = Scene(layer=layer, indenter=TruncatedCone(flat_radius=b, slope=1.0), loading=ContactRadii([1.0]))
    path = Fem().solve(scene)
    width = min(b, 1 - b) * np.geomspace(1e-8, 1, 20)
    r, w = gauss(np.unique(np.concatenate([[0.0], b - width, b + width, [1.0]])), 8)
    exact, weight = half_space_pressure(r, b), r * w
    norm = np.sqrt(weight @ (path.pressure(r) - exact) ** 2 / (weight @ exact**2))
    assert norm <= path.error_estimate["pressure"][0] < min(2e-3, 20 * norm)


def test_pressure_of_one():
    path = solve(Fem(growth=0.7), 1, "bonded", 0.5)
    norm, ring = pressure_errors(path, 1, "bonded", 0.5)
    assert norm <= path.error_estimate["pressure"][0] < 2e-3
    assert ring < 2e-3

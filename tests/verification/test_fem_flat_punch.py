"""Flat-punch stiffness from thick to thin layers and from nu = 0 to exactly 1/2, against the integral equation."""

from __future__ import annotations

import numpy as np
import pytest

from contact import FlatPunch, IndentationDepths, Layer, Scene, StageLog
from contact.stated import SAFETY
from fem_reference import Fem
from fem_reference.prescribed_contact import solve_contact
from tests.fem_reference.integral_equation import solve_contact as solve_exactly

RATIOS = (0.05, 0.2, 1, 2, 5, 10, 50)
LAYERS = [("bonded", nu) for nu in (0.0, 0.3, 0.45, 0.49, 0.499, 0.5)] + [("unbonded", 0.3)]


def errors(method, ratio, support, nu):
    """True relative errors of k_N and k_N', and what coarser cells change of them."""
    layer = Layer(thickness=1.0, youngs_modulus=1 - nu**2, poissons_ratio=nu, support=support)
    scene = Scene(layer=layer, indenter=FlatPunch(radius=ratio), loading=IndentationDepths([1.0]))
    exact, settings = solve_exactly(ratio, support, nu), method.discretisation
    fine, coarse = (
        np.array([contact.stiffness * ratio / exact.stiffness, contact.stiffness_slope / exact.stiffness_slope])
        for contact in (solve_contact(scene, ratio, each, StageLog()) for each in (settings, settings.coarser()))
    )
    return np.abs(fine - 1), SAFETY * np.abs(fine - coarse)


@pytest.mark.slow
@pytest.mark.parametrize("ratio", RATIOS)
@pytest.mark.parametrize(("support", "nu"), LAYERS)
def test_stiffness_within_1e_6_and_its_own_error_bar(ratio, support, nu):
    true, stated = errors(Fem(accuracy=2e-6), ratio, support, nu)
    assert true[0] < 1e-6
    assert true[1] < 2e-6
    assert np.all(true <= stated)


@pytest.mark.parametrize(("support", "nu"), [("bonded", 0.0), ("bonded", 0.499), ("unbonded", 0.3)])
def test_stiffness_of_a_few(support, nu):
    true, stated = errors(Fem(growth=0.7), 2, support, nu)
    assert np.all(true <= stated)
    assert stated[0] <= 1e-3


def test_incompressible_is_as_accurate_as_compressible_on_the_same_settings():
    method = Fem(growth=0.7, edge_cell=1e-6)
    incompressible, compressible = (errors(method, 1, "bonded", nu)[0][0] for nu in (0.5, 0.3))
    assert incompressible < 5 * compressible < 1e-4

"""Pressures under flat punches against the equation in extended precision."""

import numpy as np
import pytest
from mpmath import mp

from benchmarks.references.layer_equation import DIGITS, pressure
from contact import Layer
from docs.gallery._flat_punch import FlatPunchValues


@pytest.mark.slow
def test_pressures_are_right_within_the_condition_of_the_equation():
    """Beside r = h 18 roundings times k_bar were lost, where slopes were taken at the end of a panel."""
    ratio, nu = 2.3, 0.45
    rho = np.array([0.3, 0.99, 1.01, 2.02]) / ratio
    with mp.workdps(DIGITS):
        exact = [float(value) for value in pressure(repr(ratio), repr(nu), 20, [repr(r) for r in rho.tolist()])]
    solution = FlatPunchValues(Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu))
    found = solution.smooth_pressure(rho, ratio) / np.sqrt((1 - rho) * (1 + rho))
    roundings = np.abs(found / exact - 1) / np.finfo(float).eps
    assert roundings.max() <= 10 * solution.normalized_contact_stiffness(ratio)

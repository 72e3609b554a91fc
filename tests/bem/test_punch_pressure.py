"""Pressures under flat punches against extended precision."""

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from contact import Layer
from tests.bem.extended_precision import LD, PI, flat_punch_pressure

SCENES = [("bonded", 0.4279325584398982, 5.74596268), ("bonded", 0.45, 2.3)]


@pytest.mark.skipif(np.finfo(LD).eps > 1e-18, reason="extended precision is double precision here")
@pytest.mark.parametrize(("support", "nu", "ratio"), SCENES)
def test_pressures_are_right_within_the_condition_of_the_equation(support, nu, ratio):
    """Seen to fail: 18 and 14 roundings times k_bar beside r = h, where slopes were taken at the end of a panel."""
    solution = IntegralEquation().punch(Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=nu, support=support))
    # On both sides of the ends of panels.
    rho = np.array([0.3, 0.93, 0.95, 0.966, 0.9734, 0.99, 1.01, 1.97, 2.02]) / ratio
    k = solution.normalized_contact_stiffness(ratio)
    found = 2 * k * solution.smooth_pressure(rho, ratio) / PI
    expected = flat_punch_pressure(support, nu, ratio, rho.astype(LD)) * np.sqrt((1 - rho) * (1 + rho))
    roundings = np.abs(found / expected - 1) / np.finfo(float).eps
    assert roundings.max() <= 10 * k

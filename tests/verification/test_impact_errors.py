"""Stated errors of impacts whose two runs agree by chance: they must cover the true ones all the same."""

from __future__ import annotations

import numpy as np
import pytest

from bem.layer_equation.flat_punch_source import IntegralEquation
from cases.declare.quantities import IMPACT_NUMBERS
from cases.measurements.campaigns.random_scenes import random_scenes
from mdr.impact.solver import impact_batch

PUNCH = IntegralEquation()


def outcome(scene, accuracy):
    found = impact_batch([scene], PUNCH, accuracy=accuracy)
    return np.array([getattr(found, name)[0] for name in IMPACT_NUMBERS]), found.relative_error[:, 0]


# Of seed 9 these are the scenes in which both runs miss the truth alike: by up to 7 times their difference.
@pytest.mark.parametrize(
    ("number", "accuracy"), [(23, 1e-5), (65, 1e-5), (86, 1e-5), (11, 1e-6), (24, 1e-6), (48, 1e-6), (40, 1e-9)]
)
def test_two_runs_that_agree_by_chance_still_state_an_error(number, accuracy):
    """Fails without the floor under stated errors: three tenths of the accuracy asked for."""
    scene = random_scenes(9, number + 1, "impact", (1e-2, 5.0))[number]
    truth, own = outcome(scene, 1e-12)
    values, stated = outcome(scene, accuracy)
    assert np.all(np.abs(values / truth - 1.0) <= stated + own)

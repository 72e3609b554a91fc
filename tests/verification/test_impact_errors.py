"""Stated errors of impacts whose two runs agree by chance: they must cover the true ones all the same."""

from __future__ import annotations

import math

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from cases.declare.quantities import IMPACT_NUMBERS
from contact import Impact, Layer, PowerLaw, Scene
from mdr.batches import impacts
from tests.drawn_scenes import scene_of

PUNCH = IntegralEquation()


def outcome(scene, accuracy):
    found = impacts([scene], PUNCH, accuracy=accuracy)
    return np.array([getattr(found, name)[0] for name in IMPACT_NUMBERS]), found.relative_error[:, 0]


# Of seed 9 these are the scenes in which both runs miss the truth alike: by up to 68 times what they tell.
@pytest.mark.first(1)
@pytest.mark.parametrize(("number", "accuracy"), [(39, 1e-5), (28, 1e-6), (8, 1e-9)])
def test_two_runs_that_agree_by_chance_still_state_an_error(number, accuracy):
    """Fails without the floor under stated errors: three tenths of the accuracy asked for."""
    scene = scene_of(9, number)
    truth, own = outcome(scene, 1e-12)
    values, stated = outcome(scene, accuracy)
    assert np.all(np.abs(values / truth - 1.0) <= stated + own)


@pytest.mark.parametrize("power", [1.1, 1.7, 4.147])
@pytest.mark.parametrize("accuracy", [1e-6, 1e-8])
def test_contact_times_of_tips_whose_power_is_no_integer(power, accuracy):
    """On the half-space, in closed form: T = 2 sqrt(pi) Gamma(1 + 1/q) / Gamma(1/2 + 1/q) d/v0 with q = 2 + 1/p.

    Time integrated along with the front, the integral of dg/dy, was 5.9e-6 off at p = 1.7, 2.3e-6 stated.
    """
    half_space = Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.5)
    tip = PowerLaw(exponent=power, reference_radius=1e-3, reference_height=1e-4)
    scene = Scene(layer=half_space, indenter=tip, loading=Impact(mass=1e-3, velocity=1.0))
    found = impacts([scene], PUNCH, accuracy=accuracy)
    share = 1.0 / (2.0 + 1.0 / power)
    exact = 2.0 * math.sqrt(math.pi) * math.gamma(1.0 + share) / math.gamma(0.5 + share) * found.peak_depth[0]
    error = abs(found.contact_time[0] / exact - 1.0)
    assert error <= found.relative_error[1, 0] + found.relative_error[3, 0]
    assert error <= 0.25 * accuracy


@pytest.mark.parametrize("power", [4.146969196385718])
def test_contact_times_of_steep_tips_on_thin_incompressible_layers(power):
    """Time integrated along with the front was 2.6e-10 off at the second power, 1.6e-10 stated."""
    layer = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.5, support="bonded")
    tip = PowerLaw(exponent=power, reference_radius=3e-2, reference_height=1e-3)
    scene = Scene(layer=layer, indenter=tip, loading=Impact(mass=1.0, velocity=1.0))
    truth, own = outcome(scene, 1e-12)
    values, stated = outcome(scene, 1e-9)
    error = np.abs(values / truth - 1.0)
    assert np.all(error <= stated + own)
    assert error[1] <= 2e-10

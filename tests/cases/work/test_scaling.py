"""Exponents: a planted one is found with its interval, and growth faster than theory fails."""

import dataclasses

import numpy as np
import pytest

from cases.status import Status
from cases.work.scaling import PLANS, exponent_of, fitted, grows_no_faster
from contact import InvalidInput


@pytest.mark.parametrize("power", [0.0, 1.0, 2.5])
def test_a_planted_exponent_is_found_beyond_fixed_costs(power):
    sizes = 2.0 ** np.arange(12)
    noise = np.exp(0.02 * np.random.default_rng(3).normal(size=12))
    exponent, half_width = exponent_of(sizes, (1e-4 + 1e-3 * sizes**power) * noise)
    assert abs(exponent - power) <= max(half_width, 0.03)
    assert 0.0 < half_width < 0.1


def test_too_few_sizes_have_no_interval():
    with pytest.raises(InvalidInput, match="at least 5"):
        exponent_of(np.array([1.0, 2.0, 4.0]), np.array([1.0, 2.0, 4.0]))


def test_growth_faster_than_in_theory_fails():
    plan = dataclasses.replace(PLANS[1], sizes=(64, 128, 256, 512, 1024))
    fit = fitted(plan)
    assert len(fit.seconds) == 5
    assert grows_no_faster(dataclasses.replace(fit, exponent=0.9, half_width=0.2)).status is Status.PASS
    assert grows_no_faster(dataclasses.replace(fit, exponent=1.5, half_width=0.2)).status is Status.FAIL

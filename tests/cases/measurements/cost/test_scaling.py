"""Exponents: a planted one is found with its interval, and growth faster than theory fails."""

import dataclasses

import numpy as np
import pytest

from cases.measurements.cost.scaling import PLANS, counter_exponents, exponent_of, fitted, grows_no_faster
from cases.results.status import Status
from contact import Cost, InvalidInput


@pytest.mark.parametrize("power", [1.0, 2.5])
@pytest.mark.parametrize("fixed", [1e-4, 1.0])
def test_a_planted_exponent_is_found_beyond_fixed_costs(power, fixed):
    sizes = 2.0 ** np.arange(12)
    noise = np.exp(np.abs(0.05 * np.random.default_rng(3).normal(size=(7, 12))))
    exponent, half_width = exponent_of(sizes, (fixed + 1e-3 * sizes**power) * noise)
    assert abs(exponent - power) <= max(half_width, 0.03)
    assert 0.0 < half_width < 0.15


def test_seconds_that_do_not_grow_have_the_exponent_zero():
    noise = np.exp(np.abs(0.05 * np.random.default_rng(3).normal(size=(7, 12))))
    exponent, half_width = exponent_of(2.0 ** np.arange(12), noise)
    assert abs(exponent) < 0.02
    assert half_width < 0.05


def test_too_few_sizes_have_no_interval():
    with pytest.raises(InvalidInput, match="at least 5"):
        exponent_of(np.array([1.0, 2.0, 4.0]), np.ones((7, 3)))


def test_counters_have_exponents_without_noise():
    sizes = np.array([1.0, 2.0, 4.0, 8.0, 16.0])
    costs = [
        Cost(wall_seconds=1.0, cpu_seconds=1.0, peak_memory_bytes=1, unknowns=int(3 * n**2), counters={"steps": 7})
        for n in sizes
    ]
    assert counter_exponents(sizes, costs) == pytest.approx({"unknowns": 2.0}, rel=1e-12, abs=0.0)


def test_growth_faster_than_in_theory_fails():
    plan = next(plan for plan in PLANS if plan.size == "number of radii")
    plan = dataclasses.replace(plan, sizes=(64, 128, 256, 512, 1024))
    fit = fitted(plan)
    assert len(fit.seconds) == 5
    assert fit.counters == {}  # the same unknowns whatever the number of radii
    assert grows_no_faster(dataclasses.replace(fit, exponent=0.9, half_width=0.2)).status is Status.PASS
    assert grows_no_faster(dataclasses.replace(fit, exponent=1.5, half_width=0.2)).status is Status.FAIL


def test_the_plans_of_contact_width_cover_five_decades():
    """From a/h = 1e-2 to 1e3, the largest ratio that is covered."""
    sizes = [size for plan in PLANS if plan.method == "mdr" and plan.size.startswith("a/h") for size in plan.sizes]
    assert (min(sizes), max(sizes)) == (1e-2, 1e3)
    assert sorted(sizes) == sizes

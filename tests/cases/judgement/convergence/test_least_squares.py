import math

import numpy as np
import pytest

from cases.judgement.convergence.least_squares import fit
from contact import InvalidInput

LENGTHS = np.array([1.0, 1.5, 2.0, 3.0, 4.0])


@pytest.mark.parametrize(("order", "formal"), [(1.0, 1.0), (2.0, 2.0), (1.5, 2.0), (3.0, 3.0)])
def test_an_exact_power_law_is_recovered(order, formal):
    fitted = fit(2.5 + 1e-3 * LENGTHS**order, LENGTHS, formal)
    assert fitted.order == pytest.approx(order, abs=1e-6)
    assert fitted.limit == pytest.approx(2.5, abs=1e-9)
    assert fitted.deviation < 1e-9


def test_the_uncertainty_of_an_exact_law_is_its_error_times_the_safety_factor():
    fitted = fit(2.5 + 1e-3 * LENGTHS**2, LENGTHS, 2.0)
    assert fitted.uncertainty == pytest.approx(1.25e-3, rel=1e-5, abs=0.0)


def test_the_uncertainty_covers_the_error_of_noisy_data():
    noise = np.random.default_rng(7)
    covered = 0
    for _ in range(100):
        values = 1.0 + 1e-2 * LENGTHS + 1e-3 * noise.standard_normal(5)
        fitted = fit(values, LENGTHS, 1.0)
        covered += abs(values[0] - 1.0) <= fitted.uncertainty
    assert covered >= 90  # the procedure aims at 95 %


def test_an_order_above_the_formal_one_falls_back_on_fixed_exponents():
    fitted = fit(1.0 + 1e-3 * LENGTHS**4, LENGTHS, 2.0)
    assert fitted.observed_order == pytest.approx(4.0, abs=1e-4)
    assert fitted.order == 2.0
    assert fitted.uncertainty > 1e-3


def test_scatter_raises_the_uncertainty():
    smooth = fit(1.0 + 1e-2 * LENGTHS, LENGTHS, 1.0)
    scattered = fit(1.0 + 1e-2 * LENGTHS * np.array([1, -1, 1, -1, 1]), LENGTHS, 1.0)
    assert scattered.uncertainty > 3 * smooth.uncertainty


def test_three_grids_are_too_few():
    with pytest.raises(InvalidInput, match="four"):
        fit([1.0, 1.1, 1.2], [1, 2, 4], 1.0)


def test_nan_is_refused():
    with pytest.raises(InvalidInput, match="finite"):
        fit([1.0, math.nan, 1.2, 1.4], [1, 2, 4, 8], 1.0)


def test_the_level_of_the_values_costs_no_digits():
    """Adding 1e6 to values whose differences are 1e-3 must leave the order alone (to the digits that remain)."""
    fitted = fit(1e6 + 1e-3 * LENGTHS**1.3, LENGTHS, 2.0)
    assert fitted.order == pytest.approx(1.3, abs=1e-5)

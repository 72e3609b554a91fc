"""Oracles: Celik et al. 2008, J. Fluids Eng. 130, 078001, table of sample calculations; NASA NPARC tutorial on GCI."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cases.judgement.convergence.extrapolation import extrapolated, grid_convergence_index, safety_factor
from cases.judgement.convergence.observed_order import observed_order, order_is_accepted
from contact import InvalidInput

NASA = (0.97050, 0.96854, 0.96178)


def lengths_of(cells: tuple[int, ...]) -> list[float]:
    """Cell sizes of two-dimensional grids."""
    return [n**-0.5 for n in cells]


@pytest.mark.parametrize(
    ("cells", "values", "order", "gci_percent"),
    [
        ((18000, 8000, 4500), (6.063, 5.972, 5.863), 1.534, 2.17),
        ((18000, 4500, 980), (10.788, 10.725, 10.605), 0.752, 1.07),
        ((18000, 4500, 980), (6.0042, 5.9624, 6.0909), 1.508, 0.47),  # oscillatory
    ],
)
def test_celik_et_al_table(cells, values, order, gci_percent):
    lengths = lengths_of(cells)
    p = observed_order(values, lengths)
    gci = grid_convergence_index(values[0], values[1], lengths[1] / lengths[0], p, safety=1.25, scale=0.0)
    assert p == pytest.approx(order, abs=5e-4)
    assert 100 * gci == pytest.approx(gci_percent, abs=5e-3)


def test_celik_et_al_extrapolated_value():
    lengths = lengths_of((18000, 8000, 4500))
    values = (6.063, 5.972, 5.863)
    p = observed_order(values, lengths)
    assert extrapolated(values[0], values[1], lengths[1] / lengths[0], p) == pytest.approx(6.1685, abs=5e-5)


def test_nasa_tutorial():
    p = observed_order(NASA, (1, 2, 4))
    assert p == pytest.approx(1.78617, abs=1e-5)
    assert extrapolated(NASA[0], NASA[1], 2, p) == pytest.approx(0.9713003, abs=1e-7)
    fine = grid_convergence_index(NASA[0], NASA[1], 2, p, safety=1.25, scale=0.0)
    coarse = grid_convergence_index(NASA[1], NASA[2], 2, p, safety=1.25, scale=0.0)
    assert 100 * fine == pytest.approx(0.10308, abs=1e-5)
    assert 100 * coarse == pytest.approx(0.35625, abs=2e-5)


@given(
    st.floats(0.5, 4.0),
    st.floats(1.1, 3.0),
    st.floats(1.1, 3.0),
    st.floats(0.1, 10.0),
)
def test_a_pure_power_law_returns_its_order_at_any_two_ratios(order, r21, r32, constant):
    lengths = (1.0, r21, r21 * r32)
    values = [constant * h**order for h in lengths]
    assert observed_order(values, lengths) == pytest.approx(order, rel=1e-7, abs=0.0)


def test_equal_values_have_no_order():
    with pytest.raises(InvalidInput, match="equal"):
        observed_order((1.0, 1.0, 2.0), (1, 2, 4))


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_non_finite_value_is_refused(bad):
    with pytest.raises(InvalidInput, match="finite"):
        observed_order((1.0, bad, 2.0), (1, 2, 4))


def test_lengths_from_coarse_to_fine_are_refused():
    with pytest.raises(InvalidInput, match="finest first"):
        observed_order(NASA, (4, 2, 1))


@pytest.mark.parametrize("observed", [math.nan, math.inf, 75.9, 0.79, 1.51, -1.0, None])
def test_orders_outside_the_band_are_refused(observed):
    assert not order_is_accepted(observed, 1.0)


@pytest.mark.parametrize("observed", [0.8, 1.0, 1.5])
def test_orders_inside_the_band_are_accepted(observed):
    assert order_is_accepted(observed, 1.0)


def test_safety_factor_trusts_the_formal_order_only_within_ten_percent():
    assert safety_factor(1.95, 2.0) == (1.25, 2.0)
    assert safety_factor(1.7, 2.0) == (3.0, 1.7)
    assert safety_factor(0.2, 2.0) == (3.0, 0.5)
    assert safety_factor(3.0, 2.0) == (3.0, 2.0)


def test_a_zero_crossing_does_not_blow_up_the_index():
    at_zero = grid_convergence_index(1e-12, 2e-6, 2.0, 1.0, safety=1.25, scale=1.0)
    assert at_zero == pytest.approx(1.25 * 2e-6, rel=1e-5, abs=0.0)


def test_growing_differences_have_a_negative_order():
    """With the modulus of the textbook formula this diverging sequence would be reported as second order."""
    assert observed_order((1.0, 5.0, 6.0), (1, 2, 4)) == pytest.approx(-2.0, rel=1e-12, abs=0.0)

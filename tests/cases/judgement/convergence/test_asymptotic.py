import pytest

from cases.judgement.convergence.asymptotic import differences_follow_order, is_asymptotic, orders_are_stable
from cases.judgement.convergence.extrapolation import grid_convergence_index
from cases.judgement.convergence.observed_order import observed_order

LENGTHS = (1.0, 2.0, 4.0, 8.0)


def values_of(order: float, pollution: float = 0.0) -> list[float]:
    return [1.0 + 0.01 * h**order + pollution * h ** (order + 2) for h in LENGTHS]


def test_the_textbook_ratio_is_an_identity_and_therefore_not_used():
    """GCI32/(r^p GCI21) = |f1/f2| even for numbers with no trend at all: it can only pass."""
    values = (1.0, 1.02, 0.5)
    p = observed_order(values, LENGTHS[:3])
    fine = grid_convergence_index(values[0], values[1], 2, p, safety=1.25, scale=0.0)
    coarse = grid_convergence_index(values[1], values[2], 2, p, safety=1.25, scale=0.0)
    assert coarse / (2**p * fine) == pytest.approx(abs(values[0] / values[1]), rel=1e-12, abs=0.0)


@pytest.mark.parametrize("order", [1.0, 2.0, 3.0])
def test_a_power_law_is_asymptotic(order):
    assert orders_are_stable(values_of(order), LENGTHS, order)
    assert differences_follow_order(values_of(order), 2.0, order)
    assert is_asymptotic(values_of(order), LENGTHS, order)


def test_a_polluted_sequence_is_not():
    assert not orders_are_stable(values_of(1.0, pollution=0.01), LENGTHS, 1.0)
    assert not differences_follow_order(values_of(1.0, pollution=0.01), 2.0, 1.0)
    assert not is_asymptotic(values_of(1.0, pollution=0.01), LENGTHS, 1.0)


def test_the_wrong_formal_order_is_not_asymptotic_on_three_grids():
    assert not is_asymptotic(values_of(1.0)[:3], LENGTHS[:3], 2.0)

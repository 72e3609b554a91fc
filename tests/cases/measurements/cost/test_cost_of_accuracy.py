import math

import pytest

from cases.measurements.cost.cost_of_accuracy import (
    TimedRun,
    cheapest,
    crossover,
    degree_of_accuracy,
    degree_of_efficacy,
    degree_of_size,
    error_bound,
    pareto_front,
    price_of_a_digit,
    reference_is_fine_enough,
    true_static_scaling,
)
from contact import InvalidInput


def run(label, bound, seconds):
    return TimedRun(label=label, bound=bound, seconds=seconds)


FAST = [run("a", 1e-3, 0.001), run("b", 1e-6, 0.010), run("c", 1e-6, 0.500)]
SLOW = [run("x", 1e-2, 0.0005), run("y", 1e-5, 0.100), run("z", 1e-9, 2.000)]


def test_ranking_uses_the_bound_not_the_error():
    """A lucky error of zero against a reference known to 1e-4 is worth 1e-4, no more."""
    assert error_bound(0.0, 1e-4) == 1e-4
    assert cheapest([run("lucky", error_bound(0.0, 1e-4), 1.0)], 1e-5) is None


@pytest.mark.parametrize("bad", [math.nan, math.inf, -1e-3])
def test_a_bad_error_is_refused(bad):
    with pytest.raises(InvalidInput, match="finite"):
        error_bound(bad, 0.0)
    with pytest.raises(InvalidInput, match="finite"):
        error_bound(0.0, bad)


def test_a_reference_twice_as_fine_is_not_fine_enough():
    """Errors 4^-k against a reference one refinement finer: the observed order reads 2.32 instead of 2."""
    exact, reference = [4.0**-k for k in (0, 1, 2)], 4.0**-3
    against_reference = [e - reference for e in exact]
    assert math.log2(against_reference[1] / against_reference[2]) == pytest.approx(2.32, abs=0.01)
    assert not reference_is_fine_enough(reference, exact[2])
    assert reference_is_fine_enough(exact[2] / 10, exact[2])


def test_cheapest_is_never_interpolated():
    assert cheapest(FAST, 1e-3).label == "a"
    assert cheapest(FAST, 5e-4).label == "b"
    assert cheapest(FAST, 1e-7) is None


def test_front_drops_what_is_no_more_accurate_and_clearly_slower():
    assert pareto_front(FAST, 0.03) == (True, True, False)


def test_front_keeps_ties_within_the_null_spread():
    pair = [run("p", 1e-6, 1.00), run("q", 1e-6, 1.02)]
    assert pareto_front(pair, 0.05) == (True, True)
    assert pareto_front(pair, 0.0) == (True, False)


def test_crossover_is_the_smallest_tolerance_where_the_fast_method_wins():
    taus = [10.0**-k for k in range(1, 11)]
    assert crossover(FAST, SLOW, taus) == pytest.approx(1e-6, rel=1e-12, abs=0.0)
    assert crossover(SLOW, FAST, [1e-1]) == pytest.approx(1e-1, rel=1e-12, abs=0.0)
    assert crossover([run("never", 1.0, 1.0)], SLOW, taus) is None


def test_price_of_a_digit():
    assert price_of_a_digit(FAST[0], FAST[1]) == pytest.approx(1 / 3, rel=1e-12, abs=0.0)
    with pytest.raises(InvalidInput, match="not more accurate"):
        price_of_a_digit(FAST[1], FAST[2])


def test_degrees():
    assert degree_of_accuracy(1e-6) == pytest.approx(6, rel=1e-12, abs=0.0)
    assert degree_of_size(1000) == pytest.approx(3, rel=1e-12, abs=0.0)
    assert degree_of_efficacy(1e-6, 0.1) == pytest.approx(7, rel=1e-12, abs=0.0)
    assert true_static_scaling(1000, 0.5, 1e-6) == pytest.approx(4000, rel=1e-12, abs=0.0)

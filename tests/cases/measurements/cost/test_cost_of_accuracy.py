import math

import pytest

from cases.cost import cheapest, error_bound, pareto_front, price_of_a_digit
from cases.studies import Point
from contact import InvalidInput


def run(label, bound, seconds, method="mdr"):
    return Point(method=method, setting=label, bound=bound, seconds=seconds)


def front_of(runs, null_spread):
    return [kept.setting for kept in pareto_front(runs, null_spread)]


FAST = [run("a", 1e-3, 0.001), run("b", 1e-6, 0.010), run("c", 1e-6, 0.500)]
SLOW = [run("x", 1e-2, 0.0005, "fem"), run("y", 1e-5, 0.100, "fem"), run("z", 1e-9, 2.000, "fem")]


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


def test_cheapest_is_never_interpolated():
    assert cheapest(FAST, 1e-3).setting == "a"
    assert cheapest(FAST, 5e-4).setting == "b"
    assert cheapest(FAST, 1e-7) is None


def test_front_drops_what_is_no_more_accurate_and_clearly_slower():
    assert front_of(FAST, 0.03) == ["a", "b"]


def test_front_keeps_ties_within_the_null_spread():
    pair = [run("p", 1e-6, 1.00), run("q", 1e-6, 1.02)]
    assert front_of(pair, 0.05) == ["p", "q"]
    assert front_of(pair, 0.0) == ["p"]


def test_price_of_a_digit():
    assert price_of_a_digit(FAST[0], FAST[1]) == pytest.approx(1 / 3, rel=1e-12, abs=0.0)
    with pytest.raises(InvalidInput, match="not more accurate"):
        price_of_a_digit(FAST[1], FAST[2])

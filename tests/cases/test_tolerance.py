import math

import pytest

from cases.judgement.rules.tolerance import permitted_difference, relative_spread, relative_tolerance
from contact import InvalidInput


def test_relative_tolerance_is_ten_spreads_but_never_below_1e_12():
    assert relative_tolerance(1e-9) == pytest.approx(1e-8, rel=1e-12, abs=0.0)
    assert relative_tolerance(0.0) == 1e-12


@pytest.mark.parametrize("spread", [-1e-9, math.nan, math.inf])
def test_a_spread_of_the_wrong_sign_is_refused(spread):
    with pytest.raises(InvalidInput, match="spread"):
        relative_tolerance(spread)


def test_permitted_difference():
    assert permitted_difference(-2.0, scale=1.0, rtol=1e-3) == pytest.approx(2e-3, rel=1e-12, abs=0.0)
    assert permitted_difference(0.1, scale=1.0, rtol=1e-3) == pytest.approx(1e-3, rel=1e-12, abs=0.0)
    assert permitted_difference(0.1, scale=1.0, rtol=1e-3, atol=0.5) == 0.5


def test_spread_of_repeats():
    assert relative_spread([1.0, 1.0, 1.0], scale=1.0) == 0.0
    assert relative_spread([0.9, 1.1], scale=0.0) == pytest.approx(0.1 / 1.1, rel=1e-12, abs=0.0)
    assert relative_spread([0.0, 0.0], scale=0.0) == 0.0

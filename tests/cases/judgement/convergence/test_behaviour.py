import math

import pytest

from cases.judgement.convergence.behaviour import behaviour
from cases.judgement.convergence.known_errors import digits_per_refinement
from cases.results.records.convergence import ConvergenceClass
from contact import InvalidInput


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ((1.0, 1.1, 1.3), ConvergenceClass.MONOTONE),
        ((1.0, 0.9, 0.7), ConvergenceClass.MONOTONE),
        ((1.0, 1.1, 0.7), ConvergenceClass.OSCILLATORY),
        ((1.0, 1.3, 1.4), ConvergenceClass.DIVERGENT),
        ((1.0, 1.3, 1.2), ConvergenceClass.DIVERGENT),
        ((1.0, 1.0 + 1e-15, 1.1), ConvergenceClass.FLOOR),
        ((1.0, 1.0, 1.0), ConvergenceClass.FLOOR),
        ((1.0, 1.1), ConvergenceClass.TOO_FEW),
        ((), ConvergenceClass.TOO_FEW),
    ],
)
def test_classes(values, expected):
    assert behaviour(values, floor=1e-15) is expected


def test_nan_is_invalid_and_no_class():
    with pytest.raises(InvalidInput, match="finite"):
        behaviour((1.0, math.nan, 1.2), floor=1e-15)


def test_spectral_convergence_counts_digits():
    assert digits_per_refinement((1e-9, 1e-6, 1e-3), floor=1e-15) == pytest.approx(3.0, rel=1e-12, abs=0.0)


def test_grids_at_the_floor_count_once():
    """The fifth and sixth grid show round-off only; counting them would dilute the rate."""
    errors = (2e-15, 1e-15, 1e-12, 1e-8, 1e-4)
    assert digits_per_refinement(errors, floor=1e-15) == pytest.approx(11 / 3, rel=1e-12, abs=0.0)


def test_an_algebraic_sequence_gains_few_digits():
    errors = [h**2 for h in (1 / 16, 1 / 8, 1 / 4, 1 / 2)]
    assert digits_per_refinement(errors, floor=1e-15) == pytest.approx(0.602, abs=1e-3)


def test_nothing_above_the_floor_is_no_measurement():
    with pytest.raises(InvalidInput, match="start coarser"):
        digits_per_refinement((1e-15, 1e-15), floor=1e-15)


def test_nan_is_refused():
    with pytest.raises(InvalidInput, match="finite"):
        digits_per_refinement((math.nan, 1e-3), floor=1e-15)

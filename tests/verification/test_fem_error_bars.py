"""Do the error bars hold? Scenes and settings drawn at random (fixed seed), true errors from independent methods."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.fem_error_bars import contacts, impacts


def every(ratios):
    return np.concatenate(list(ratios.values()))


@pytest.mark.slow
def test_error_bars_cover_95_in_100_and_overestimate_less_than_tenfold():
    ratios = contacts(220, seed=5)
    for name, stated_over_true in ratios.items():
        assert np.mean(np.array(stated_over_true) >= 1) >= 0.95, name
        assert np.median(stated_over_true) < 10, name


@pytest.mark.slow
def test_error_bars_of_impacts_cover_95_in_100():
    ratios = impacts(40, seed=7)
    for name, stated_over_true in ratios.items():
        assert np.mean(np.array(stated_over_true) >= 1) >= 0.95, name
    assert np.median(every(ratios)) < 10


def test_error_bars_of_a_few():
    ratios = every(contacts(5, seed=11))
    assert ratios.min() >= 1
    assert np.median(ratios) < 20


def test_error_bars_of_an_impact():
    assert every(impacts(1, seed=7)).min() >= 1

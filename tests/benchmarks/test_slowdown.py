"""The ratio of paired times: its interval, and what the limit makes of it."""

import numpy as np
import pytest

from benchmarks.race.slowdown import is_ambiguous, is_slower, slowdown
from contact import InvalidInput

NULL_SPREAD = 0.02


def times(factor, seed, pairs=15):
    """Noise like that of a shared machine: a common drift and 5 % jitter, the odd interruption."""
    noise = np.random.default_rng(seed)
    jitter = np.exp(0.05 * noise.standard_normal(pairs)) * (1 + (noise.random(pairs) < 0.1))
    return factor * jitter


def test_identical_versions_pass_twenty_times():
    for seed in range(20):
        assert not is_slower(slowdown(times(1.0, seed), times(1.0, 100 + seed)), NULL_SPREAD)


def test_a_slowdown_of_one_and_a_half_fails_at_least_nineteen_times_of_twenty():
    failed = sum(is_slower(slowdown(times(1.0, s), times(1.5, 100 + s)), NULL_SPREAD) for s in range(20))
    assert failed >= 19


def test_the_interval_contains_the_ratio_of_a_noiseless_pair():
    measured = slowdown([1.0] * 7, [1.25] * 7)
    assert (measured.lower, measured.ratio, measured.upper) == pytest.approx((1.25, 1.25, 1.25), rel=1e-12, abs=0.0)


def test_a_wide_interval_is_ambiguous():
    measured = slowdown([1.0] * 8, [1.0, 1.0, 1.0, 1.0, 1.3, 1.3, 1.3, 1.3])
    assert is_ambiguous(measured, NULL_SPREAD)
    assert not is_slower(measured, NULL_SPREAD)


def test_a_noisy_machine_widens_the_limit():
    measured = slowdown([1.0] * 7, [1.25] * 7)
    assert is_slower(measured, 0.02)
    assert not is_slower(measured, 0.10)


def test_too_few_or_unpaired_times_are_refused():
    with pytest.raises(InvalidInput, match="pairs"):
        slowdown([1.0] * 6, [1.0] * 6)
    with pytest.raises(InvalidInput, match="pairs"):
        slowdown([1.0] * 7, [1.0] * 8)

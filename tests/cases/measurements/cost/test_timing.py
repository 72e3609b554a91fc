import time

import pytest

from cases.run.timing import timed_warm


def test_a_fast_call_is_looped_within_each_sample(monkeypatch):
    """On a clock that each call advances by one millisecond."""
    clock = [0.0]
    monkeypatch.setattr(time, "perf_counter", lambda: clock[0])
    calls = []

    def call():
        calls.append(None)
        clock[0] += 0.001

    seconds = timed_warm(call, samples=3, shortest=0.01)
    assert seconds == pytest.approx((0.001, 0.001, 0.001), rel=1e-12, abs=0.0)
    assert len(calls) == 1 + 3 * 10

"""A limit ends what takes too long, in the main thread and in any other, and leaves the rest alone."""

import threading
import time

import pytest

from cases.run.time_limit import TimeLimitReached, time_limited


def spin(seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        pass


def limited(limit, seconds):
    """How it ended, and that nothing is left to interrupt what comes next."""
    try:
        with time_limited(limit):
            spin(seconds)
    except TimeLimitReached:
        ended = "limit"
    else:
        ended = "done"
    spin(0.1)
    return ended


def in_a_thread(*arguments):
    found = []
    thread = threading.Thread(target=lambda: found.append(limited(*arguments)))
    thread.start()
    thread.join()
    return found[0]


@pytest.mark.parametrize("where", [limited, in_a_thread])
@pytest.mark.parametrize(("limit", "ended"), [(0.05, "limit"), (5.0, "done"), (0.0, "done")])
def test_the_limit_ends_what_takes_longer_and_nothing_else(where, limit, ended):
    start = time.monotonic()
    assert where(limit, 0.2) == ended
    assert time.monotonic() - start < 2


def test_a_solver_that_catches_every_exception_is_ended_all_the_same():
    def stubborn():
        with time_limited(0.05):
            try:
                spin(5)
            except Exception:
                spin(5)

    with pytest.raises(TimeLimitReached):
        stubborn()

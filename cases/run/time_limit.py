"""A time limit on whatever runs inside a ``with`` statement, in a process of its own or in a worker's thread."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import c_ulong, py_object, pythonapi
from threading import Lock, Timer, current_thread, get_ident, main_thread
from types import FrameType


class TimeLimitReached(BaseException):
    """The time is used up; no ``except Exception`` of a solver may swallow it."""


@contextmanager
def time_limited(seconds: float) -> Iterator[None]:
    """Raise ``TimeLimitReached`` after so many seconds, between two instructions of Python."""
    if seconds <= 0:
        yield
    elif current_thread() is main_thread() and hasattr(signal, "SIGALRM"):
        with _signal(seconds):
            yield
    else:
        with _timer(seconds):
            yield


@contextmanager
def _signal(seconds: float) -> Iterator[None]:
    """In the main thread of a process, where the system has alarms (Windows has none); ends a wait, too."""
    previous = signal.signal(signal.SIGALRM, _ring)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, previous)


def _ring(number: int, frame: FrameType | None) -> None:
    raise TimeLimitReached


@contextmanager
def _timer(seconds: float) -> Iterator[None]:
    """In any thread, such as those in which a cluster's workers solve; signals reach the main thread only."""
    thread, lock, running = get_ident(), Lock(), True

    def ring() -> None:
        with lock:
            if running:
                _raise_in(thread, py_object(TimeLimitReached))

    timer = Timer(seconds, ring)
    timer.start()
    try:
        yield
    finally:
        with lock:
            running = False
        timer.cancel()
        # What was raised at the last moment has nothing left to interrupt.
        _raise_in(thread, None)


def _raise_in(thread: int, error: object) -> None:
    pythonapi.PyThreadState_SetAsyncExc(c_ulong(thread), error)

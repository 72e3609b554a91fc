"""Solutions in a separate process that is killed at the time limit, since methods of others may not end.

One such process serves one process of this program, task after task, until a task does not end in time. Run as a
module this file is that process: it reads pickled calls from its input and writes pickled results.
"""

import atexit
import os
import pickle
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from queue import Empty, SimpleQueue
from threading import Thread
from typing import Any, BinaryIO

# Longest start of the process [s]: ten times the imports on a busy machine.
STARTS = 60.0


class TimeLimitReached(Exception):
    """The call was not finished in time; its process was killed."""


class ProcessDied(Exception):
    """The process that computed ended without a result."""


class _Computer:
    """A process that computes calls."""

    def __init__(self) -> None:
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
        command = [sys.executable, "-m", "cases.run.apart"]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=environment)
        self.results: SimpleQueue[Any] = SimpleQueue()
        self.reader = Thread(target=_read, args=(self.process.stdout, self.results.put), daemon=True)
        self.reader.start()
        # The first result is sent when the process has started.
        self.results.get(timeout=STARTS)

    def call(self, function: Callable[..., Any], arguments: tuple[Any, ...], seconds: float) -> Any:
        """Return ``function(*arguments)``, computed by the process; None if the process ended without a result.

        Raises:
            Empty: After so many seconds.
        """
        assert self.process.stdin is not None
        pickle.dump((function, arguments), self.process.stdin)
        self.process.stdin.flush()
        return self.results.get(timeout=seconds)


# The process that serves this one, if it was needed already.
_running: list[_Computer] = []


def apart(function: Callable[..., Any], *arguments: Any, seconds: float) -> Any:
    """Return ``function(*arguments)``, computed in the separate process; it may neither raise nor return None.

    Raises:
        TimeLimitReached: After so many seconds.
        ProcessDied: If the process ended by itself.
    """
    try:
        if not _running:
            _running.append(_Computer())
        result = _running[0].call(function, arguments, seconds)
    except Empty:
        _end()
        raise TimeLimitReached from None
    except BaseException:
        # This is mostly Ctrl-C.
        _end()
        raise
    if result is None:
        raise ProcessDied(f"exit code {_end()}")
    return result


@atexit.register
def _end() -> int:
    """Kill the process and return its exit code."""
    code = 0
    for computer in _running:
        computer.process.kill()
        code = computer.process.wait()
        computer.reader.join()
        for stream in (computer.process.stdin, computer.process.stdout):
            with suppress(OSError):
                stream.close()  # type: ignore[union-attr]  # both are pipes
    _running.clear()
    return code


def _read(stream: BinaryIO, put: Callable[[Any], None]) -> None:
    """Pass every pickled object of a stream to ``put``, and None at its end."""
    try:
        while True:
            put(pickle.load(stream))
    except Exception:
        # A torn object ends a stream as well.
        put(None)


def _serve() -> None:
    """Compute calls until the input ends, which it does with the parent, however that ends."""
    output = os.fdopen(os.dup(1), "wb")
    # The output of prints is no result.
    os.dup2(2, 1)
    # Imports that every call needs do not count for its time limit.
    import_module("cases.run.solve_task")
    calls: SimpleQueue[Any] = SimpleQueue()
    Thread(
        target=_read, args=(sys.stdin.buffer, lambda call: calls.put(call) if call else os._exit(1)), daemon=True
    ).start()
    result: Any = "ready"
    while True:
        pickle.dump(result, output)
        output.flush()
        function, arguments = calls.get()
        result = function(*arguments)


if __name__ == "__main__":
    _serve()

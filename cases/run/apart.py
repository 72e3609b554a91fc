"""Solutions in a separate process that is killed at the time limit, since methods of others may not end.

One such process serves one process of this program, task after task, until a task does not end in time. Run as a
module this file is that process: it reads pickled calls from its input and writes pickled results.
"""

import atexit
import os
import pickle
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from queue import SimpleQueue
from threading import Thread, Timer
from typing import Any

# Longest start of the process [s]: ten times the imports on a busy machine.
STARTS = 60.0
# The process that serves this one, if it was needed already.
_running: list[subprocess.Popen[bytes]] = []


class TimeLimitReached(Exception):
    """The call was not finished in time; its process was killed."""


class ProcessDied(Exception):
    """The process that computed ended without a result."""


def apart(function: Callable[..., Any], *arguments: Any, seconds: float) -> Any:
    """Return ``function(*arguments)``, computed in the separate process; it may not raise.

    Raises:
        TimeLimitReached: After so many seconds.
        ProcessDied: If the process ended by itself.
    """
    try:
        if not _running:
            environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
            command, pipe = [sys.executable, "-m", "cases.run.apart"], subprocess.PIPE
            _running.append(subprocess.Popen(command, stdin=pipe, stdout=pipe, env=environment))
            # The first result is sent when the process has started.
            _received(STARTS)
        pickle.dump((function, arguments), _running[0].stdin)  # type: ignore[arg-type]  # it is a pipe
        _running[0].stdin.flush()  # type: ignore[union-attr]
        return _received(seconds)
    except BaseException:
        # This is a time limit, a death, or Ctrl-C.
        _end()
        raise


def _received(seconds: float) -> Any:
    """The next result of the process, which is killed after so many seconds."""
    process, start = _running[0], time.monotonic()
    timer = Timer(seconds, process.kill)
    timer.start()
    try:
        return pickle.load(process.stdout)  # type: ignore[arg-type]  # it is a pipe
    except Exception:
        # A process that ended may leave a torn object.
        if time.monotonic() - start >= seconds:
            raise TimeLimitReached from None
        raise ProcessDied(f"exit code {_end()}") from None
    finally:
        timer.cancel()


@atexit.register
def _end() -> int:
    """Kill the process, if there is one, and return its exit code."""
    if not _running:
        return 0
    process = _running.pop()
    with suppress(OSError), process:
        process.kill()
    return process.returncode


def _serve() -> None:
    """Compute calls until the input ends, which it does with the parent, however that ends."""
    output = os.fdopen(os.dup(1), "wb")
    # The output of prints is no result.
    os.dup2(2, 1)
    # Imports that every call needs do not count for its time limit.
    import_module("cases.run.solve_task")
    calls: SimpleQueue[Any] = SimpleQueue()
    Thread(target=_listen, args=(calls,), daemon=True).start()
    result: Any = "ready"
    while True:
        pickle.dump(result, output)
        output.flush()
        function, arguments = calls.get()
        result = function(*arguments)


def _listen(calls: SimpleQueue[Any]) -> None:
    """Queue the calls that are read from the input, and end the process with it."""
    try:
        while True:
            calls.put(pickle.load(sys.stdin.buffer))
    except Exception:
        os._exit(1)


if __name__ == "__main__":
    _serve()

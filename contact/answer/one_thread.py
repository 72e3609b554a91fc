"""One BLAS thread while a method computes: the digits of an answer then do not depend on the number of threads.

A matrix product that is shared by several threads is summed in another order than on one thread.
"""

from __future__ import annotations

import sys
from contextlib import ContextDecorator
from functools import cache
from threading import Lock
from typing import Any

from threadpoolctl import ThreadpoolController  # type: ignore[import-untyped]  # ships no types


class OneThread(ContextDecorator):
    """Context and decorator: every loaded BLAS computes on one thread until the last context is left.

    Contexts may be nested and shared by Python threads. A BLAS that is loaded inside (SciPy's, at the first
    factorisation) is set to one thread by the next context that is entered.
    """

    def __init__(self) -> None:
        self._lock = Lock()
        self._inside = 0
        self._threads_before: dict[str, tuple[Any, int]] = {}

    def __enter__(self) -> None:
        """Set every loaded BLAS to one thread, and store its previous number of threads."""
        with self._lock:
            self._inside += 1
            for library in _loaded_libraries("scipy.linalg._flapack" in sys.modules):
                if library.filepath not in self._threads_before:
                    self._threads_before[library.filepath] = library, library.get_num_threads()
                    library.set_num_threads(1)

    def __exit__(self, *error: object) -> None:
        """Restore the previous number of threads of each BLAS if no other context is open."""
        with self._lock:
            self._inside -= 1
            if self._inside == 0:
                for library, threads in self._threads_before.values():
                    library.set_num_threads(threads)
                self._threads_before.clear()


@cache
def _loaded_libraries(with_scipy: bool) -> tuple[Any, ...]:
    """The BLAS libraries of this process, determined once before and once after SciPy has loaded its own."""
    return tuple(ThreadpoolController().select(user_api="blas").lib_controllers)


one_thread = OneThread()

"""Executors that tell how many calls were under way at once, or that break as pools and clusters do."""

from concurrent.futures import BrokenExecutor, Future, ThreadPoolExecutor
from threading import Lock

from cases.run.executors import SerialExecutor


class InFlight(ThreadPoolExecutor):
    """Threads; `largest` is the largest number of calls that were handed over and not finished."""

    def __init__(self, jobs):
        super().__init__(jobs)
        self.now = self.largest = self.submitted = 0
        self._lock = Lock()

    def submit(self, fn, /, *args, **kwargs):
        with self._lock:
            self.now += 1
            self.submitted += 1
            self.largest = max(self.largest, self.now)
        future = super().submit(fn, *args, **kwargs)
        future.add_done_callback(self._finished)
        return future

    def _finished(self, _):
        with self._lock:
            self.now -= 1


def recording(made):
    """A factory whose executors are kept in a list."""

    def factory(jobs):
        made.append(InFlight(jobs))
        return made[-1]

    return factory


class Fragile(SerialExecutor):
    """Dies of some numbers in a block: the call is lost and, in a pool, so are all that come after it."""

    def __init__(self, deadly, *, pool):
        self._deadly, self._pool, self._dead = deadly, pool, False

    def submit(self, fn, /, *args, **kwargs):
        if self._dead and self._pool:
            raise BrokenExecutor("the pool is broken")
        if self._deadly.isdisjoint(args[-1]):
            return super().submit(fn, *args, **kwargs)
        self._dead, future = True, Future()
        future.set_exception(BrokenExecutor("a process died"))
        return future

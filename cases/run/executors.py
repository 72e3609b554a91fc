"""Where tasks run, behind ``concurrent.futures.Executor``: in this process, in a pool of processes, on a cluster."""

import logging
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from itertools import islice
from queue import SimpleQueue
from typing import Any, Generic, ParamSpec, TypeVar

from contact import InvalidInput

P = ParamSpec("P")
T = TypeVar("T")

ExecutorFactory = Callable[[int], Executor]


class SerialExecutor(Executor):
    """Runs each call at once, in this process."""

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Run ``fn`` and return its finished future."""
        future: Future[T] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            # `result` of the future raises it.
            future.set_exception(error)
        return future


def serial(jobs: int = 1) -> Executor:
    """Return an executor that runs in this process, whatever ``jobs``."""
    return SerialExecutor()


def process_pool(jobs: int) -> Executor:
    """Return ``jobs`` fresh processes (spawned: no state of this one leaks in).

    Raises:
        InvalidInput: unless there is at least one job.
    """
    if jobs < 1:
        raise InvalidInput(f"jobs must be at least 1, got {jobs}")
    return ProcessPoolExecutor(jobs, mp_context=multiprocessing.get_context("spawn"), initializer=_follow_parent)


def fresh_processes(jobs: int) -> Executor:
    """Return ``jobs`` processes that solve one task each: peak memory is the task's own.

    Where the system can fork, they come from a server that has imported what every task needs and solved nothing.
    """
    # Windows cannot fork: there a fresh process imports everything itself.
    forks = "forkserver" in multiprocessing.get_all_start_methods()
    context = multiprocessing.get_context("forkserver" if forks else "spawn")
    if forks:
        context.set_forkserver_preload(["cases.run.solve_task"])
    return ProcessPoolExecutor(jobs, mp_context=context, initializer=_follow_parent, max_tasks_per_child=1)


class ClusterLost(Exception):
    """The scheduler of a cluster does not answer any more: what it had not finished is unsolved."""


# Seconds that a scheduler may take to answer: at first, and again after its connection broke.
PATIENCE = 10.0


class DaskExecutor(Executor):
    """Runs each call on a Dask cluster; a call whose worker dies is repeated on another one.

    Raises:
        InvalidInput: if Dask is not installed or no scheduler answers at the address.
    """

    def __init__(self, address: str) -> None:
        try:
            from distributed import Client, KilledWorker  # noqa: PLC0415 - an optional extra
        except ImportError:
            raise InvalidInput(f"{address}: Dask is not installed; install dask[distributed]") from None
        # What breaks is said once, by this class.
        logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
        self._address, self._killed = address, KilledWorker
        self._threads, self._counted = 0, -PATIENCE
        try:
            self._client = Client(address, set_as_default=False, timeout=PATIENCE)
        except (OSError, ValueError) as error:
            raise InvalidInput(f"no Dask scheduler answers at {address} ({error!s:.120}); start one there") from None

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Send ``fn`` to the cluster and return its future."""
        future: Future[T] = Future()

        # The future belongs to the cluster: ``result`` waits if its worker died meanwhile.
        def deliver(remote: Any) -> None:
            """Set the answer or the error of the cluster on the future."""
            try:
                future.set_result(remote.result())
            except Exception as error:
                # `result` of the future raises it.
                future.set_exception(self._named(error))

        if self._is_lost:
            raise self._lost()
        remote = self._client.submit(fn, *args, pure=False, retries=2, **kwargs)
        remote.add_done_callback(deliver)
        return future

    @property
    def threads(self) -> int:
        """Threads of the workers that are there, asked for once in `PATIENCE` seconds: a cluster may grow.

        Raises:
            ClusterLost: if the scheduler does not answer any more.
        """
        if self._is_lost:
            raise self._lost()
        if time.monotonic() - self._counted >= PATIENCE:
            try:
                self._threads = sum(self._client.nthreads().values())
            except (CancelledError, OSError):
                raise self._lost() from None
            self._counted = time.monotonic()
        return self._threads

    @property
    def _is_lost(self) -> bool:
        return bool(self._client.status != "running")

    def _lost(self) -> ClusterLost:
        return ClusterLost(f"the Dask scheduler at {self._address} does not answer any more")

    def _named(self, error: Exception) -> Exception:
        """The error in the words of this program: a lost scheduler, workers that died of a call, or itself.

        Other errors of a call are no ``OSError``: `cases.solve` turns every error into a row.
        """
        if isinstance(error, CancelledError | OSError) or self._is_lost:
            return self._lost()
        return BrokenExecutor(f"{error!s:.200}") if isinstance(error, self._killed) else error

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Leave the cluster; it stays up for others."""
        self._client.close()


def dask_cluster(address: str) -> ExecutorFactory:
    """Return a factory of executors on the Dask scheduler at ``address`` (optional extra ``cluster``)."""

    def factory(jobs: int) -> Executor:
        return DaskExecutor(address)

    return factory


def places(executor: Executor, jobs: int) -> int:
    """How many calls an executor of ``jobs`` jobs can carry out at a time; a cluster has as many places as threads."""
    if isinstance(executor, SerialExecutor):
        return 1
    return max(jobs, executor.threads) if isinstance(executor, DaskExecutor) else jobs


def ahead(executor: Executor, jobs: int) -> int:
    """How many calls may be under way: two for each place, so that none stands idle and little is lost with one."""
    # What runs in this process has ended when it is handed over.
    return 1 if isinstance(executor, SerialExecutor) else 2 * places(executor, jobs)


@contextmanager
def closing(executor: Executor) -> Iterator[Executor]:
    """Wait for the executor's own threads and processes to end, unless the run itself is over."""
    try:
        yield executor
    except BaseException:
        # This is mostly Ctrl-C.
        executor.shutdown(wait=False, cancel_futures=True)
        raise
    executor.shutdown(wait=True, cancel_futures=True)


def by_name(name: str) -> ExecutorFactory:
    """Return the executor factory called ``processes``, ``serial`` or ``tcp://host:port`` (a Dask scheduler).

    Raises:
        InvalidInput: for any other name.
    """
    if name == "processes":
        return process_pool
    if name == "serial":
        return serial
    if "://" in name:
        return dask_cluster(name)
    raise InvalidInput(f"executor {name!r} is neither processes, serial nor the address of a Dask scheduler")


def _follow_parent() -> None:
    """Leave Ctrl-C to the parent, which decides what becomes of the run; end with it, however it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """Wait for the parent's death: a killed run must not leave processes that go on computing."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


A = TypeVar("A")


class Window(Generic[A, T]):
    """A bounded number of calls under way; each result leaves as soon as it is there, and nothing of it is kept.

    Args:
        submit: Hands one argument over and returns the future of its result.
        ahead: Gives how many may be under way now.

    Attributes:
        broken: Arguments whose process died. After the first no more are handed over.
    """

    def __init__(self, submit: Callable[[A], Future[T]], ahead: Callable[[], int]) -> None:
        self._submit, self._ahead = submit, ahead
        self._under_way: dict[Future[T], A] = {}
        self._finished: SimpleQueue[Future[T]] = SimpleQueue()
        self.broken: list[A] = []

    def results(self, arguments: Iterable[A]) -> Iterator[tuple[A, T]]:
        """Submit arguments one by one while workers are free, and yield each with its result as soon as it is finished.

        Raises:
            Exception: whatever a call raised, but for a process that died: its argument is in `broken`.
        """
        waiting = iter(arguments)
        while True:
            if not self.broken:
                self._fill(waiting)
            if not self._under_way:
                return
            future = self._finished.get()
            argument = self._under_way.pop(future)
            try:
                result = future.result()
            except BrokenExecutor:
                self.broken.append(argument)
            else:
                yield argument, result

    def _fill(self, waiting: Iterator[A]) -> None:
        for argument in islice(waiting, max(0, self._ahead() - len(self._under_way))):
            self._hand_over(argument)
            if self.broken:
                return

    def _hand_over(self, argument: A) -> None:
        try:
            future = self._submit(argument)
        except BrokenExecutor:
            self.broken.append(argument)
            return
        self._under_way[future] = argument
        # Finished calls are delivered by a queue, without a search through all calls under way.
        future.add_done_callback(self._finished.put)

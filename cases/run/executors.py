"""Where tasks run, behind ``concurrent.futures.Executor``: in this process, in a pool of processes, on a cluster."""

import logging
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from itertools import islice
from queue import SimpleQueue
from typing import Any, ParamSpec, TypeVar

from contact import InvalidInput

P = ParamSpec("P")
T = TypeVar("T")
A = TypeVar("A")

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


# Seconds that a scheduler may take to answer.
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

        if self._client.status != "running":
            raise self._lost()
        self._client.submit(fn, *args, pure=False, retries=2, **kwargs).add_done_callback(deliver)
        return future

    def _lost(self) -> ClusterLost:
        return ClusterLost(f"the Dask scheduler at {self._address} does not answer any more")

    def _named(self, error: Exception) -> Exception:
        """The error in the words of this program: a lost scheduler, workers that died of a call, or itself.

        Other errors of a call are no ``OSError``: `cases.solve` turns every error into a row.
        """
        if isinstance(error, CancelledError | OSError) or self._client.status != "running":
            return self._lost()
        return BrokenExecutor(f"{error!s:.200}") if isinstance(error, self._killed) else error

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Leave the cluster; it stays up for others."""
        self._client.close()


def ahead(executor: Executor, jobs: int) -> int:
    """How many calls may be under way: two for each job, so that none stands idle and little is lost with one.

    What runs in this process has ended when it is handed over; a cluster has a queue of its own.
    """
    return {SerialExecutor: 1, DaskExecutor: sys.maxsize}.get(type(executor), 2 * jobs)


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
        return lambda _: DaskExecutor(name)
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


def completed(
    submit: Callable[[A], Future[T]], arguments: Iterable[A], ahead: int, broken: list[A]
) -> Iterator[tuple[A, T]]:
    """Submit arguments one by one and yield each with its result as soon as it is there; nothing of it is kept.

    Args:
        submit: hands one argument over and returns the future of its result.
        arguments: taken when there is room for them.
        ahead: how many may be under way.
        broken: gets the arguments whose process died. After the first no more are handed over.

    Raises:
        Exception: whatever a call raised, but for a process that died.
    """
    waiting, under_way = iter(arguments), dict[Future[T], A]()
    # Finished calls are delivered by a queue, without a search through all calls under way.
    finished: SimpleQueue[Future[T]] = SimpleQueue()
    while True:
        for argument in islice(waiting, 0 if broken else ahead - len(under_way)):
            try:
                future = submit(argument)
            except BrokenExecutor:
                broken.append(argument)
                break
            under_way[future] = argument
            future.add_done_callback(finished.put)
        if not under_way:
            return
        future = finished.get()
        argument = under_way.pop(future)
        try:
            result = future.result()
        except BrokenExecutor:
            broken.append(argument)
        else:
            yield argument, result

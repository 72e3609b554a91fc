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
    """Return an executor that runs in this process, for any number of jobs."""
    return SerialExecutor()


def process_pool(jobs: int) -> Executor:
    """Return ``jobs`` fresh processes (spawned: no state of this one leaks in).

    Raises:
        InvalidInput: Unless there is at least one job.
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
    """The scheduler of a cluster does not answer any more; unfinished calls are unsolved."""


# Seconds that a scheduler may take to answer.
PATIENCE = 10.0


class DaskExecutor(Executor):
    """Runs each call on a Dask cluster; a call whose worker dies is repeated on another one.

    Raises:
        InvalidInput: If Dask is not installed or no scheduler answers at the address.
    """

    def __init__(self, address: str) -> None:
        try:
            from distributed import Client, KilledWorker  # noqa: PLC0415 - an optional extra
        except ImportError:
            raise InvalidInput(f"{address}: Dask is not installed; install dask[distributed]") from None
        # Errors of the client are reported once, by this class.
        logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
        self._lost = ClusterLost(f"the Dask scheduler at {address} does not answer any more")
        self._killed = KilledWorker
        try:
            self._client = Client(address, set_as_default=False, timeout=PATIENCE)
        except (OSError, ValueError) as error:
            raise InvalidInput(f"no Dask scheduler answers at {address} ({error!s:.120}); start one there") from None

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Send ``fn`` to the cluster and return its future.

        Its error is that of the call, `ClusterLost`, or `BrokenExecutor` if workers died of it.
        """
        future: Future[T] = Future()

        def deliver(remote: Any) -> None:
            """Set the answer or the error of the cluster on the future; waits if its worker died meanwhile."""
            try:
                future.set_result(remote.result())
            except self._killed as error:
                future.set_exception(BrokenExecutor(f"{error!s:.200}"))
            except Exception as error:
                # Calls raise no OSError: `cases.run.solve_task.solve` turns every error into an answer.
                lost = isinstance(error, CancelledError | OSError) or self._client.status != "running"
                future.set_exception(self._lost if lost else error)

        if self._client.status != "running":
            raise self._lost
        self._client.submit(fn, *args, pure=False, retries=2, **kwargs).add_done_callback(deliver)
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Leave the cluster; it stays up for others."""
        self._client.close()


def ahead(executor: Executor, jobs: int) -> int:
    """Number of calls that may be under way: two per job, so that no job is idle and few calls are lost with one.

    In this process a call has ended when it is submitted: one. A cluster has its own queue: no limit.
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
        InvalidInput: For any other name.
    """
    if name == "processes":
        return process_pool
    if name == "serial":
        return serial
    if "://" in name:
        return lambda _: DaskExecutor(name)
    raise InvalidInput(f"executor {name!r} is neither processes, serial nor the address of a Dask scheduler")


def _follow_parent() -> None:
    """Leave Ctrl-C to the parent, which decides when the run ends; end with the parent, however it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """Wait for the parent's death: a killed run must not leave processes that go on computing."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def completed(submit: Callable[[A], Future[T]], arguments: Iterable[A], ahead: int) -> Iterator[tuple[A, Future[T]]]:
    """Submit arguments one by one and yield each with its finished future, which is not stored.

    After a process died no more arguments are submitted.

    Args:
        submit: Hands one argument over and returns the future of its result.
        arguments: Taken when there is room for them.
        ahead: Number of calls that may be under way.
    """
    waiting, under_way, is_broken = iter(arguments), dict[Future[T], A](), False
    # Finished calls are delivered by a queue, without a search through all calls under way.
    finished: SimpleQueue[Future[T]] = SimpleQueue()
    while True:
        for argument in islice(waiting, 0 if is_broken else ahead - len(under_way)):
            future = _submitted(submit, argument)
            under_way[future] = argument
            future.add_done_callback(finished.put)
        if not under_way:
            return
        future = finished.get()
        is_broken = is_broken or died(future)
        yield under_way.pop(future), future


def _submitted(submit: Callable[[A], Future[T]], argument: A) -> Future[T]:
    """The future of the call, which is a failed one where a process has died since the last call."""
    try:
        return submit(argument)
    except BrokenExecutor as error:
        future: Future[T] = Future()
        future.set_exception(error)
        return future


def died(future: Future[Any]) -> bool:
    """Whether the process of a finished call, or another process of its pool, died."""
    return isinstance(future.exception(), BrokenExecutor)

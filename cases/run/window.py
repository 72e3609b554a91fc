"""Calls handed to an executor a few at a time: what is under way never grows with how many there are."""

from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, Future
from itertools import islice
from queue import SimpleQueue
from typing import Generic, TypeVar

A = TypeVar("A")
T = TypeVar("T")


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
        """Hand over arguments, taken one by one while there is room, and give each with its result, first come first.

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

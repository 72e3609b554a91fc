"""Numbered work in blocks whose size follows what it costs, so that handing over costs little."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor
from dataclasses import dataclass, field
from functools import partial
from threading import Lock
from time import perf_counter
from typing import Generic, TypeAlias, TypeVar

# This package ships no types.
from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]

from cases.run.executors import ExecutorFactory, ahead, closing, places
from cases.run.many.window import Window

T = TypeVar("T")

Block: TypeAlias = Sequence[int]

# Seconds that a block takes at least, however few places there are. An empty block cost a worker 4 to 6 ms
# (`python -m benchmarks.cluster`, seed 22, 2026-11-22), so that 0.1 s would do for 95 %; ten times that is chosen.
SHORTEST = 1.0
# Seconds of a block for each place where blocks run: one scheduler serves all. An empty one cost it 2.1 to 2.8 ms
# (measured as above), so that it works a quarter of the time; from a half on blocks would begin to wait for it.
FOR_EACH_PLACE = 0.01
# Towards the end blocks get shorter, down to this share, so that the last ones end together. Chosen.
LAST_SHARE = 1 / 8
# At most so many times what the block before held: one number may cost nothing, and the next much. Chosen.
GROWTH = 4


def usual_seconds(places: int) -> float:
    """How long a block takes where so many run at a time."""
    return max(SHORTEST, FOR_EACH_PLACE * places)


@dataclass
class Cutter:
    """Cuts numbers into blocks of equal seconds, as far as the blocks before tell what a number costs.

    Attributes:
        numbers: what is left to be cut.
        places: where blocks run.
        each: seconds for a number; None until the first block is back.
        size: numbers in the block that was cut last.
    """

    numbers: Block
    places: Callable[[], int]
    each: float | None = None
    size: int = 1

    def __iter__(self) -> Iterator[Block]:
        """Blocks, each cut when it is asked for."""
        while self.numbers:
            self.size = self._next_size()
            block, self.numbers = self.numbers[: self.size], self.numbers[self.size :]
            yield block

    def learn(self, numbers: int, seconds: float) -> None:
        """Take the mean of what the last blocks cost; the latest weighs half."""
        latest = seconds / numbers
        self.each = latest if self.each is None else (self.each + latest) / 2

    def _next_size(self) -> int:
        if not self.each:
            return 1
        places = self.places()
        usual = usual_seconds(places) / self.each
        fair = len(self.numbers) / (2 * places)
        return max(1, min(int(max(LAST_SHARE * usual, min(usual, fair))), GROWTH * self.size))


@dataclass(frozen=True)
class Finished(Generic[T]):
    """What a block came to, and how long it took [s]."""

    result: T
    seconds: float


# A block has its process to itself: warnings and processor time belong to a whole process.
_ALONE = Lock()


def carried_out(work: Callable[[Block], T], block: Block) -> Finished[T]:
    """Call ``work`` with the block, on one thread."""
    with _ALONE, threadpool_limits(limits=1):
        start = perf_counter()
        return Finished(work(block), perf_counter() - start)


@dataclass
class InBlocks(Generic[T]):
    """Numbers worked off in blocks on an executor; a process that dies costs its block only, which is repeated.

    Attributes:
        work: what is called with each block; it can be pickled.
        factory: of executors.
        jobs: blocks at a time; on a cluster as many as it has threads if that is more.
        died: result of a single number whose process dies also when it is alone, by the words of the error.
        blocks: how many are finished.
        seconds: that they took, added up [s].
    """

    work: Callable[[Block], T]
    factory: ExecutorFactory
    jobs: int
    died: Callable[[int, str], T]
    blocks: int = field(default=0, init=False)
    seconds: float = field(default=0.0, init=False)

    def results(self, numbers: Block) -> Iterator[T]:
        """The result of each block, first come first.

        Raises:
            ClusterLost: if the scheduler of a cluster does not answer any more.
        """
        cutter, call = Cutter(numbers, lambda: self.jobs), partial(carried_out, self.work)
        while cutter.numbers:
            with closing(self.factory(self.jobs)) as executor:
                window = Window(partial(executor.submit, call), partial(ahead, executor, self.jobs))
                cutter.places = partial(places, executor, self.jobs)
                for block, finished in window.results(cutter):
                    cutter.learn(len(block), finished.seconds)
                    yield self._counted(finished)
            for block in window.broken:
                yield from self._apart(block)

    def _counted(self, finished: Finished[T]) -> T:
        self.blocks += 1
        self.seconds += finished.seconds
        return finished.result

    def _apart(self, block: Block) -> Iterator[T]:
        """A block whose process died, alone in an executor; in halves if it dies again, down to a single number."""
        with closing(self.factory(1)) as executor:
            try:
                finished = executor.submit(partial(carried_out, self.work), block).result()
            except BrokenExecutor as error:
                finished, words = None, str(error)
        if finished is not None:
            yield self._counted(finished)
        elif len(block) == 1:
            yield self.died(block[0], words)
        else:
            for half in (block[: len(block) // 2], block[len(block) // 2 :]):
                yield from self._apart(half)

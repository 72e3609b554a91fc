"""Stage log: names, numbers of calls and times of the computations in a solve; the data of all costs."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

try:
    import resource
except ImportError:
    # Windows has no such module.
    resource = None  # type: ignore[assignment]


@dataclass(frozen=True, kw_only=True)
class StageRecord:
    """One kind of computation within one solve.

    Attributes:
        name: Name of the computation, such as "flat_punch_data".
        calls: Number of calls.
        wall_seconds: Wall time [s] without that of nested stages.
        cpu_seconds: Processor time [s] without that of nested stages.
        bytes: Size of the arrays of the stage, as far as the method declares them.
    """

    name: str
    calls: int
    wall_seconds: float
    cpu_seconds: float
    bytes: int


@dataclass(frozen=True, kw_only=True)
class Cost:
    """Cost of one solve.

    Attributes:
        wall_seconds: Wall time [s].
        cpu_seconds: Processor time [s] of all threads, and of processes that the method started and that have ended.
        peak_memory_bytes: Peak memory of the process since its start, plus that of the largest process that it started;
            meaningful if the process does nothing else.
        unknowns: Size of the largest system solved.
        counters: Deterministic counts (factorisations, iterations, transforms, steps).
    """

    wall_seconds: float
    cpu_seconds: float
    peak_memory_bytes: int
    unknowns: int
    counters: Mapping[str, int]


class StageLog:
    """Stage times and counters of one solve. The time of a nested stage does not count for its parent."""

    def __init__(self) -> None:
        self._tallies: dict[str, list[float]] = {}  # calls, wall seconds, processor seconds, bytes
        self._counters: dict[str, int] = {}
        self._open: list[str] = []
        self._start = self._mark = _now()

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time the body of a `with` statement under this name."""
        self._settle()
        self._open.append(name)
        self._tallies.setdefault(name, [0, 0.0, 0.0, 0])[0] += 1
        try:
            yield
        finally:
            self._settle()
            self._open.pop()

    def count(self, name: str, by: int = 1) -> None:
        """Add to a deterministic counter."""
        self._counters[name] = self._counters.get(name, 0) + by

    def hold(self, *sizes: int) -> None:
        """Add bytes of arrays to the memory of the open stage."""
        self._tallies[self._open[-1]][3] += sum(sizes)

    def _settle(self) -> None:
        """Add the time since the last call to the innermost open stage."""
        now = _now()
        if self._open:
            tally = self._tallies[self._open[-1]]
            tally[1] += now[0] - self._mark[0]
            tally[2] += now[1] - self._mark[1]
        self._mark = now

    @property
    def records(self) -> tuple[StageRecord, ...]:
        """One record for each stage, in order of first call."""
        return tuple(
            StageRecord(name=name, calls=int(calls), wall_seconds=wall, cpu_seconds=cpu, bytes=int(size))
            for name, (calls, wall, cpu, size) in self._tallies.items()
        )

    def cost(self, *, unknowns: int) -> Cost:
        """Cost since the log was created, for a system of ``unknowns`` unknowns."""
        wall, cpu = _now()
        return Cost(
            wall_seconds=wall - self._start[0],
            cpu_seconds=cpu - self._start[1],
            peak_memory_bytes=peak_memory_bytes(),
            unknowns=unknowns,
            counters=dict(self._counters),
        )


def _now() -> tuple[float, float]:
    """Wall and processor time [s]."""
    return time.perf_counter(), processor_seconds()


def processor_seconds() -> float:
    """Processor time of this process and, except on Windows, of those that it started and that have ended [s]."""
    if resource is None:
        return time.process_time()
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + children.ru_utime + children.ru_stime


def peak_memory_bytes() -> int:
    """Peak resident memory [bytes] of this process, plus that of the largest process it started; 0 on Windows."""
    if resource is None:
        return 0
    # `getrusage` counts bytes on macOS and kilobytes elsewhere.
    unit = 1 if sys.platform == "darwin" else 1024
    children = unit * resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss
    try:
        # On Linux `getrusage` also counts the program that started this one, so the kernel's own file is read.
        status = Path("/proc/self/status").read_bytes()
    except FileNotFoundError:
        return children + unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return children + 1024 * int(status.split(b"VmHWM:")[1].split(maxsplit=1)[0])

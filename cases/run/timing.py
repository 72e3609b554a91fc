"""Times: how they are sampled and summed up."""

import gc
import sys
import time
from collections.abc import Callable, Sequence

import numpy as np

from contact import InvalidInput

# Samples per time, which is their median: the range of six or more covers the true median with more than 95 %.
SAMPLES = 7
# Least seconds per sample, far more than a tick of the clock; faster calls are repeated within one. Half of it scatters
# more, twice of it takes twice the time.
SHORTEST = 0.1
# Calls of more than LONG seconds are sampled FEW_SAMPLES times: they scatter less than the times that are compared.
LONG, FEW_SAMPLES = 2.0, 3


def quartiles(samples: Sequence[float]) -> tuple[float, float, float]:
    """Return lower quartile, median and upper quartile of seconds.

    Raises:
        InvalidInput: Unless there is at least one sample and all are positive and finite.
    """
    values = np.asarray(samples, dtype=np.float64)
    if values.size == 0 or not np.all(np.isfinite(values) & (values > 0)):
        raise InvalidInput(f"times must be positive and finite, at least one, got {tuple(samples)}")
    lower, median, upper = np.quantile(values, [0.25, 0.5, 0.75]).tolist()
    return lower, median, upper


def timed_warm(call: Callable[[], object], *, samples: int = SAMPLES, shortest: float = SHORTEST) -> tuple[float, ...]:
    """Return seconds of a call that has been warmed up, one per sample.

    A call faster than ``shortest`` seconds is looped within each sample, one slower than ``LONG`` seconds is sampled
    ``FEW_SAMPLES`` times only.
    """
    first = _seconds(call, 1)
    if first >= shortest:
        # Such a call is not repeated within a sample: it is a sample already.
        repeats = (FEW_SAMPLES if first > LONG else samples) - 1
        return (first, *(_seconds(call, 1) for _ in range(repeats)))
    loops = int(np.ceil(shortest / max(first, 1e-9)))
    return tuple(_seconds(call, loops) for _ in range(samples))


def _seconds(call: Callable[[], object], loops: int) -> float:
    """Mean time of a call over ``loops`` repetitions [s], without garbage collection."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        start = time.perf_counter()
        for _ in range(loops):
            call()
        return (time.perf_counter() - start) / loops
    finally:
        if collecting:
            gc.enable()


PACKAGES = ("bem", "mdr", "fem_reference")


def clear_caches() -> None:
    """Empty every cache in the modules of methods: flat-punch data, tables, meshes, quadrature."""
    for name, module in tuple(sys.modules.items()):
        if name.partition(".")[0] in PACKAGES:
            for value in tuple(vars(module).values()):
                clear = getattr(value, "cache_clear", None)
                if callable(clear):
                    clear()

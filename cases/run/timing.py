"""Times: how they are sampled and summed up."""

import gc
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from contact import InvalidInput

# A time is the median of so many samples; of six and more the range covers the median
# with more than 95 %.
SAMPLES = 7
# A sample lasts at least so many seconds; anything faster is repeated within it. Chosen: it is far longer than a tick
# of the clock and short enough for many samples.
SHORTEST = 0.1
# Calls of more seconds (first number) are sampled less often (second number): they vary by less than what they are
# compared for.
LONG, FEW_SAMPLES = 2.0, 3


@dataclass(frozen=True, kw_only=True)
class Timing:
    """Seconds per call: all samples, their median, quartiles and minimum."""

    samples: tuple[float, ...]
    median: float
    lower_quartile: float
    upper_quartile: float
    minimum: float

    @property
    def spread(self) -> float:
        """Half the interquartile range over the median."""
        return (self.upper_quartile - self.lower_quartile) / 2 / self.median


def summed_up(samples: Sequence[float]) -> Timing:
    """Return median, quartiles and minimum.

    Raises:
        InvalidInput: unless there is at least one sample and all are positive and finite.
    """
    values = np.asarray(samples, dtype=np.float64)
    if values.size == 0 or not np.all(np.isfinite(values) & (values > 0)):
        raise InvalidInput(f"times must be positive and finite, at least one, got {tuple(samples)}")
    lower, median, upper = np.quantile(values, [0.25, 0.5, 0.75])
    return Timing(
        samples=tuple(values.tolist()),
        median=float(median),
        lower_quartile=float(lower),
        upper_quartile=float(upper),
        minimum=float(values.min()),
    )


def timed(call: Callable[[], object], *, samples: int = SAMPLES, shortest: float = SHORTEST) -> Timing:
    """Call once to warm up, then sample; a call faster than ``shortest`` seconds is looped within each sample."""
    _seconds(call, 1)
    return timed_warm(call, samples=samples, shortest=shortest)


def timed_warm(call: Callable[[], object], *, samples: int = SAMPLES, shortest: float = SHORTEST) -> Timing:
    """Sample a call that has been warmed up; one of more than ``LONG`` seconds ``FEW_SAMPLES`` times only."""
    first = _seconds(call, 1)
    if first >= shortest:
        # Such a call is not repeated within a sample: it is a sample already.
        left = (FEW_SAMPLES if first > LONG else samples) - 1
        return summed_up([first, *(_seconds(call, 1) for _ in range(left))])
    loops = int(np.ceil(shortest / max(first, 1e-9)))
    return summed_up([_seconds(call, loops) for _ in range(samples)])


def _seconds(call: Callable[[], object], loops: int) -> float:
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

"""Times: how they are sampled and summed up, and whether one version is slower than another."""

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
# Draws of the bootstrap that gives the 95 % interval of a ratio. Chosen; the seed is fixed, so the interval repeats.
_BOOTSTRAPS = 4000


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


@dataclass(frozen=True, kw_only=True)
class Slowdown:
    """Head over base: median ratio of paired times and its 95 % interval."""

    ratio: float
    lower: float
    upper: float


def slowdown(base: Sequence[float], head: Sequence[float], seed: int = 20230420) -> Slowdown:
    """Return the median log-ratio of alternately measured pairs, back in ratios, with a bootstrap 95 % interval.

    Raises:
        InvalidInput: with fewer than seven pairs, or with times that are not positive.
    """
    pairs = np.asarray([base, head], dtype=np.float64) if len(base) == len(head) else np.empty((2, 0))
    if pairs.shape[1] < SAMPLES or not np.all(np.isfinite(pairs) & (pairs > 0)):
        raise InvalidInput(f"need at least {SAMPLES} pairs of positive times, got {len(base)} and {len(head)}")
    logs = np.log(pairs[1] / pairs[0])
    draws = np.random.default_rng(seed).choice(logs, size=(_BOOTSTRAPS, logs.size))
    lower, upper = np.quantile(np.median(draws, axis=1), [0.025, 0.975])
    return Slowdown(ratio=float(np.exp(np.median(logs))), lower=float(np.exp(lower)), upper=float(np.exp(upper)))


def is_slower(measured: Slowdown, null_spread: float) -> bool:
    """Fail iff the lower bound of the ratio exceeds 1 + max(0.10, 3 d), d from a pair of identical versions."""
    return measured.lower > 1 + max(0.10, 3 * null_spread)


def is_ambiguous(measured: Slowdown, null_spread: float) -> bool:
    """Whether the interval contains the limit: it warns, and fails only under strict."""
    limit = 1 + max(0.10, 3 * null_spread)
    return measured.lower <= limit < measured.upper

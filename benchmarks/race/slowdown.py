"""How much slower one version is than another: the ratio of alternately measured times with its interval."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cases.run.timing import SAMPLES
from contact import InvalidInput

# Draws of the bootstrap that gives the 95 % interval of a ratio. Chosen; the seed is fixed, so the interval repeats.
_BOOTSTRAPS = 4000


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

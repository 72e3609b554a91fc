"""Is this version slower than another one?  Both solve the same scene alternately; a third process is the null test.

Base, head and base once more take turns, in reversed order every other time.  The two bases differ only by noise, and
that says how small a slowdown can be told from none on this machine just now.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from benchmarks.race.slowdown import Slowdown, is_ambiguous, is_slower, slowdown
from benchmarks.race.version import Subject, Version
from cases.judgement.rules.judgement import Judgement
from cases.results.records.claim import Verdict
from cases.results.status import Status
from cases.run.timing import SHORTEST

# A race takes so many pairs of times; the user may ask for more.
PAIRS = 15
# On a machine without noise this ratio of times passes: smaller slowdowns are not worth stopping a change for.
SLOWEST = 1.10


@dataclass(frozen=True, kw_only=True)
class Race:
    """CPU seconds of base, head and base again, taken in turns.

    Attributes:
        base: shape (n,), n pairs.
        head: shape (n,).
        again: the base a second time, in a process of its own.
    """

    base: tuple[float, ...]
    head: tuple[float, ...]
    again: tuple[float, ...]

    @property
    def measured(self) -> Slowdown:
        """Head over base."""
        return slowdown(self.base, self.head)

    @property
    def null_spread(self) -> float:
        """d: by how much the median ratio of identical code misses 1, and its standard error, added in squares.

        The standard error is a quarter of the 95 % interval.
        """
        null = slowdown(self.base, self.again)
        return math.hypot(math.log(null.ratio), math.log(null.upper / null.lower) / 4)

    @property
    def limit(self) -> float:
        """Largest ratio that passes."""
        return max(SLOWEST, 1 + 3 * self.null_spread)


def race(versions: Sequence[Version], what: Subject, *, pairs: int = PAIRS) -> Race:
    """Time base, head and base again on one subject.

    Args:
        versions: base, head, base again.
        what: what they solve.
        pairs: how often, at least seven.
    """
    once = [version.seconds(what, 1) for version in versions]
    solves = max(1, math.ceil(SHORTEST / max(min(once), 1e-6)))
    rounds = [_round(versions, what, solves, reverse=number % 2 == 1) for number in range(pairs)]
    base, head, again = (tuple(seconds) for seconds in zip(*rounds, strict=True))
    return Race(base=base, head=head, again=again)


def _round(versions: Sequence[Version], what: Subject, solves: int, *, reverse: bool) -> list[float]:
    order = range(len(versions))
    seconds = {i: versions[i].seconds(what, solves) for i in (reversed(order) if reverse else order)}
    return [seconds[i] for i in order]


def judge_race(finished: Race) -> Judgement:
    """PERF if the whole interval lies above the limit; a limit inside the interval warns."""
    measured, d = finished.measured, finished.null_spread
    if is_slower(measured, d):
        status, verdict = Status.PERF, Verdict.FAIL
    elif is_ambiguous(measured, d):
        status, verdict = Status.INCONCLUSIVE, Verdict.INCONCLUSIVE
    else:
        status, verdict = Status.PASS, Verdict.PASS
    message = (
        f"{measured.ratio:.3f} times the CPU seconds, 95 % interval {measured.lower:.3f} to {measured.upper:.3f}, "
        f"limit {finished.limit:.3f} (identical code differs by {100 * d:.1f} %)"
    )
    change = measured.ratio - 1
    fraction = max(change, 0.0) / (finished.limit - 1)
    return Judgement(status=status, verdict=verdict, observed=change, fraction=fraction, message=message)

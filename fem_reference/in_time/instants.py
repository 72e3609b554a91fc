"""Instants of prescribed histories: steps that grow from every given instant on, nested in those of the companion."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from contact.records.validation import FloatArray

# Octaves of steps in a segment, the fewest and the most, and those that all segments share: every scale of time after a
# bend has its own steps. Not measured: half and twice.
FEWEST, MOST, SHARED = 3, 12, 48


def segments(time: FloatArray, per_octave: int) -> list[FloatArray]:
    """Ends of the steps of each segment between given instants [s].

    M equal steps are followed by M twice as long, and so on.  With half of M they are every other one of these.

    Args:
        time: given instants [s].
        per_octave: M, even in an answer and half of that in its companion.
    """
    octaves = int(np.clip(SHARED // (len(time) - 1), FEWEST, MOST))
    steps = np.repeat(2.0 ** np.arange(octaves), per_octave)
    shares = np.cumsum(steps) / steps.sum()
    # The last instant is the given one, to the bit.
    shares[-1] = 1.0
    return [t0 * (1.0 - shares) + t1 * shares for t0, t1 in pairwise(time)]

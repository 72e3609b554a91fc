"""The one rule for every stated error: safety x |answer - answer at another resolution| + floor.

The other resolution is coarser in every quadrature, fit and iteration of a method. Two resolutions may agree by
accident in one state of a sequence. The largest change of the state and its two neighbours counts there.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from contact.records.validation import FloatArray

# Factor on the change between two resolutions. With 1 two equal errors of opposite sign are missed, with 4 stated
# errors are twice as wide.
SAFETY = 2.0


def stated_error(
    answer: ArrayLike, other: ArrayLike, *, scale: ArrayLike = 1.0, floor: ArrayLike = 0.0, sequence: bool = True
) -> FloatArray:
    """Relative error of an answer from the same answer at another resolution.

    Args:
        answer: Values, shape (n,).
        other: The same values at another resolution, shape (n,).
        scale: Magnitude to which the error is relative; where it is zero the error is absolute.
        floor: Relative rounding error.
        sequence: Whether the values belong to one path, in which a change may vanish by accident; False for loads that
            are independent of one another.

    Returns:
        SAFETY |answer - other|/scale + floor; in a sequence the largest change of a value and its two neighbours.
    """
    change = np.abs(np.atleast_1d(np.asarray(answer, dtype=np.float64) - np.asarray(other, dtype=np.float64)))
    size = np.abs(np.asarray(scale, dtype=np.float64))
    relative = np.atleast_1d(change / np.where(size == 0, 1.0, size))
    if sequence:
        relative = np.max([relative, np.append(relative[1:], 0.0), np.append(0.0, relative[:-1])], axis=0)
    return np.asarray(SAFETY * relative + np.asarray(floor, dtype=np.float64))

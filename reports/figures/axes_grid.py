"""Several pairs of axes in one figure: a grid without empty frames, and long lists in numbered parts."""

import math
from collections.abc import Iterator, Sequence
from typing import TypeVar

from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

T = TypeVar("T")


def axes_of(drawing: Drawing, panels: int, columns: int) -> list[Axes]:
    """So many axes in rows of `columns`; the rest of the last row stays empty."""
    axes = list(drawing.subplots(math.ceil(panels / columns), columns, squeeze=False).flat)
    for unused in axes[panels:]:
        unused.set_axis_off()
    return axes[:panels]


def numbered_parts(items: Sequence[T], length: int) -> Iterator[tuple[int, Sequence[T]]]:
    """The items in parts of at most `length`, each with its number from one."""
    return enumerate((items[start : start + length] for start in range(0, len(items), length)), start=1)

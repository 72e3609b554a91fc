"""Several pairs of axes in one figure: a grid without empty frames, and long lists cut into plates."""

import math
from collections.abc import Sequence
from typing import TypeVar

from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawing

T = TypeVar("T")


def panel_grid(panels: int, columns: int, panel_size: tuple[float, float]) -> tuple[Drawing, list[Axes]]:
    """A figure with so many axes in rows of `columns`; `panel_size` is width and height of one [inches]."""
    columns = min(columns, panels)
    rows = math.ceil(panels / columns)
    width, height = panel_size
    drawing = Drawing(figsize=(width * columns, height * rows), layout="constrained")
    axes = list(drawing.subplots(rows, columns, squeeze=False).flat)
    for unused in axes[panels:]:
        unused.set_axis_off()
    return drawing, axes[:panels]


def cut(items: Sequence[T], length: int) -> list[Sequence[T]]:
    """The items in parts of at most `length`."""
    return [items[start : start + length] for start in range(0, len(items), length)]

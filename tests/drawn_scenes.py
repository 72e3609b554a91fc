"""Measured profiles that fall here and there, drawn at random."""

import numpy as np

from contact import Tabulated


def falling_table(draw: np.random.Generator, size: float) -> tuple[Tabulated, float]:
    """A measured profile of about this size that falls here and there, and a depth; it may touch in several places."""
    count = int(draw.integers(5, 12))
    radii = np.append(0.0, np.cumsum(draw.uniform(0.2, 1.0, count))) * 10 ** draw.uniform(-1.0, 0.5) * size / count
    rises = draw.uniform(-0.6, 1.0, count)
    rises[0], rises[-1] = abs(rises[0]) + 0.05, 3.0
    heights = 1e-2 * radii[-1] * np.append(0.0, np.cumsum(rises)) / count
    return Tabulated(radii=radii, heights=heights), 0.3 * float(draw.uniform(0.05, 0.9) * heights.max())

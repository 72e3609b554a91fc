"""Where a contact ends, from what a grid knows well: force over depth.

The edge of a contact lies somewhere between cells, and the pressures beside it are the worst of all. Force and depth
are far better, and their slope is the contact's stiffness, dF_N/d(delta) = k_N(a), Eq. (5), whatever the profile and
the layer: from one depth to the next the edge adds nothing, since its pressure is zero. So a is the radius of the flat
punch that is as stiff. Measured over a step of 3 % either way the slope is right within about 0.01 s/a (s the cell
size) from thick to thin layers.

Cells under pressure show the edge to within a tenth of a cell: their area is that of a circle with radius a + 0.11 s,
because the complementarity problem keeps a cell while its centre lies within about 0.11 s outside the edge.
"""

from __future__ import annotations

from math import log, pi, sqrt
from typing import Final

import numpy as np

from contact.records.validation import FloatArray

# By so many cells the radius of the circle that has the area of the pressed cells is larger than the contact radius,
# as measured from 128 to 1024 cells (see above).
AREA_SHIFT: Final = 0.11
# Change of ln(depth), either way, over which the slope of force over depth is taken (see above).
STEP: Final = 0.03


def area_radius(pressure: FloatArray, cell_size: float) -> float:
    """a [m] from the area of the quadrant's cells under pressure; right within a twentieth of a cell."""
    return cell_size * (2.0 * sqrt(np.count_nonzero(pressure > 0.0) / pi) - AREA_SHIFT)


def slope(depth: float, force: float, less: float, more: float, step: float = STEP) -> float:
    """dF/d(delta) [N/m] from the forces at depth and at exp(-step) and exp(step) times it; exact for power laws."""
    return force / depth * log(more / less) / (2.0 * step)

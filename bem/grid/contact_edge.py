"""Where a contact ends, from what a grid knows well: force over depth.

The edge of a contact lies somewhere between cells, and the pressures beside it are the worst of all. Force and depth
are far better, and their slope is the contact's stiffness, dF_N/d(delta) = k_N(a), Eq. (5), whatever the profile and
the layer: from one depth to the next the edge adds nothing, since its pressure is zero. So a is the radius of the flat
punch that is as stiff. Measured over a step of 3 % either way the slope is right within about 0.01 s/a (s the cell
size) from thick to thin layers.

Cells under pressure show the edge to within a tenth of a cell: their area is that of a circle with radius a + 0.11 s,
because the complementarity problem keeps a cell while its centre lies within about 0.11 s outside the edge.

What the step itself makes of the slope goes with its square, as a wider step tells, unless that reaches over a place
where the profile is not analytic. On the half-space both are integrals over the profile, and on a layer the rest of
the wider step is of the same size: 0.7 to 3 times as large (a spline whose knot lies 1.8 % outside the edge, a/h = 0.1
to 3, nu = 0.12 and 1/2, 2026-11-23).
"""

from __future__ import annotations

from itertools import pairwise
from math import exp, log, pi, sqrt
from typing import Final, NamedTuple

import numpy as np

from bem.layer_equation.profiles.half_space_moment import half_space_depth, half_space_moment
from contact import Profile
from contact.records.validation import FloatArray

# By so many cells the radius of the circle that has the area of the pressed cells is larger than the contact radius,
# as measured from 128 to 1024 cells (see above).
AREA_SHIFT: Final = 0.11
# Change of ln(depth), either way, over which the slope of force over depth is taken (see above).
STEP: Final = 0.03
# So many times as far the slope is taken once more, on half as many cells, for what its step alone makes of it: the
# noise of the cells counts 1/15 of itself in that. Twice as far, where a third of it counts, radii became three times
# worse on uniform layers (60 scenes on 128 cells, `slope_scatter`, seed 4, 2026-11-22).
WIDER: Final = 4.0
# Share of the indenter's radius to which the half-space is followed: there 32 nodes of Gauss see the infinite slope at
# a sphere's equator from so far that they lose 1e-8 of an integral, as their rate of convergence tells.
REACH: Final = 0.999
# Halvings of an interval of at most two radii, which leave 1e-7 of the radius and the square of that of the force.
HALVINGS: Final = 24


class StepExcess(NamedTuple):
    """Relative error of a slope by its step.

    Attributes:
        own: Of `STEP`.
        told: The same, as a step `WIDER` times as far tells it.
    """

    own: float = 0.0
    told: float = 0.0


def area_radius(pressure: FloatArray, cell_size: float) -> float:
    """a [m] from the area of the quadrant's cells under pressure; right within a twentieth of a cell."""
    return cell_size * (2.0 * sqrt(np.count_nonzero(pressure > 0.0) / pi) - AREA_SHIFT)


def slope(depth: float, force: float, less: float, more: float, step: float = STEP) -> float:
    """dF/d(delta) [N/m] from the forces at depth and at exp(-step) and exp(step) times it; exact for power laws."""
    return force / depth * log(more / less) / (2.0 * step)


def told_excess(near: float, far: float) -> float:
    """Relative error of a slope by its step, which goes with its square, from the slope over a step `WIDER` as far."""
    return (far / near - 1.0) / (WIDER**2 - 1.0)


def excess_on_half_space(indenter: Profile, radius: float) -> StepExcess:
    """Of the same indenter pressed into the half-space to the same radius [m].

    None is known where it ends too soon, or where the half-space would be touched in several circles.
    """
    end = REACH * indenter.max_radius
    if not indenter.flat_radius < radius < end:
        return StepExcess()
    depth = half_space_depth(indenter, radius)
    deepest = min(2.0 * radius, end)
    if half_space_depth(indenter, deepest) < depth * exp(WIDER * STEP):
        return StepExcess()

    def load(change: float) -> float:
        """F/E* [m^2] at exp(change) times the depth; stationary in the radius, which is therefore found well enough."""
        other = depth * exp(change)
        low, high = indenter.flat_radius, deepest
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if half_space_depth(indenter, middle) >= other else (middle, high)
        return 2.0 * high * other - half_space_moment(indenter, high)

    loads = [load(change) for change in (-WIDER * STEP, -STEP, 0.0, STEP, WIDER * STEP)]
    if not all(0.0 < less < more for less, more in pairwise(loads)):
        return StepExcess()
    least, less, force, more, most = loads
    near, far = slope(depth, force, less, more), slope(depth, force, least, most, WIDER * STEP)
    return StepExcess(near / (2.0 * radius) - 1.0, told_excess(near, far))

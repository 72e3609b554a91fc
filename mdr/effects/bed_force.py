"""Where the front of a spring bed stands, and what the springs within it carry.

The front lies between two springs. Its place is extrapolated from the three outermost springs in contact, the force
integrated by the trapezoidal rule with end corrections and a parabola beyond the last spring: fourth order in the
spring distance while spring forces are smooth, second where old fronts have left a bend.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact.validation import FloatArray
from mdr.effects.spring_bed import BedState, SpringLaw

_FEW = 5


@dataclass(frozen=True)
class Bed:
    """Springs at equal distances of the front coordinate y.

    Attributes:
        y: Where they stand, shape (n,), from 0 on.
        profile: g [m].
        density: dk/dy, shape (n,).
        core: Stiffness k(b) within the flat end [N/m]; its springs all behave as the first one.
    """

    y: FloatArray
    profile: FloatArray
    density: FloatArray
    core: float

    def coarser(self) -> Bed:
        """Every second spring, if there are that many."""
        return self if self.y.size < _FEW else Bed(self.y[::2], self.profile[::2], self.density[::2], self.core)


def released_front(bed: Bed, touching: NDArray[np.bool_], forces: FloatArray) -> float:
    """y of the outermost contact where the spring force falls to zero, seen from inside."""
    last = int(np.flatnonzero(touching)[-1])
    inner = forces[max(last - 2, 0) : last + 1][::-1]
    return float(bed.y[last] + _way_to_zero(inner, float(bed.y[1]))) if last + 1 < bed.y.size else float(bed.y[-1])


def touched_front(bed: Bed, touching: NDArray[np.bool_], gaps: FloatArray) -> float:
    """y of the outermost contact where the gap outside closes, seen from outside; a dashpot's force ends abruptly."""
    first = int(np.flatnonzero(touching)[-1]) + 1
    outer = gaps[first : first + 3]
    return float(bed.y[first] - _way_to_zero(outer, float(bed.y[1]))) if first < bed.y.size else float(bed.y[-1])


def _way_to_zero(values: FloatArray, step: float) -> float:
    """How far before the first of up to three equidistant values their polynomial vanishes, at most one step."""
    if not np.isfinite(values).all():  # beyond a flat punch's rim the gap is infinite
        return step
    if values.size < 3:
        slope = (values[1] - values[0]) / step if values.size == 2 else values[0] / step
        way = values[0] / slope if slope > 0.0 else step
        return float(min(max(way, 0.0), step))
    slope = (-1.5 * values[0] + 2.0 * values[1] - 0.5 * values[2]) / step
    curvature = (values[0] - 2.0 * values[1] + values[2]) / step**2
    root = slope + np.sqrt(max(slope**2 - 2.0 * curvature * values[0], 0.0))
    way = 2.0 * values[0] / root if root > 0.0 else step
    return float(min(max(way, 0.0), step))


def total_force(bed: Bed, touching: NDArray[np.bool_], forces: FloatArray, y: float, at_front: float) -> float:
    """Force of all springs within the front at y, `at_front` the spring force there."""
    last = int(np.flatnonzero(touching)[-1])
    step, load = float(bed.y[1]), (bed.density * forces)[: last + 1]
    inner = step * (load.sum() - 0.5 * (load[0] + load[-1])) if last else 0.0
    if last >= 4:
        end = (1.5 * load[-1] - 2.0 * load[-2] + 0.5 * load[-3]) / step
        begin = (-1.5 * load[0] + 2.0 * load[1] - 0.5 * load[2]) / step
        inner -= step**2 / 12.0 * (end - begin)
    return float(bed.core * forces[0] + inner + _beyond(bed, load, last, y, at_front))


def _beyond(bed: Bed, load: FloatArray, last: int, y: float, at_front: float) -> float:
    """Integral from the last spring in contact to the front, by a parabola through its inner neighbour."""
    way, step = y - float(bed.y[last]), float(bed.y[1])
    if way <= 0.0:
        return 0.0
    edge = float(np.interp(y, bed.y, bed.density)) * at_front
    rise = (edge - load[-1]) / way
    bend = (rise - (load[-1] - load[-2]) / step) / (way + step) if last else 0.0
    return float(load[-1] * way + 0.5 * rise * way**2 - bend * way**3 / 6.0)


def carried(law: SpringLaw, bed: Bed, state: BedState, speed: float) -> tuple[float, float]:
    """Force [N] and front coordinate, which is negative where nothing touches."""
    if not state.touching.any():
        return 0.0, -1.0
    forces = law.force(state.surface, state.branches, speed)
    if bed.y.size < _FEW:  # a flat punch has no flank
        return bed.core * float(forces[0]), 0.0
    if law.viscosity == 0.0 or speed <= 0.0:
        y = released_front(bed, state.touching, forces)
        return total_force(bed, state.touching, forces, y, 0.0), y
    y = touched_front(bed, state.touching, state.surface + bed.profile - state.depth)
    return total_force(bed, state.touching, forces, y, _continued(bed, state.touching, forces, y)), y


def _continued(bed: Bed, touching: NDArray[np.bool_], forces: FloatArray, y: float) -> float:
    """The spring force at the front, from those inside."""
    last = int(np.flatnonzero(touching)[-1])
    if last < 2:
        return float(forces[last])
    share = (y - float(bed.y[last])) / float(bed.y[1])
    outer, middle, inner = forces[last], forces[last - 1], forces[last - 2]
    return float(outer + share * (outer - middle) + 0.5 * share * (share + 1.0) * (outer - 2.0 * middle + inner))

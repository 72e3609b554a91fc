"""Where the front of a spring bed stands, and what the springs within it carry.

The front lies between two springs. Its place is extrapolated from up to six springs on one side, the force
integrated by the trapezoidal rule with end corrections and parabolas beyond the last spring and beside bends, which
older fronts have left: fourth order in the spring distance.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.polynomials.root_steps import MOST_STEPS
from contact.records.validation import FloatArray
from mdr.history.springs_in_time import BedState, SpringLaw
from mdr.springs.error_model import EPS
from mdr.springs.table import PROFILE, STIFFENING, SpringTable

# Least number of springs of one section from which the place of the front is extrapolated.
_NEEDED = 3

# Most values that tell where a front stands; one more changes the place by roundings.
_MOST_VALUES = 2 * _NEEDED

# Fronts nearer to one another than this share of their y are one: what lies between carries nothing, and roundings part
# a front from an old place to which it has come back by up to 3e-14 (scenes 69 and 539 of seed 6215, 2026-11-26).
ONE_PLACE = 1e-9

_NONE = np.empty(0)


class FrontPlace(NamedTuple):
    """Where a front stands.

    Attributes:
        y: Its coordinate.
        left: How far off that may be, for all that the springs around tell.
    """

    y: float
    left: float = 0.0


@dataclass(frozen=True)
class SpringBed:
    """Springs at equal distances of the front coordinate y within each section between breakpoints of the profile.

    Attributes:
        y: Where they stand, shape (n,), from 0 on; a breakpoint has two, one for each side.
        radius: a [m] there.
        profile: g [m].
        density: dk/dy, shape (n,), seen from inside the section.
        core: Stiffness k(b) within the flat end [N/m]; its springs all behave as the first one.
        starts: Number of the first spring of each section.
        table: Where they are taken from; None for a flat punch.
    """

    y: FloatArray
    radius: FloatArray
    profile: FloatArray
    density: FloatArray
    core: float
    starts: tuple[int, ...] = (0,)
    table: SpringTable | None = None

    @property
    def has_flank(self) -> bool:
        """Whether there is more than a flat punch's end and its rim."""
        return self.y.size > 2

    def between(self, section: slice, y: FloatArray) -> FloatArray:
        """Profile and density at any places of a section, shape (2, n)."""
        assert self.table is not None
        rows = self.table.evaluate(y, section=self.starts.index(section.start))
        return np.stack([np.maximum(rows[PROFILE], 0.0), rows[STIFFENING]])

    def sections(self) -> list[slice]:
        """The springs of each section."""
        return [slice(*ends) for ends in pairwise((*self.starts, self.y.size))]

    def section(self, spring: int) -> slice:
        """The springs of one spring's section."""
        return next(own for own in self.sections() if spring < own.stop)

    def step(self, spring: int) -> float:
        """Distance of the springs around one of them."""
        start = self.section(spring).start
        return float(self.y[start + 1] - self.y[start])


def with_bend(bends: FloatArray, front: float) -> FloatArray:
    """The places where spring forces bend and one more, increasing; a front that is back at one of them adds none."""
    return bends if np.any(np.abs(bends - front) <= ONE_PLACE * abs(front)) else np.sort(np.append(bends, front))


def released_front(bed: SpringBed, touching: NDArray[np.bool_], forces: FloatArray) -> FrontPlace:
    """The outermost contact where the spring force falls to zero, seen from inside."""
    last = int(np.flatnonzero(touching)[-1])
    if last + 1 == bed.y.size:
        return FrontPlace(float(bed.y[-1]))
    start = bed.section(last).start
    if last - start < _NEEDED - 1 and start:
        return FrontPlace(_by_radius(bed, last, (start - 2, last), forces))
    way, left = way_to_zero(forces[start : last + 1][::-1], bed.step(last))
    return FrontPlace(float(bed.y[last]) + way, left)


def touched_front(bed: SpringBed, state: BedState) -> FrontPlace:
    """The outermost contact where the gap outside closes, seen from outside; a dashpot's force ends abruptly."""
    first = int(np.flatnonzero(state.touching)[-1]) + 1
    if first == bed.y.size:
        return FrontPlace(float(bed.y[-1]))
    own, gaps = bed.section(first), state.surface + bed.profile - state.depth
    around = slice(max(min(first, own.stop - _NEEDED) - _NEEDED, own.start), own.stop)
    around = slice(around.start, around.start + _MOST_VALUES)
    # Where nothing has been pressed, the gap goes on inside the contact.
    if around.stop <= own.stop and first > own.start and not state.surface[first : around.stop].any():
        share = _zero(bed.profile[around] - state.depth, first - 1 - around.start)
        return FrontPlace(float(bed.y[around.start] + share * bed.step(first)))
    if own.stop - first >= _NEEDED or own.stop == bed.y.size:
        way, left = way_to_zero(gaps[first : own.stop], bed.step(first))
        return FrontPlace(float(bed.y[first]) - way, left)
    return FrontPlace(_by_radius(bed, first - 1, (first, own.stop + 1), gaps))


def _zero(values: FloatArray, low: int) -> float:
    """Where the polynomial through values at 0, 1, 2 .. vanishes between low and the next of them, by secants."""
    differences = [float(np.diff(values, order)[0]) for order in range(values.size)]
    older, newer, before, now = float(low), low + 1.0, float(values[low]), float(values[low + 1])
    for _ in range(MOST_STEPS):
        if now in (0.0, before):
            break
        at = min(max(newer - now * (newer - older) / (now - before), low), low + 1.0)
        older, newer, before, now = newer, at, now, _polynomial(differences, at)
        if newer == older:
            break
    return newer


def _polynomial(differences: list[float], at: float) -> float:
    """By Newton's forward differences of all orders."""
    found = 0.0
    for order in reversed(range(len(differences))):
        found = differences[order] + found * (at - order) / (order + 1)
    return found


def _by_radius(bed: SpringBed, last: int, pair: tuple[int, int], values: FloatArray) -> float:
    """y where values of two springs on both sides of a breakpoint vanish: across it they are smooth in a, not in y."""
    (a, b), (u, v) = bed.radius[list(pair)], values[list(pair)]
    low, high = bed.radius[last], bed.radius[last + 1]
    zero = min(max(a + (b - a) * u / (u - v), low), high) if u != v else low
    start = bed.section(last + 1).start
    way = zero - float(bed.radius[start])
    return float(bed.y[start] + (np.sqrt(max(way, 0.0)) if bed.radius[start] > 0.0 else way))  # see `SpringTable`


def way_to_zero(values: FloatArray, step: float) -> tuple[float, float]:
    """How far before the first of equidistant values their polynomial vanishes, at most one step, and what is left.

    One value after the other is taken in as long as each changes the way by less than the one before.
    """
    # Beyond a flat punch's rim the gap is infinite.
    if not np.isfinite(values[:_NEEDED]).all():
        return step, 0.0
    differences = _differences(values[:_MOST_VALUES].tolist())
    way = _way(differences[:2], 0.5) if values.size > 1 else 1.0
    change, left = 1.0, 1.0
    for count in range(_NEEDED, len(differences) + 1):
        following = _way(differences[:count], way)
        before, change = change, abs(following - way)
        if change >= before > 0.0:
            left = change
            break
        way, left = following, change * min(change / max(before - change, EPS), 1.0)
    return way * step, left * step


def _differences(values: list[float]) -> list[float]:
    """Of orders 0, 1, 2 .., from the first value backwards: as `_polynomial` takes them before that value."""
    found = []
    while values:
        found.append(values[0])
        values = [one - other for one, other in pairwise(values)]
    return found


def _way(differences: list[float], way: float) -> float:
    """Steps, at most one, to where the polynomial of backward differences vanishes, by Newton's rule."""
    for _ in range(MOST_STEPS):
        value, slope, term, grown = 0.0, 0.0, 1.0, 0.0
        for order, difference in enumerate(differences):
            value, slope = value + term * difference, slope + grown * difference
            term, grown = term * (way + order) / (order + 1), (grown * (way + order) + term) / (order + 1)
        if slope >= 0.0:
            return 1.0 if value > 0.0 else 0.0
        following = min(max(way - value / slope, 0.0), 1.0)
        if abs(following - way) <= EPS:
            return following
        way = following
    return way


def total_force(
    bed: SpringBed, touching: NDArray[np.bool_], forces: FloatArray, front: tuple[float, float], bends: FloatArray
) -> FloatArray:
    """Force of all springs within the front, and how much of it may be wrong because no spring stands there.

    Args:
        bed: The springs.
        touching: Which of them are in contact.
        forces: What they carry.
        front: Its y, and the spring force there.
        bends: The y where spring forces bend, increasing, shape (bends,).
    """
    last, load = int(np.flatnonzero(touching)[-1]) if touching.any() else -1, bed.density * forces
    total = np.array([bed.core * float(forces[0]), 0.0])
    for one in bed.sections():
        if one.start > last:
            break
        own = slice(one.start, min(one.stop, last + 1))
        y, values = bed.y[own], load[own]
        end = float(y[-1]), float(values[-1])
        if one.stop > last and front[0] > end[0]:
            end = front[0], float(np.interp(front[0], bed.y[one], bed.density[one])) * front[1]
        # A front that is back at an old one, but for roundings, stands at it.
        inside = bends[(bends > y[0]) & (bends < (1.0 - ONE_PLACE) * end[0])].tolist()
        total += _bent_integral(y, values, bed.step(one.start), inside, end)
    return total


def _bent_integral(
    y: FloatArray, load: FloatArray, step: float, bends: list[float], end: tuple[float, float]
) -> FloatArray:
    """Integral of values at equidistant y to an end with its own value, piece by piece between bends, and its doubt.

    Between bends without a value in between the chord is taken: where a parabola that is level at one end would be
    right, a third of what is above the lower end is wrong.
    """
    total, start, low = np.zeros(2), 0, (float(y[0]), float(load[0]))
    stops = [*np.searchsorted(y, bends).tolist(), y.size]
    for number, stop in enumerate(stops):
        own = load[start:stop]
        high = end
        if number < len(bends):
            pieces = slice(start, stop), slice(stop, stops[number + 1])
            high = bends[number], _at_bend(y, load, bends[number], pieces, end)
        if own.size:
            total[0] += _beyond(own[::-1], step, float(y[start]) - low[0], low[1])
            total[0] += _integral(own, step) + _beyond(own, step, high[0] - float(y[stop - 1]), high[1])
        else:
            total += 0.5 * (high[0] - low[0]) * np.array([low[1] + high[1], abs(low[1] - high[1]) / 3.0])
        start, low = stop, high
    return total


def _at_bend(
    y: FloatArray, load: FloatArray, bend: float, pieces: tuple[slice, slice], end: tuple[float, float]
) -> float:
    """Value at a bend, from values of the piece on one of its sides, or from its neighbours where these are too few."""
    (inner, outer), step = (load[piece] for piece in pieces), float(y[1] - y[0]) if y.size > 1 else 1.0
    last, first = pieces[0].stop - 1, pieces[1].start
    if inner.size >= _NEEDED:
        return _extrapolated(inner[::-1], (bend - float(y[last])) / step)
    if outer.size >= _NEEDED:
        return _extrapolated(outer, (float(y[first]) - bend) / step)
    beyond = (float(y[first]), float(load[first])) if first < y.size else end
    return float(np.interp(bend, [float(y[last]), beyond[0]], [float(load[last]), beyond[1]]))


def _integral(load: FloatArray, step: float) -> float:
    """Trapezoidal rule with end corrections."""
    inner = step * (load.sum() - 0.5 * (load[0] + load[-1])) if load.size > 1 else 0.0
    if load.size >= _NEEDED:
        end = (1.5 * load[-1] - 2.0 * load[-2] + 0.5 * load[-3]) / step
        begin = (-1.5 * load[0] + 2.0 * load[1] - 0.5 * load[2]) / step
        inner -= step**2 / 12.0 * (end - begin)
    return float(inner)


def _beyond(load: FloatArray, step: float, way: float, edge: float) -> float:
    """Integral from the last of equidistant values to an edge, by a parabola through the last but one."""
    if way <= 0.0:
        return 0.0
    rise = (edge - load[-1]) / way
    bend = (rise - (load[-1] - load[-2]) / step) / (way + step) if load.size > 1 else 0.0
    return float(load[-1] * way + 0.5 * rise * way**2 - bend * way**3 / 6.0)


def front(
    law: SpringLaw, bed: SpringBed, state: BedState, forces: FloatArray, speed: float
) -> tuple[FrontPlace, float]:
    """The front, and the spring force there [m], which only a bare dashpot leaves.

    A front that advances lies where the gap outside closes: nothing has happened there of late, while the forces just
    inside, of springs touched one after the other, bend within the way that it goes in a relaxation time. A front that
    recedes lies where the forces inside vanish, for the same reason turned around.
    """
    if advances(law, bed, state, speed):
        place = touched_front(bed, state)
        return place, _continued(bed, state.touching, forces, place.y) if law.viscosity > 0.0 else 0.0
    # Nothing is in contact beyond where an undeformed surface would be.
    w, place = state.depth - bed.profile, released_front(bed, state.touching, forces)
    return (min(place, released_front(bed, w > 0.0, w)) if np.any(w > 0.0) else place), 0.0


def advances(law: SpringLaw, bed: SpringBed, state: BedState, speed: float) -> bool:
    """Whether the indenter reaches springs outside the front."""
    outside = int(np.flatnonzero(state.touching)[-1]) + 1
    return outside == bed.y.size or law.outruns(speed, float(state.surface[outside]), state.strains[:, outside])


def carried(
    law: SpringLaw, bed: SpringBed, state: BedState, speed: float, bends: FloatArray = _NONE
) -> tuple[float, float, float, float]:
    """Force [N]; front coordinate, which is negative where nothing touches; how far no spring tells these two.

    Args:
        law: Of the springs.
        bed: The springs.
        state: What they are in.
        speed: Of the depth [m/s].
        bends: Where fronts stood when that speed changed, increasing: spring forces bend there.
    """
    if not state.touching.any():
        return 0.0, -1.0, 0.0, 0.0
    forces = law.force(state.surface, state.strains, speed)
    if not bed.has_flank:
        return bed.core * float(forces[0]), 0.0, 0.0, 0.0
    (y, left), at_front = front(law, bed, state, forces, speed)
    force, doubt = total_force(bed, state.touching, forces, (y, at_front), bends).tolist()
    return force, y, doubt, left


def _continued(bed: SpringBed, touching: NDArray[np.bool_], forces: FloatArray, y: float) -> float:
    """The spring force at the front, from those inside."""
    last = int(np.flatnonzero(touching)[-1])
    if last - bed.section(last).start < _NEEDED - 1:
        return float(forces[last])
    return _extrapolated(forces[last - 2 : last + 1][::-1], (y - float(bed.y[last])) / bed.step(last))


def _extrapolated(values: FloatArray, share: float) -> float:
    """The parabola through the first three values, a share of their distance before the first."""
    outer, middle, inner = values[:_NEEDED]
    return float(outer + share * (outer - middle) + 0.5 * share * (share + 1.0) * (outer - 2.0 * middle + inner))

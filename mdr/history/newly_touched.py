"""What the springs carry that an advancing front has touched since the speed of the depth last changed.

Just inside such a front a branch of short relaxation time is still being strained: spring forces bend within the way
that the front goes in that time, which may be far less than the distance of the springs. They are therefore integrated
on springs of their own, which crowd towards the front.
"""

from __future__ import annotations

import numpy as np

from bem.polynomials.gauss_panels import gauss_nodes
from contact.records.validation import FloatArray
from mdr.history.contact_edge import ONE_PLACE, SpringBed, advances, carried, total_force
from mdr.history.own_springs import OwnSprings, Turn
from mdr.history.springs_in_time import BedState, SpringLaw

# Panels, each a quarter as long as all beyond it: the last is 4e-6 of the way, and what bends within it carries less
# than a rounding. On a panel so many nodes leave 1e-10 of an exponential, whose size falls with its steepness.
_PANELS, _NODES = 10, 16
_SHRINKING = 0.25


def carried_since(
    turns: list[Turn], law: SpringLaw, bed: SpringBed, now: tuple[float, BedState], bends: FloatArray
) -> tuple[float, float, float, float]:
    """As `carried`, at a depth that has moved at one speed since the last turn, and with a front that advances exact.

    Args:
        turns: When the speed of the depth has changed, from the first instant on.
        law: Of the springs.
        bed: The springs.
        now: Instant [s] and state of the bed.
        bends: Where fronts stood at the turns, increasing: spring forces bend there.
    """
    time, state = now
    speed = (state.depth - turns[-1].state.depth) / (time - turns[-1].time)
    free = int(np.flatnonzero(state.touching)[-1]) + 1 if state.touching.any() else bed.y.size
    if law.is_elastic or free in (*bed.starts, bed.y.size) or not bed.has_flank:
        return carried(law, bed, state, speed, bends)
    section, forces = bed.section(free), law.force(state.surface, state.strains, speed)
    own = OwnSprings(law, bed, section, turns, (time, state.depth))
    forward = advances(law, bed, state, speed)
    y, left = own.front(free, advances=forward)
    if not forward:
        force, doubt = total_force(bed, state.touching, forces, (y, 0.0), bends).tolist()
        return force, y, doubt, left
    start = min(max(float(bed.y[section.start]), turns[-1].front, *bends[bends < (1.0 - ONE_PLACE) * y]), y)
    places, weights = _crowded(start, y)
    new = own.at(places)
    inner = state.touching & (bed.y < start)
    force, doubt = total_force(bed, inner, forces, (start, float(new.forces[0])), bends).tolist()
    return force + float(weights @ (new.density * new.forces)), y, doubt, left


def _crowded(start: float, end: float) -> tuple[FloatArray, FloatArray]:
    """The start and Gauss nodes on panels that shrink towards the end, with their weights."""
    left = np.append(end - (end - start) * _SHRINKING ** np.arange(_PANELS), end)
    nodes, weights = gauss_nodes(_NODES)
    widths = np.diff(left)[:, None]
    places = (left[:-1, None] + widths * nodes).ravel()
    return np.append(start, places), np.append(0.0, (widths * weights).ravel())

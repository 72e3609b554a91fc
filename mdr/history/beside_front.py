"""What springs carry beside a front, and where it is, at a prescribed depth.

Where fronts have been of late, spring forces bend within the way that a front goes in the shortest relaxation time,
which may be far less than the distance of the springs: inside a front that advances or has just advanced a branch is
still being strained, and what has just been let go bends the surface outside. From the last few fronts on, forces are
therefore integrated on springs of their own, which crowd towards each of them.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from bem.polynomials.gauss_panels import gauss_nodes
from contact.records.validation import FloatArray
from mdr.history.contact_edge import ONE_PLACE, SpringBed, advances, carried, total_force
from mdr.history.own_springs import OwnSprings, Turn
from mdr.history.springs_in_time import BedState, SpringLaw

# Panels from the middle to each end, each a quarter as long as all beyond it: the last is 2e-6 of the whole, and what
# bends within it carries less than a rounding. On a panel so many nodes leave 1e-10 of an exponential, whose size falls
# with its steepness.
_PANELS, _NODES = 10, 16
_SHRINKING = 0.25
# Turns whose fronts still bend forces within less than the springs see; chosen.
_TURNS = 3
# Most pieces between fronts that are integrated so; chosen, for the time it takes.
_MOST_PIECES = 6


def carried_since(
    turns: list[Turn], law: SpringLaw, bed: SpringBed, now: tuple[float, BedState], bends: FloatArray
) -> tuple[float, float, float, float]:
    """As `carried`, at a depth that has moved at one speed since the last turn.

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
    section = bed.section(free)
    own = OwnSprings(law, bed, section, turns, (time, state.depth))
    y, left = own.front(free, advances=advances(law, bed, state, speed))
    ends = _ends(float(bed.y[section.start]), y, [turn.front for turn in turns[-_TURNS:]], bends)
    places, weights = _crowded(ends)
    found = own.at(places)
    inner, forces = state.touching & (bed.y < ends[0]), law.force(state.surface, state.strains, speed)
    force, doubt = total_force(bed, inner, forces, (ends[0], float(found.forces[0])), bends).tolist()
    return force + float(weights @ (found.density * found.forces)), y, doubt, left


def _ends(start: float, y: float, recent: list[float], bends: FloatArray) -> list[float]:
    """Ends of the pieces from below the lowest of the recent fronts to the front y, in a section from its start on."""
    within = bends[(bends > start + ONE_PLACE * y) & (bends < (1.0 - ONE_PLACE) * y)].tolist()
    ends = [start, *within, y]
    first = max(int(np.searchsorted(ends, (1.0 - ONE_PLACE) * min(*recent, y))) - 1, 0)
    return ends[max(first, len(ends) - 1 - _MOST_PIECES) :]


def _crowded(ends: list[float]) -> tuple[FloatArray, FloatArray]:
    """The start and Gauss nodes on panels that shrink towards both ends of each piece, with their weights."""
    shares = 0.5 * _SHRINKING ** np.arange(_PANELS)
    shares = np.concatenate([[0.0], shares[::-1], 1.0 - shares[1:], [1.0]])
    cuts = np.concatenate([[ends[0]], *(low + (high - low) * shares[1:] for low, high in pairwise(ends))])
    nodes, weights = gauss_nodes(_NODES)
    widths = np.diff(cuts)[:, None]
    places = (cuts[:-1, None] + widths * nodes).ravel()
    return np.append(ends[0], places), np.append(0.0, (widths * weights).ravel())

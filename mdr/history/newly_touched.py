"""What the springs carry that an advancing front has touched since the speed of the depth last changed.

Just inside such a front a branch of short relaxation time is still being strained: spring forces bend within the way
that the front goes in that time, which may be far less than the distance of the springs. They are therefore integrated
on springs of their own, which crowd towards the front. Until they were touched these stood between free springs, whose
state is smooth between bends.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from bem.polynomials.gauss_panels import gauss_nodes
from contact.records.validation import FloatArray
from mdr.history.contact_edge import ONE_PLACE, SpringBed, advances, carried, total_force
from mdr.history.springs_in_time import BedState, SpringLaw, advance

# Panels, each a quarter as long as all beyond it: the last is 4e-6 of the way, and what bends within it carries less
# than a rounding. On a panel so many nodes leave 1e-10 of an exponential, whose size falls with its steepness.
_PANELS, _NODES = 10, 16
_SHRINKING = 0.25
# Springs that a cubic spline takes.
_FEWEST = 4


@dataclass(frozen=True)
class Turn:
    """When the speed of the depth changed last.

    Attributes:
        time: Then [s].
        state: Of the bed.
        front: Its y, negative where nothing touched.
    """

    time: float
    state: BedState
    front: float


@dataclass(frozen=True)
class NewlyTouched:
    """The springs between an older front and the front.

    Attributes:
        start: The older front, or the bend or breakpoint beyond it.
        at_start: Spring force there [m].
        force: Of all springs beyond [N].
    """

    start: float
    at_start: float
    force: float


def carried_since(
    turn: Turn, law: SpringLaw, bed: SpringBed, now: tuple[float, BedState], bends: FloatArray
) -> tuple[float, float, float, float]:
    """As `carried`, at a depth that has moved at one speed since a turn."""
    speed, state = _speed(turn, now), now[1]
    force, y, doubt, hidden = carried(law, bed, state, speed, bends)
    if y > 0.0 and law.weights.size and advances(law, bed, state, speed):
        new = newly_touched(law, bed, turn, now, y=y, bends=bends)
        if new is not None:
            forces = law.force(state.surface, state.strains, speed)
            inner = state.touching & (bed.y < new.start)
            force, doubt = total_force(bed, inner, forces, (new.start, new.at_start), bends).tolist()
            force += new.force
    return force, y, doubt, hidden


def newly_touched(
    law: SpringLaw, bed: SpringBed, turn: Turn, now: tuple[float, BedState], *, y: float, bends: FloatArray
) -> NewlyTouched | None:
    """The force beyond the older front; None where spring forces are smooth, or too few springs tell.

    Args:
        law: Of the springs.
        bed: The springs.
        turn: When the depth began to move at the present speed.
        now: Instant [s] and state of the bed.
        y: The front, which advances.
        bends: Where fronts stood when the speed changed.
    """
    time, state = now
    section = bed.section(int(np.searchsorted(bed.y, y)) - 1)
    older = bends[bends < (1.0 - ONE_PLACE) * y]
    start = max(float(bed.y[section.start]), turn.front, *older)
    if start >= (1.0 - ONE_PLACE) * y:
        return None
    beyond = np.append(bends[bends > (1.0 + ONE_PLACE) * y], np.inf)[0]
    own = np.flatnonzero((bed.y[section] > start) & (bed.y[section] < beyond)) + section.start
    if own.size < _FEWEST:
        return None
    places, weights = _crowded(start, y)
    profile, density = CubicSpline(bed.y[section], np.stack([bed.profile[section], bed.density[section]], 1))(places).T
    free = np.vstack([turn.state.surface, turn.state.strains])[:, own]
    surface, *strains = CubicSpline(bed.y[own], free, axis=1)(places)
    before = BedState(turn.state.depth, np.zeros(places.size, dtype=np.bool_), surface, np.array(strains))
    after = advance(law, profile, before, state.depth, time - turn.time)
    forces = np.where(after.touching, law.force(after.surface, after.strains, _speed(turn, now)), 0.0)
    return NewlyTouched(start, float(forces[0]), float(weights @ (density * forces)))


def _speed(turn: Turn, now: tuple[float, BedState]) -> float:
    return (now[1].depth - turn.state.depth) / (now[0] - turn.time)


def _crowded(start: float, end: float) -> tuple[FloatArray, FloatArray]:
    """The start and Gauss nodes on panels that shrink towards the end, with their weights."""
    left = np.append(end - (end - start) * _SHRINKING ** np.arange(_PANELS), end)
    nodes, weights = gauss_nodes(_NODES)
    widths = np.diff(left)[:, None]
    places = (left[:-1, None] + widths * nodes).ravel()
    return np.append(start, places), np.append(0.0, (widths * weights).ravel())

"""Springs at places of their own, followed from a turn at which nothing had touched them yet.

The springs of a bed are as far apart as smooth forces ask. Beside a front that creeps back over what was let go moments
before, gaps and forces bend within far less, which no spring of any bed sees. But each spring is independent of all
others: one at any place is followed through the history as exactly as those of the bed.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from contact.records.validation import FloatArray
from mdr.history.contact_edge import FrontPlace, SpringBed, way_to_zero
from mdr.history.springs_in_time import BedState, SpringLaw, advance, undeformed

# What was let go longer ago than so many turns is taken to have become smooth; chosen.
_MOST_TURNS = 12
# Springs between the two of the bed beside the front, and beyond them as many as tell the place of a front.
_WITHIN, _BEYOND = 16, 6
# Springs that a cubic takes.
_FEWEST = 4
# Rounds of springs that stand so many times as dense; 12 times is far below roundings.
_MOST_ROUNDS = 12
# Share of a front's y to which its place is told; chosen, close to roundings.
_TOLD = 1e-13


@dataclass(frozen=True)
class Turn:
    """When the speed of the depth changed.

    Attributes:
        time: Then [s].
        state: Of the bed.
        front: Its y, negative where nothing touched.
    """

    time: float
    state: BedState
    front: float


@dataclass(frozen=True)
class Springs:
    """Some springs now.

    Attributes:
        touching: Which are in contact, shape (n,).
        forces: What they carry [m], shape (n,).
        gaps: Between surface and indenter [m], shape (n,).
        density: dk/dy, shape (n,).
    """

    touching: NDArray[np.bool_]
    forces: FloatArray
    gaps: FloatArray
    density: FloatArray


@dataclass(frozen=True)
class OwnSprings:
    """Springs at any places of one section, at a depth that has moved at one speed since the last turn.

    Attributes:
        law: Of the springs.
        bed: The springs of the bed.
        section: Those of the section.
        turns: When the speed of the depth has changed, from the first instant on.
        now: Instant [s] and depth [m].
    """

    law: SpringLaw
    bed: SpringBed
    section: slice
    turns: list[Turn]
    now: tuple[float, float]

    def at(self, y: FloatArray) -> Springs:
        """Springs at increasing places, shape (n,)."""
        profile, density = self.bed.between(self.section, y)
        (first, state), speed = self._at_start(y, profile), 0.0
        instants = [(turn.time, turn.state.depth) for turn in self.turns[first:]]
        for (time, before), (later, depth) in pairwise([*instants, self.now]):
            speed = (depth - before) / (later - time)
            state = advance(self.law, profile, state, depth, later - time)
        forces = np.where(state.touching, self.law.force(state.surface, state.strains, speed), 0.0)
        return Springs(state.touching, forces, state.surface + profile - state.depth, density)

    def front(self, free: int, *, advances: bool) -> FrontPlace:
        """Where contact ends before the first free spring of the bed, between springs that stand denser and denser.

        Where the front advances the gaps beyond close there, where it recedes the forces within vanish.
        """
        low, high = self.bed.y[free - 1 : free + 1].tolist()
        within = self.bed.y[[self.section.start, self.section.stop - 1]]
        beyond = np.arange(_WITHIN + _BEYOND) if advances else np.arange(-_BEYOND, _WITHIN + 1)
        for _ in range(_MOST_ROUNDS):
            step = (high - low) / _WITHIN
            y = low + step * beyond
            y = y[(y >= within[0]) & (y <= within[1])]
            found = self.at(y)
            if not found.touching.any():
                return FrontPlace(float(y[0]), float(high - y[0]))
            first = int(np.flatnonzero(found.touching)[-1]) + 1
            if first == y.size:
                return FrontPlace(float(y[-1]))
            low, high = y[first - 1 : first + 1].tolist()
            way, left = way_to_zero(found.gaps[first:] if advances else found.forces[first - 1 :: -1], step)
            if left <= _TOLD * high:
                break
        return FrontPlace(high - way if advances else low + way, left)

    def _not_yet_touched(self, around: slice) -> int:
        """The last turn at which these springs of the bed had not been touched; else the oldest there is."""
        oldest = max(len(self.turns) - _MOST_TURNS, 0)
        turns = range(oldest, len(self.turns))
        return next((n for n in reversed(turns) if not self.turns[n].state.surface[around].any()), oldest)

    def _at_start(self, y: FloatArray, profile: FloatArray) -> tuple[int, BedState]:
        """A turn, and the state then: undeformed, as at the first, or else smooth on each side of the front."""
        low, high = self.section.start + np.searchsorted(self.bed.y[self.section], y[[0, -1]])
        around = slice(max(int(low) - 1, self.section.start), int(high) + 1)
        number = self._not_yet_touched(around)
        turn = self.turns[number]
        if number == 0 or not turn.state.surface[around].any():
            return number, undeformed(self.law, profile, turn.state.depth)
        own = np.arange(self.section.start, self.section.stop)
        free = own[self.bed.y[own] > turn.front]
        own = free if free.size >= _FEWEST and y[0] > turn.front else own
        found = np.vstack([turn.state.surface, turn.state.strains])[:, own]
        surface, *strains = CubicSpline(self.bed.y[own], found, axis=1)(y)
        touching = y < turn.front
        surface = np.where(touching, turn.state.depth - profile, surface)
        return number, BedState(turn.state.depth, touching, surface, np.array(strains).reshape(-1, y.size))

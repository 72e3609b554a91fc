"""Many impacts from first touch to the loss of contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact import NotConvergedError
from contact.records.validation import FloatArray, IntArray
from mdr.impact.collocation import EndCondition, Integrate, Problem, Trajectory
from mdr.impact.collocation_step import STAGES, Course
from mdr.impact.equations import ImpactBatch, Pressing, Receding, drift, outline
from mdr.impact.memory import Memory, memory_of

# Events that end a section of the way in.
TURN, SECTION_END = 0, 1


# First step for a tolerance of one, in units of the way that an elastic impact of the same energy goes. At a tip whose
# power is no integer both runs err alike on it: with 1.5, 96 to 99 % of each of the five outcomes were covered at 1e-9,
# with this 99 to 100 %, for as many sweeps (120 random impacts, seed 7301, 2026-11-23).
_FIRST_STEP = 0.75

# First step of the way out over the last one of the way in: the front leaves its turn faster than it came. Chosen.
_AFTER_TURN = 0.4
# Each impact is integrated a second time with this multiple of its tolerance; the difference tells the error. Two steps
# as alike as these agree by accident no more often than with 5, which told 4 to 6 times the error in the median, this 2
# (300 random impacts, seeds 9 and 31, 2026-11-23).
COARSER = 2.0


class TableTooShort(NotConvergedError):
    """The front ran beyond the largest radius of the spring table."""


@dataclass(frozen=True)
class Leg:
    """One section of the way in, or the way back through one step of it, of the lanes that went there."""

    lanes: IntArray
    section: int
    trajectory: Trajectory
    memory: Memory | None
    step: int = 0

    def of(self, lane: int) -> Leg | None:
        """The part of one lane, if it went there."""
        here = np.flatnonzero(self.lanes == lane)
        if not here.size:
            return None
        at = int(here[0])
        memory = self.memory.of(slice(at, at + 1)) if self.memory else None
        return Leg(np.zeros(1, dtype=np.intp), self.section, self.trajectory.of(at), memory, self.step)


@dataclass(frozen=True)
class Impacts:
    """Dimensionless impacts, each of them twice: n lanes as asked, and n with a coarser tolerance.

    Attributes:
        lanes: All 2 n.
        way_in: Sections of the way in, in order.
        way_out: Sections of the way out, in order.
        turn: State at the turn, shape (m, 2 n).
        end: State at the loss of contact, shape (m', 2 n).
        within: Sum of the local errors within steps, shape (2 n,).
        drift: Time from there to where the last spring's force is zero, shape (2 n,).
    """

    lanes: ImpactBatch
    way_in: tuple[Leg, ...]
    way_out: tuple[Leg, ...]
    turn: FloatArray
    end: FloatArray
    within: FloatArray
    drift: FloatArray


def impacts(lanes: ImpactBatch, integrate: Integrate, *, tolerance: float) -> Impacts:
    """Integrate all lanes.

    Args:
        lanes: The impacts.
        integrate: By what.
        tolerance: Local error per step, in the impact's units.

    Raises:
        TableTooShort: If a front runs beyond the spring table.
        NotConvergedError: If an impact does not end.
    """
    twice = lanes.take(np.tile(np.arange(lanes.count), 2))
    run = _Motion(twice, integrate, np.repeat([tolerance, COARSER * tolerance], lanes.count))
    way_in, turn, turned_in = run.press()
    way_out, end = run.recede(way_in, turn, turned_in)
    within = np.zeros(twice.count)
    for leg in way_in + way_out:
        within[leg.lanes] += leg.trajectory.error
    return Impacts(twice, way_in, way_out, turn, end, within, drift(twice, way_in[0].memory, end))


class _Motion:
    """IntArray under way; `size` is each lane's next trial step."""

    def __init__(self, lanes: ImpactBatch, integrate: Integrate, tolerance: FloatArray) -> None:
        self.lanes, self.integrate, self.tolerance = lanes, integrate, tolerance
        self.size = _FIRST_STEP * tolerance ** (1.0 / STAGES)
        self.course = Course.unknown(0, self.size)

    def press(self) -> tuple[tuple[Leg, ...], FloatArray, IntArray]:
        """The way in, section by section; the state at the turn and the section where each lane turned."""
        lanes, ends = self.lanes, self.lanes.table.section_ends
        state = np.zeros((3 + 2 * lanes.branches, lanes.count))
        state[2] = 1.0
        self.course = Course.unknown(state.shape[0], self.size)
        turned_in, going, legs = np.full(lanes.count, ends.size - 1), np.arange(lanes.count), []
        for section in range(ends.size - 1):
            own = lanes.take(going)
            events = EndCondition(2, np.zeros(going.size), -1), EndCondition(0, ends[section + 1] / own.units[6], +1)
            trajectory = self._integrate(Pressing(own, section), state, going, events)
            legs.append(Leg(going, section, trajectory, self._memory(trajectory)))
            turned_in[going[trajectory.ended_by == TURN]] = section
            going = going[trajectory.ended_by != TURN]
            if not going.size:
                return tuple(legs), state, turned_in
        raise TableTooShort("an impact presses beyond the radius up to which springs were tabulated")

    def recede(
        self, way_in: tuple[Leg, ...], turn: FloatArray, turned_in: IntArray
    ) -> tuple[tuple[Leg, ...], FloatArray]:
        """The way out, back through the same sections, and the state at its end."""
        lanes, legs = self.lanes, []
        state = np.zeros((4 + lanes.branches, lanes.count))
        state[:2], state[4:] = turn[:2], turn[outline(lanes.branches)[0]]
        self.size *= _AFTER_TURN
        self.course = Course.unknown(state.shape[0], self.size)
        for leg in reversed(way_in):
            starting = np.flatnonzero(turned_in == leg.section)
            state[2, starting] = lanes.take(starting).springs(turn[:1, starting], leg.section, 1)[0, 0]
            # On the way in it is the time without g.
            state[1, starting] += state[2, starting]
            steps = leg.memory.low.shape[0] if leg.memory else 1
            legs += [self._back(leg, step, state) for step in reversed(range(steps))]
        return tuple(legs), state

    def _back(self, leg: Leg, step: int, state: FloatArray) -> Leg:
        """Back through one step of the way in, where memory is one polynomial, or through a whole section without."""
        there = np.flatnonzero(leg.trajectory.counts > step)
        going = leg.lanes[there]
        own = self.lanes.take(going)
        memory = leg.memory.take(there) if leg.memory else None
        target = memory.low[step] if memory else self.lanes.table.section_ends[leg.section] / own.units[6]
        problem = Receding(own, leg.section, memory, step)
        trajectory = self._integrate(problem, state, going, (EndCondition(0, target, -1),))
        return Leg(going, leg.section, trajectory, memory, step)

    def _integrate(
        self, problem: Problem, state: FloatArray, going: IntArray, events: tuple[EndCondition, ...]
    ) -> Trajectory:
        """Advance some lanes to their events, in place."""
        trajectory = self.integrate(
            problem,
            state[:, going],
            events,
            tolerance=self.tolerance[going],
            first_step=self.size[going],
            course=self.course.take(going),
        )
        state[:, going], self.size[going] = trajectory.final, trajectory.next_step
        self.course.put(going, trajectory.course)
        return trajectory

    def _memory(self, trajectory: Trajectory) -> Memory | None:
        """The time and what had relaxed: nothing to remember without branches."""
        if not self.lanes.branches:
            return None
        return memory_of(trajectory, [1, *range(3, trajectory.final.shape[0])], turning_event=TURN)

"""Trajectories by the compiled walk, and by NumPy those of lanes that it leaves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact.records.validation import FloatArray, IntArray
from mdr.impact import collocation, collocation_step
from mdr.impact.collocation import EndCondition, Trajectory
from mdr.impact.collocation_step import Chain, Course, Derivative
from mdr.impact.compiled import walk
from mdr.impact.compiled.arguments import Motion, equations_of

# Steps of a lane and leg that there is room for at first; a walk that needs more begins again with four times as many.
# Chosen: the impact of Fig. 12 to 1e-9 takes 23, on two lanes and all legs together.
_ROOM, _MORE = 16, 4
_RULE = np.concatenate(
    [
        collocation_step.TO_STAGES,
        collocation_step.ENDS,
        collocation_step.CHANGE,
        collocation_step.ANALYSIS[-2:],
        collocation_step.ONWARD,
        collocation_step.WITHIN,
        collocation_step.POINTS[None],
    ]
).T.copy()
_CONTROL = walk.Control(
    sweep_tolerance=collocation_step.SWEEP_TOLERANCE,
    sweeps=collocation_step.SWEEPS,
    patience=collocation_step.PATIENCE,
    slow=collocation_step.SLOW,
    aims=collocation_step.AIMS,
    nearest=collocation_step.NEAREST,
    least=collocation_step.LEAST,
    most=collocation_step.MOST,
    safety=collocation.SAFETY,
    shrink=collocation.SHRINK,
    grow=collocation.GROW,
    power=-1.0 / collocation_step.STAGES,
    almost=collocation.ALMOST,
    stiff=collocation.STIFF,
    trials=2000,
)


def integrate(
    problem: Motion,
    state: FloatArray,
    events: tuple[EndCondition, ...],
    *,
    tolerance: FloatArray,
    first_step: FloatArray,
    course: Course | None = None,
) -> Trajectory:
    """Advance every lane to its first event, as `collocation.integrate` does.

    Lanes with a stiff stretch, and those that never end, are integrated by it.
    """
    course, room = course or Course.unknown(state.shape[0], first_step), _ROOM
    while True:
        task = _walk(problem, state, course, events, lengths=(first_step, tolerance), room=room)
        # A trial step far too long overflows.
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            walk.walked(task)
        if not np.any(task.ended == walk.FULL):
            break
        room *= _MORE
    found = _trajectory(task)
    left = np.flatnonzero(task.ended == walk.LEFT)
    if not left.size:
        return found
    others = tuple(EndCondition(event.component, event.target[left], event.direction) for event in events)
    by_numpy = collocation.integrate(
        _Some(problem, left),
        state[:, left],
        others,
        tolerance=tolerance[left],
        first_step=first_step[left],
        course=course.take(left),
    )
    return _merged(found, by_numpy, left)


@dataclass(frozen=True)
class _Some:
    """Some lanes of a problem."""

    problem: Motion
    lanes: IntArray

    @property
    def chain(self) -> Chain:
        return self.problem.chain

    def derivative(self, lanes: IntArray) -> Derivative:
        return self.problem.derivative(self.lanes[lanes])


def _walk(
    problem: Motion,
    state: FloatArray,
    course: Course,
    events: tuple[EndCondition, ...],
    *,
    lengths: tuple[FloatArray, FloatArray],
    room: int,
) -> walk.Walk:
    """What the walk takes, with copies of all that it changes; lengths are the first step's and the tolerance."""
    (count, lanes), stages = state.shape, collocation_step.STAGES
    row, speed, clock = problem.chain
    first_step, tolerance = lengths
    equations = equations_of(problem)
    return walk.Walk(
        equations=equations,
        rule=_RULE,
        control=_CONTROL,
        chain=(row, speed, -1 if clock is None else clock),
        events=np.array([(event.component, event.direction) for event in events]),
        targets=np.array([event.target for event in events]),
        state=state.T.copy(),
        heading=course.slopes.transpose(2, 0, 1).copy(),
        lengths=np.array([first_step, course.size, course.origin, np.zeros(lanes), tolerance]).T.copy(),
        counts=np.zeros((lanes, 3), dtype=np.intp),
        starts=np.zeros((count, room, lanes)),
        steps=np.zeros((stages + 1, count, room, lanes)),
        ended=np.zeros(lanes, dtype=np.intp),
        bench=np.empty((3, count, stages)),
        rows=np.empty((2, count)),
        powers=np.empty(stages + 1),
        springs=np.empty((5, stages)),
        recalled=np.empty((equations.memory.shape[1], stages)),
    )


def _trajectory(task: walk.Walk) -> Trajectory:
    """What came of a walk."""
    counts, sweeps, ended_by = np.ascontiguousarray(task.counts.T)
    size, last, origin, error, _ = np.ascontiguousarray(task.lengths.T)
    most = int(counts.max())
    return Trajectory(
        final=np.ascontiguousarray(task.state.T),
        ended_by=ended_by,
        counts=counts,
        starts=task.starts[:, :most].copy(),
        steps=task.steps[:, :, :most].copy(),
        error=error,
        next_step=size,
        course=Course(np.ascontiguousarray(task.heading.transpose(1, 2, 0)), last, origin),
        sweeps=int(sweeps.sum()),
    )


def _merged(found: Trajectory, other: Trajectory, lanes: IntArray) -> Trajectory:
    """The trajectory with another one's lanes in place of its own."""
    most = max(found.starts.shape[1], other.starts.shape[1])
    starts = _padded(found.starts, 1, most)
    steps = _padded(found.steps, 2, most)
    starts[:, :, lanes] = _padded(other.starts, 1, most)
    steps[:, :, :, lanes] = _padded(other.steps, 2, most)
    for name in ("ended_by", "counts", "error", "next_step"):
        getattr(found, name)[lanes] = getattr(other, name)
    found.final[:, lanes] = other.final
    found.course.put(lanes, other.course)
    return Trajectory(
        found.final,
        found.ended_by,
        found.counts,
        starts,
        steps,
        found.error,
        found.next_step,
        found.course,
        found.sweeps + other.sweeps,
    )


def _padded(values: FloatArray, axis: int, size: int) -> FloatArray:
    """With zeros behind, up to a size along one axis."""
    wide = [(0, 0)] * values.ndim
    wide[axis] = (0, size - values.shape[axis])
    return np.pad(values, wide)

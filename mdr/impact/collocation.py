"""Many small initial value problems advanced together by Gauss collocation, each with its own step size.

A problem is a lane: states have shape (m, stages, lanes). A lane ends where a component of its state reaches a target:
the length of its last step is found together with the stages, so that the step ends there (`collocation_step`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from bem.polynomials.chebyshev import powers
from contact import NotConvergedError
from contact.records.validation import FloatArray, IntArray
from mdr.impact.collocation_step import (
    STAGES,
    SWEEP_TOLERANCE,
    Chain,
    CollocationStep,
    Course,
    Derivative,
    Landing,
    StepTask,
    newton_step,
    swept_step,
)

# Safety factor on the next step that the error allows, and the bounds of its change; usual in step control, chosen.
SAFETY, SHRINK, GROW = 0.85, 0.5, 1.5
# An event that lies less than a tenth of a step beyond it is landed on at once, without a short last step.
ALMOST = 1.1
# A step that is shorter than this (in the variable of the problem) should converge by sweeps; where it does not,
# Newton's method takes over. Chosen.
STIFF = 0.02


class Problem(Protocol):
    """Lanes of one kind of initial value problem."""

    @property
    def chain(self) -> Chain | None:
        """A component whose slope is another one."""

    def derivative(self, lanes: IntArray) -> Derivative:
        """The right-hand side of a subset of lanes, from states (m, stages, len(lanes)) to their derivatives."""


@dataclass(frozen=True)
class EndCondition:
    """A lane ends where `direction * (state[component] - target)` rises to zero.

    Attributes:
        component: Which component of the state.
        target: Its value at the end, shape (lanes,).
        direction: +1 for a component that grows towards the target, -1 for one that falls.
    """

    component: int
    target: FloatArray
    direction: int


@dataclass(frozen=True)
class Trajectory:
    """Accepted steps of all lanes.

    Attributes:
        final: State at the end, shape (m, lanes).
        ended_by: Index of the event that ended each lane, shape (lanes,).
        counts: Number of steps of each lane, shape (lanes,).
        starts: State at each step's start, shape (m, steps, lanes).
        steps: Change of state since then, sum_k steps[k, :, s] z^k for z in [-1, 1]; shape (11, m, steps, lanes). Kept
            apart, because a short step would lose its digits in the sum.
        error: Sum of the estimated local errors, shape (lanes,).
        next_step: Length a further step would have had, shape (lanes,).
        course: The slopes of the last step, for a further one.
        sweeps: Evaluations of the right-hand side, each for all stages of a step.
    """

    final: FloatArray
    ended_by: IntArray
    counts: IntArray
    starts: FloatArray
    steps: FloatArray
    error: FloatArray
    next_step: FloatArray
    course: Course
    sweeps: int

    def of(self, lane: int) -> Trajectory:
        """One lane alone."""
        own, count = slice(lane, lane + 1), int(self.counts[lane])
        return Trajectory(
            final=self.final[:, own],
            ended_by=self.ended_by[own],
            counts=self.counts[own],
            starts=self.starts[:, :count, own],
            steps=self.steps[:, :, :count, own],
            error=self.error[own],
            next_step=self.next_step[own],
            course=self.course.take(own),
            sweeps=self.sweeps,
        )


# What advances every lane to its first event: `integrate`, or what does the same in other ways.
Integrate: TypeAlias = Callable[..., "Trajectory"]


def integrate(
    problem: Problem,
    state: FloatArray,
    events: tuple[EndCondition, ...],
    *,
    tolerance: FloatArray,
    first_step: FloatArray,
    course: Course | None = None,
    max_steps: int = 2000,
) -> Trajectory:
    """Advance every lane to its first event.

    Args:
        problem: The right-hand sides.
        state: Initial states, shape (m, lanes).
        events: Where a lane may end.
        tolerance: Local error within a step allowed in each component relative to max(1, |component|), shape
            (lanes,).
        first_step: Length of the first trial step, shape (lanes,).
        course: Slopes of an earlier step that ended in these states, if there was one.
        max_steps: Refuse a lane that needs more.

    Raises:
        NotConvergedError: If a lane reaches no event within `max_steps`.
    """
    course = course or Course.unknown(state.shape[0], first_step)
    walk = _Walk(problem, state, events, tolerance=tolerance, first_step=first_step, course=course)
    for _ in range(max_steps):
        if not walk.active.size:
            return walk.trajectory()
        walk.step()
    raise NotConvergedError(
        f"{walk.active.size} of {state.shape[1]} motions (first of them number {walk.active[0]}) did not end within "
        f"{max_steps} steps: either the motion never ends or a relaxation time is far below its duration"
    )


class _Walk:
    """All lanes under way; `due` is the event that a lane's next step must land on, or -1."""

    def __init__(
        self,
        problem: Problem,
        state: FloatArray,
        events: tuple[EndCondition, ...],
        *,
        tolerance: FloatArray,
        first_step: FloatArray,
        course: Course,
    ) -> None:
        lanes = state.shape[1]
        self.problem, self.tolerance = problem, tolerance
        self.components = np.array([event.component for event in events])
        self.targets = np.array([event.target for event in events])
        self.directions = np.array([[event.direction] for event in events])
        self.state, self.size = state.copy(), first_step.copy()
        self.due, self.ended_by = np.full(lanes, -1, dtype=np.intp), np.full(lanes, -1, dtype=np.intp)
        self.error, self.stiff = np.zeros(lanes), np.zeros(lanes, dtype=np.bool_)
        self.pieces: list[tuple[IntArray, FloatArray, FloatArray]] = []
        self.sweeps = 0
        self.active = _never_alone(np.arange(lanes))
        self.derivative = problem.derivative(self.active)
        self.course = course.copy()

    def step(self) -> None:
        """One trial step of every active lane, onto an event where the step is expected to reach one."""
        # A trial step far too long has no finite error.
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            start, size = self.state[:, self.active], self.size[self.active]
            course = self._course(start)
            due = self.due[self.active]
            due = np.where(due < 0, self._first_event(start, start + ALMOST * course.ahead(size)), due)
            landing = self._landing(due, start)
            precision = self.tolerance[self.active] * np.maximum(1.0, np.abs(start))
            task = StepTask(start, course.aimed(size, landing), precision, landing, self.problem.chain)
            self._settle(self._tried(task, course), due)

    def _settle(self, trial: CollocationStep, due: IntArray) -> None:
        """Keep what is good and ends where it should; set the size of each lane's next trial.

        After a failure the next trial is shorter than this one was anywhere, so that failures come to an end.
        """
        lanes, good, end = self.active, trial.error <= 1.0, trial.end()
        passed = np.where(good, self._first_event(trial.task.start, end, but=due), -1)
        kept = good & (passed < 0)
        self._keep(trial, end, kept)
        self.ended_by[lanes] = np.where(kept, due, -1)
        self.due[lanes] = passed
        factor = np.minimum(np.maximum(SAFETY * np.maximum(trial.error, 1e-9) ** (-1.0 / STAGES), SHRINK), GROW)
        shortest = np.minimum(factor, 1.0) * np.minimum(trial.task.size, trial.size)
        next_size = np.where(good, np.where(passed < 0, factor, 1.0) * trial.size, shortest)
        self.size[lanes] = np.where(kept & (due >= 0), np.maximum(next_size, self.size[lanes]), next_size)
        self.course.follow(trial, lanes, ended=kept)
        if np.count_nonzero(self.ended_by[lanes] >= 0):
            self.active = _never_alone(lanes[self.ended_by[lanes] < 0])
            self.derivative = self.problem.derivative(self.active)

    def _course(self, start: FloatArray) -> Course:
        """Where the active lanes are heading."""
        course = self.course.take(self.active).completed(self.derivative, start)
        if not np.isfinite(course.slopes).all():
            lost = np.flatnonzero(~np.isfinite(course.slopes).all(axis=(0, 1)))
            raise NotConvergedError(
                f"motion {self.active[lost[0]]} left all bounds: a relaxation time is far below its duration"
            )
        return course

    def _landing(self, due: IntArray, start: FloatArray) -> Landing | None:
        """Which component must end where; a lane on no event aims at nothing."""
        if not np.count_nonzero(due >= 0):
            return None
        event = np.maximum(due, 0)
        component = self.components[event]
        target = self.targets[event, self.active]
        return Landing(due >= 0, component, target - start[component, np.arange(component.size)])

    def _tried(self, task: StepTask, course: Course) -> CollocationStep:
        """A step by sweeps, and by Newton's method for lanes that turn out to be stiff."""
        lanes = self.active
        trial = swept_step(self.derivative, task, course)
        self.sweeps += trial.sweeps
        lost = ~np.isfinite(trial.error)
        self.stiff[lanes] |= lost & (task.size < STIFF)
        hard = _never_alone(np.flatnonzero(self.stiff[lanes] & lost))
        if hard.size:
            harder = newton_step(self.problem.derivative(lanes[hard]), task.take(hard))
            trial.put(hard, harder)
            self.sweeps += harder.sweeps
        return trial

    def _first_event(self, start: FloatArray, end: FloatArray, but: IntArray | None = None) -> IntArray:
        """Index of the event that each active lane meets first, judged by linear interpolation; -1 for none."""
        gap = self.directions * (self.targets[:, self.active] - start[self.components])
        travel = self.directions * (end[self.components] - start[self.components])
        reached = (travel >= gap) & (travel > 0.0)
        if but is not None:
            reached &= but != np.arange(reached.shape[0])[:, None]
        if not np.count_nonzero(reached):
            return np.full(self.active.size, -1, dtype=np.intp)
        share = np.where(reached, gap / np.where(reached, travel, 1.0), np.inf)
        return np.where(reached.any(axis=0), share.argmin(axis=0), -1)

    def _keep(self, trial: CollocationStep, end: FloatArray, kept: NDArray[np.bool_]) -> None:
        if np.count_nonzero(kept):
            lanes = self.active[kept]
            self.pieces.append((lanes, trial.task.start[:, kept], trial.polynomial()[:, :, kept]))
            self.error[lanes] += self.tolerance[lanes] * (trial.error[kept] + SWEEP_TOLERANCE)
            self.state[:, lanes] = end[:, kept]

    def trajectory(self) -> Trajectory:
        """The record of all steps, padded with zeros where a lane has fewer than others."""
        counts = np.zeros(self.state.shape[1], dtype=np.intp)
        for lanes, _, _ in self.pieces:
            counts[lanes] += 1
        starts = np.zeros((self.state.shape[0], int(counts.max()), counts.size))
        steps = np.zeros((STAGES + 1, *starts.shape))
        filled = np.zeros_like(counts)
        for lanes, start, piece in self.pieces:
            starts[:, filled[lanes], lanes] = start
            steps[:, :, filled[lanes], lanes] = np.swapaxes(piece, 0, 1)
            filled[lanes] += 1
        return Trajectory(
            self.state, self.ended_by, counts, starts, steps, self.error, self.size, self.course, self.sweeps
        )


def _never_alone(lanes: IntArray) -> IntArray:
    """The same lanes, a single one twice: sums over one column are rounded in another order than over several."""
    return lanes if lanes.size != 1 else np.repeat(lanes, 2)


def states(trajectory: Trajectory, z: FloatArray) -> FloatArray:
    """States at the points z in [-1, 1] of every step, shape (m, len(z), steps, lanes)."""
    change = np.einsum("kmsl,kn->mnsl", trajectory.steps, powers(z, STAGES + 1))
    return np.asarray(trajectory.starts[:, None] + change)

"""Many small initial value problems advanced together by Gauss collocation, each with its own step size.

A problem is a lane: states have shape (m, stages, lanes). Over one step the state is the polynomial that satisfies the
equation at ten Gauss points (order 20 at the step's end, 10 in between); the stages are found by fixed-point iteration,
a few sweeps over all points and lanes at once. A lane ends where a component of its state reaches a target: the last
step takes that component itself as the independent variable (Henon 1982), so the event is hit without a search.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from contact import NotConvergedError
from contact.validation import FloatArray
from mdr.effects.chebyshev import powers

Lanes: TypeAlias = NDArray[np.intp]
Derivative: TypeAlias = Callable[[FloatArray], FloatArray]

STAGES = 10
_SWEEPS = 24  # a step that needs more is too long
_SWEEP_TOLERANCE = 0.05  # of the tolerance of a step
_SAFETY, _SHRINK, _GROW = 0.85, 0.25, 1.3
_ALMOST = 1.6  # an event that lies so little beyond a step is landed on at once
_STIFF = 0.02  # a step this short should converge by sweeps; where it does not, Newton's method takes over
_DIFFERENCE = 1e-7  # of a state: to differentiate its slopes
_PATIENCE, _SLOW = 6, 0.6  # after six sweeps, a lane whose change shrinks by less than this factor is given up

_POINTS, _GAUSS_WEIGHTS = legendre.leggauss(STAGES)
_ANALYSIS = (np.arange(STAGES) + 0.5)[:, None] * (legendre.legvander(_POINTS, STAGES - 1) * _GAUSS_WEIGHTS[:, None]).T
_INTEGRALS = np.stack([legendre.legint(unit, lbnd=-1.0) for unit in np.eye(STAGES)], axis=1) @ _ANALYSIS
_TO_STAGES = 0.5 * legendre.legvander(_POINTS, STAGES) @ _INTEGRALS  # from slopes to states, for a unit step
_TO_END = 0.5 * _GAUSS_WEIGHTS
_TO_POWERS = np.stack([np.pad(legendre.leg2poly(u), (0, STAGES - i)) for i, u in enumerate(np.eye(STAGES + 1))], axis=1)


class Problem(Protocol):
    """Lanes of one kind of initial value problem."""

    @property
    def controlled(self) -> int:
        """How many leading components of the state the error control watches."""

    def derivative(self, lanes: Lanes) -> Derivative:
        """The right-hand side of a subset of lanes, from states (m, stages, len(lanes)) to their derivatives."""


@dataclass(frozen=True)
class Event:
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
        sweeps: Evaluations of the right-hand side, each for all stages of a step.
    """

    final: FloatArray
    ended_by: Lanes
    counts: Lanes
    starts: FloatArray
    steps: FloatArray
    error: FloatArray
    next_step: FloatArray
    sweeps: int


def integrate(
    problem: Problem,
    state: FloatArray,
    events: tuple[Event, ...],
    *,
    tolerance: float,
    first_step: FloatArray,
    max_steps: int = 2000,
) -> Trajectory:
    """Advance every lane to its first event.

    Args:
        problem: The right-hand sides.
        state: Initial states, shape (m, lanes).
        events: Where a lane may end.
        tolerance: Local error within a step allowed in each controlled component, relative to max(1, |component|).
        first_step: Length of the first trial step, shape (lanes,).
        max_steps: Refuse a lane that needs more.

    Raises:
        NotConvergedError: If a lane reaches no event within `max_steps`.
    """
    walk = _Walk(problem, state, events, tolerance, first_step)
    for _ in range(max_steps):
        if not walk.active.size:
            return walk.trajectory()
        walk.step()
    raise NotConvergedError(
        f"{walk.active.size} of {state.shape[1]} motions (first of them number {walk.active[0]}) did not end within "
        f"{max_steps} steps: either the motion never ends or a relaxation time is far below its duration"
    )


@dataclass
class _Step:
    """A trial step of some lanes.

    Attributes:
        start: State at the start, shape (m, lanes).
        size: Length, shape (lanes,).
        slopes: Derivatives at the stages, shape (m, stages, lanes).
        error: Estimated error over the precision asked, infinite where the sweeps did not converge; shape (lanes,).
        sweeps: How many sweeps it took.
    """

    start: FloatArray
    size: FloatArray
    slopes: FloatArray
    error: FloatArray
    sweeps: int

    @property
    def end(self) -> FloatArray:
        return np.asarray(self.start + self.size * np.einsum("j,mjl->ml", _TO_END, self.slopes))

    def polynomial(self) -> FloatArray:
        """Powers of z in [-1, 1] of the change of state, shape (11, m, lanes)."""
        matrix: FloatArray = 0.5 * _TO_POWERS @ _INTEGRALS
        return np.asarray(np.einsum("kj,mjl->kml", matrix, self.size * self.slopes))


def _trial(
    derivative: Derivative, start: FloatArray, slope: FloatArray, size: FloatArray, precision: FloatArray
) -> _Step:
    """Sweep until no stage moves; a lane that has converged is left alone, so that no lane feels its neighbours."""
    base, slopes, watched = start[:, None], np.repeat(slope[:, None], STAGES, axis=1), precision.shape[0]
    allowed = precision / np.abs(size)
    moving, failed = np.ones(size.size, dtype=np.bool_), np.zeros(size.size, dtype=np.bool_)
    before = np.full(size.size, np.inf)
    for sweep in range(1, _SWEEPS + 1):
        new = derivative(base + size * (_TO_STAGES @ slopes))
        change = _largest(new[:watched] - slopes[:watched], allowed)
        slopes = new if moving.all() else np.where(moving, new, slopes)
        moving = moving & ~(change <= _SWEEP_TOLERANCE)
        failed |= moving & ((sweep > _PATIENCE) & ~(change < _SLOW * before) | (sweep == _SWEEPS))
        moving, before = moving & ~failed, change
        if not moving.any():
            break
    tail = _largest(_ANALYSIS[-2:] @ slopes[:watched], allowed)
    return _Step(start, size, slopes, np.where(failed, np.inf, tail / (2.0 * STAGES)), sweep)


def _stiff_trial(
    derivative: Derivative, start: FloatArray, slope: FloatArray, size: FloatArray, precision: FloatArray
) -> _Step:
    """The same step by simplified Newton iteration, for slopes that answer fast: Gauss collocation is A-stable."""
    components, lanes, watched = *start.shape, precision.shape[0]
    allowed, base = precision / np.abs(size), start[:, None]
    coupling = np.einsum("l,ij,abl->laibj", size, _TO_STAGES, _jacobian(derivative, start))
    count = components * STAGES
    matrix = np.eye(count) - coupling.reshape(lanes, count, count)
    slopes, failed, sweep = np.repeat(slope[:, None], STAGES, axis=1), np.full(lanes, True), 0
    while failed.any() and sweep < _SWEEPS:
        sweep += 1
        residual = derivative(base + size * (_TO_STAGES @ slopes)) - slopes
        if not np.all(np.isfinite(residual)):
            break
        move = np.linalg.solve(matrix, np.moveaxis(residual, 2, 0).reshape(lanes, count, 1))
        update = np.moveaxis(move.reshape(lanes, components, STAGES), 0, 2)
        change = _largest(update[:watched], allowed)
        slopes = np.where(failed, slopes + update, slopes)  # a lane that has converged is left alone
        failed = np.logical_and(failed, ~(change <= _SWEEP_TOLERANCE))
    tail = _largest(_ANALYSIS[-2:] @ slopes[:watched], allowed)
    return _Step(start, size, slopes, np.where(failed, np.inf, tail / (2.0 * STAGES)), sweep)


def _jacobian(derivative: Derivative, start: FloatArray) -> FloatArray:
    """d(slope a)/d(state b) by one-sided differences, shape (m, m, lanes)."""
    step = _DIFFERENCE * np.maximum(1.0, np.abs(start))
    shifted = start[:, None] + np.eye(start.shape[0])[:, :, None] * step[:, None]
    return np.asarray((derivative(shifted) - derivative(start[:, None])) / step)


def _largest(values: FloatArray, allowed: FloatArray) -> FloatArray:
    """Largest magnitude over stages and components, in units of what is allowed; shape (lanes,)."""
    return np.asarray(np.maximum.reduce(np.maximum.reduce(np.abs(values), axis=1) / allowed, axis=0))


class _Walk:
    """All lanes under way; `due` is the event that a lane's next step must land on, or -1."""

    def __init__(
        self, problem: Problem, state: FloatArray, events: tuple[Event, ...], tolerance: float, first_step: FloatArray
    ) -> None:
        lanes = state.shape[1]
        self.problem, self.events, self.tolerance = problem, events, tolerance
        self.state, self.size = state.copy(), first_step.copy()
        self.due, self.ended_by = np.full(lanes, -1, dtype=np.intp), np.full(lanes, -1, dtype=np.intp)
        self.error, self.stiff = np.zeros(lanes), np.zeros(lanes, dtype=np.bool_)
        self.pieces: list[tuple[Lanes, FloatArray, FloatArray]] = []
        self.sweeps = 0
        self.active = np.arange(lanes)
        self.derivative = problem.derivative(self.active)

    def step(self) -> None:
        """One trial step of every active lane, onto an event where a plain step would reach one."""
        start, size = self.state[:, self.active], self.size[self.active]
        with np.errstate(over="ignore", invalid="ignore"):  # what overflows is refused by name in the next line
            slope = self.derivative(start[:, None])[:, 0]
        if not np.isfinite(slope).all():
            lost = int(self.active[np.flatnonzero(~np.isfinite(slope).all(axis=0))[0]])
            raise NotConvergedError(f"motion {lost} left all bounds: a relaxation time is far below its duration")
        due = self.due[self.active]
        due = np.where(due < 0, self._first_event(self.active, start, start + _ALMOST * size * slope), due)
        for move, chosen in ((self._walk, due < 0), (self._land, due >= 0)):
            here = np.flatnonzero(chosen)
            if here.size == due.size:
                move(self.active, self.derivative, start, slope, due)
            elif here.size:
                lanes = self.active[here]
                move(lanes, self.problem.derivative(lanes), start[:, here], slope[:, here], due[here])
        going = self.ended_by[self.active] < 0
        if not going.all():
            self.active = self.active[going]
            self.derivative = self.problem.derivative(self.active)

    def _trial(self, derivative: Derivative, start: FloatArray, slope: FloatArray, size: FloatArray) -> _Step:
        return self._counted(_trial, derivative, start, slope, size)

    def _counted(
        self,
        method: Callable[..., _Step],
        derivative: Derivative,
        start: FloatArray,
        slope: FloatArray,
        size: FloatArray,
    ) -> _Step:
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):  # a wild trial has no finite error
            precision = self.tolerance * np.maximum(1.0, np.abs(start[: self.problem.controlled]))
            trial = method(derivative, start, slope, size, precision)
        self.sweeps += trial.sweeps + 1
        return trial

    def _plain(self, lanes: Lanes, derivative: Derivative, start: FloatArray, slope: FloatArray) -> _Step:
        """A step by sweeps, and by Newton's method for lanes that turn out to be stiff."""
        size = self.size[lanes]
        trial = self._trial(derivative, start, slope, size)
        self.stiff[lanes] |= ~np.isfinite(trial.error) & (size < _STIFF)
        hard = np.flatnonzero(self.stiff[lanes] & ~np.isfinite(trial.error))
        if hard.size:
            inner = self.problem.derivative(lanes[hard])
            harder = self._counted(_stiff_trial, inner, start[:, hard], slope[:, hard], size[hard])
            trial.slopes[:, :, hard], trial.error[hard] = harder.slopes, harder.error
        return trial

    def _first_event(self, lanes: Lanes, start: FloatArray, end: FloatArray) -> Lanes:
        """Index of the event that each lane meets first, judged by linear interpolation; -1 for none."""
        first, earliest = np.full(lanes.size, -1, dtype=np.intp), np.full(lanes.size, np.inf)
        for number, event in enumerate(self.events):
            gap = event.direction * (event.target[lanes] - start[event.component])
            travel = event.direction * (end[event.component] - start[event.component])
            reached = (travel >= gap) & (travel > 0.0)
            if reached.any():
                share = np.where(reached, gap / np.where(reached, travel, 1.0), np.inf)
                first, earliest = np.where(share < earliest, number, first), np.minimum(share, earliest)
        return first

    def _walk(self, lanes: Lanes, derivative: Derivative, start: FloatArray, slope: FloatArray, _: Lanes) -> None:
        """A plain step; one that passes an event is forgotten, and the next must land."""
        trial = self._plain(lanes, derivative, start, slope)
        good = trial.error <= 1.0
        self.due[lanes] = np.where(good, self._first_event(lanes, start, trial.end), -1)
        kept = np.flatnonzero(good & (self.due[lanes] < 0))
        self._keep(trial, kept, lanes)
        self.state[:, lanes[kept]] = trial.end[:, kept]
        factor = np.clip(_SAFETY * np.maximum(trial.error, 1e-9) ** (-1.0 / STAGES), _SHRINK, _GROW)
        self.size[lanes] *= np.where(self.due[lanes] < 0, factor, 0.5)

    def _land(self, lanes: Lanes, derivative: Derivative, start: FloatArray, slope: FloatArray, event: Lanes) -> None:
        """A step in the event's own component; where that is too long, a shorter plain step comes next."""
        column = np.arange(lanes.size)
        component = np.array([e.component for e in self.events])[event]
        target = np.stack([e.target for e in self.events])[event, lanes]

        def by_component(state: FloatArray) -> FloatArray:
            rate = derivative(state)
            return rate / rate[component, :, column].T

        span = target - start[component, column]
        trial = self._trial(by_component, start, slope / slope[component, column], span)
        end = trial.end
        end[component, column] = target
        landed = (trial.error <= 1.0) & self._within(end, lanes)
        self._keep(trial, np.flatnonzero(landed), lanes)
        self.state[:, lanes[landed]] = end[:, landed]
        self.ended_by[lanes[landed]] = event[landed]
        self.due[lanes] = -1
        reach = np.abs(span / slope[component, column])  # of a plain step that would arrive
        self.size[lanes] = np.where(landed, self.size[lanes], 0.5 * np.minimum(self.size[lanes], reach))

    def _within(self, end: FloatArray, lanes: Lanes) -> NDArray[np.bool_]:
        """Whether a lane that landed on one event has not passed another."""
        short = [e.direction * (end[e.component] - e.target[lanes]) <= 0.0 for e in self.events]
        return np.asarray(np.all(short, axis=0))

    def _keep(self, trial: _Step, kept: Lanes, lanes: Lanes) -> None:
        if kept.size:
            self.pieces.append((lanes[kept], trial.start[:, kept], trial.polynomial()[:, :, kept]))
            self.error[lanes[kept]] += self.tolerance * (trial.error[kept] + _SWEEP_TOLERANCE)

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
            steps[:, :, filled[lanes], lanes] = piece
            filled[lanes] += 1
        return Trajectory(self.state, self.ended_by, counts, starts, steps, self.error, self.size, self.sweeps)


def states(trajectory: Trajectory, z: FloatArray) -> FloatArray:
    """States at the points z in [-1, 1] of every step, shape (m, len(z), steps, lanes)."""
    change = np.einsum("kmsl,kn->mnsl", trajectory.steps, powers(z, STAGES + 1))
    return np.asarray(trajectory.starts[:, None] + change)

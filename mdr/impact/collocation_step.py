"""One step of Gauss collocation for many lanes at once.

Over a step the state is the polynomial that satisfies the equation at ten Gauss points (order 20 at the step's end, 10
in between). The slopes there are found by fixed-point sweeps over all points and lanes at once, starting from the
polynomial of the step before; where the step must end on an event, its length is corrected along with them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from bem.polynomials.chebyshev import powers
from bem.polynomials.gauss import legendre_rule
from contact.records.validation import FloatArray, IntArray

Derivative: TypeAlias = Callable[[FloatArray], FloatArray]
# Rows of a quantity, of its speed, and of the clock of that speed.
Chain: TypeAlias = tuple[int, int, int | None]

# Gauss points on each step: order 20 at its end.
STAGES = 10
# Sweeps stop at this share of the tolerance of a step, so that they add little to its error; chosen.
SWEEP_TOLERANCE = 0.05
# A step that needs more sweeps is too long.
SWEEPS = 24
# After six sweeps, a lane whose change shrinks by less than this factor is given up; chosen.
PATIENCE, SLOW = 6, 0.6
# Only 8 Legendre terms of the last step are extrapolated; higher ones amplify rounding.
_CARRIED = 8
# Newton steps towards an event on the polynomial of the step before: a start only, which sweeps correct.
AIMS = 3
# Share of a step at which an event is first looked for; chosen.
NEAREST = 0.01
# A sweep may change the length of a step by these factors at most; chosen.
LEAST, MOST = 0.5, 1.5
# Relative change of a state by which its slopes are differentiated: about the root of a rounding times seven.
_DIFFERENCE = 1e-7
_NUMBERS = np.arange(1.0, STAGES + 1.0)[:, None]

POINTS, _GAUSS_WEIGHTS = legendre_rule(STAGES)
# Matrix from values at the Gauss points to Legendre coefficients, and from there to those of the integral from -1 on.
ANALYSIS = (np.arange(STAGES) + 0.5)[:, None] * (legendre.legvander(POINTS, STAGES - 1) * _GAUSS_WEIGHTS[:, None]).T
_INTEGRALS = np.stack([legendre.legint(unit, lbnd=-1.0) for unit in np.eye(STAGES)], axis=1) @ ANALYSIS
# Matrix from slopes to states, for a unit step.
TO_STAGES = 0.5 * legendre.legvander(POINTS, STAGES) @ _INTEGRALS
# Row from slopes to the change of state over a unit step.
TO_END = 0.5 * _GAUSS_WEIGHTS
# From slopes to the change of state over a unit step, and to the slope at its end, where all Legendre polynomials are
# 1. The two stand in one matrix, because sums over columns of products with a single row depend on their number.
ENDS = np.stack([TO_END, np.ones(STAGES) @ ANALYSIS])
# Matrix from Legendre coefficients to powers of z.
_POWERS = np.stack([np.pad(legendre.leg2poly(u), (0, STAGES - i)) for i, u in enumerate(np.eye(STAGES + 1))], axis=1)
# Matrix from slopes to powers of z of the change of state.
CHANGE = 0.5 * _POWERS @ _INTEGRALS
# Matrix from slopes to powers of z of themselves.
WITHIN = _POWERS[:STAGES, :STAGES] @ ANALYSIS
ONWARD = _POWERS[:STAGES, :_CARRIED] @ ANALYSIS[:_CARRIED]


@dataclass(frozen=True)
class Landing:
    """Where lanes must end.

    Attributes:
        due: Which of those that step end on an event, shape (lanes,).
        component: Of the state, shape (lanes,).
        span: How far the component must go, shape (lanes,).
    """

    due: NDArray[np.bool_]
    component: IntArray
    span: FloatArray

    def of(self, values: FloatArray) -> FloatArray:
        """Each lane's component, from (m, ..., lanes) to (..., lanes)."""
        return values[self.component, ..., np.arange(self.component.size)].T

    def take(self, lanes: IntArray) -> Landing:
        """Of some lanes only."""
        return Landing(self.due[lanes], self.component[lanes], self.span[lanes])


@dataclass
class Course:
    """What an earlier step says about the next one.

    Attributes:
        slopes: Powers of that step's z in [-1, 1], shape (m, 10, lanes).
        size: Its length, shape (lanes,).
        origin: The z where the next step starts: 1, or -1 where the step has to be repeated; shape (lanes,).
    """

    slopes: FloatArray
    size: FloatArray
    origin: FloatArray

    @classmethod
    def unknown(cls, components: int, size: FloatArray) -> Course:
        """No earlier step: a first one starts with the slope at its beginning."""
        return cls(np.full((components, STAGES, size.size), np.nan), size.copy(), np.full(size.size, -1.0))

    def completed(self, derivative: Derivative, start: FloatArray) -> Course:
        """With constant slopes where there was no earlier step, in place."""
        new = np.isnan(self.slopes[0, 0])
        if np.count_nonzero(new):
            self.slopes[:, :, new], self.origin[new] = 0.0, -1.0
            self.slopes[:, 0, new] = derivative(start[:, None])[:, 0, new]
        return self

    def copy(self) -> Course:
        """Apart from the original."""
        return Course(self.slopes.copy(), self.size.copy(), self.origin.copy())

    def take(self, lanes: IntArray | slice) -> Course:
        """Some of the lanes."""
        return Course(self.slopes[:, :, lanes], self.size[lanes], self.origin[lanes])

    def put(self, lanes: IntArray, other: Course) -> None:
        """Replace some lanes."""
        self.slopes[:, :, lanes], self.size[lanes], self.origin[lanes] = other.slopes, other.size, other.origin

    def follow(self, step: CollocationStep, lanes: IntArray, *, ended: NDArray[np.bool_]) -> None:
        """Remember a step of some lanes, ended or to be repeated; one that came to nothing says nothing."""
        slopes = ONWARD @ step.slopes
        if np.count_nonzero(ended) < ended.size:
            again = np.where(np.isfinite(step.error), WITHIN @ step.slopes, np.nan)
            slopes = np.where(ended, slopes, again)
        self.slopes[:, :, lanes] = slopes
        self.size[lanes], self.origin[lanes] = step.size, np.where(ended, 1.0, -1.0)

    def guess(self, size: FloatArray) -> FloatArray:
        """Slopes at the stages of a step of this length, shape (m, stages, lanes)."""
        z = self.origin + size / self.size * (1.0 + POINTS[:, None])
        return np.asarray(np.einsum("mkl,kjl->mjl", self.slopes, powers(z, STAGES)))

    def ahead(self, size: FloatArray) -> FloatArray:
        """Change of state over a step of this length, shape (m, lanes)."""
        ladder = powers(self.origin + 2.0 * size / self.size, STAGES + 1)[1:]
        means = (ladder - self.origin**_NUMBERS) / _NUMBERS
        return np.asarray(0.5 * self.size * np.add.reduce(self.slopes * means, axis=1))

    def aimed(self, size: FloatArray, landing: Landing | None) -> FloatArray:
        """The length that lands where it should if the course holds; the given one where it need not."""
        if landing is None:
            return size
        slopes, from_start = landing.of(self.slopes), self.origin**_NUMBERS
        means, z = slopes / _NUMBERS, self.origin + 2.0 * size / self.size
        for attempt in range(AIMS + 1):
            ladder = powers(z, STAGES + 1)
            way = 0.5 * self.size * np.add.reduce(means * (ladder[1:] - from_start))
            at = 0.5 * self.size * (z - self.origin)
            # The first attempt is in proportion, the others are Newton's.
            if attempt == 0:
                share = landing.span / way
                at = at * np.minimum(np.maximum(np.where(share > 0.0, share, 1.0), NEAREST), 1.0)
            else:
                at = _lengthened(at, (landing.span - way) / np.add.reduce(slopes * ladder[:-1]))
            z = self.origin + 2.0 * at / self.size
        return np.where(landing.due, at, size)


@dataclass(frozen=True)
class StepTask:
    """A step to be found for some lanes.

    Attributes:
        start: State at the start, shape (m, lanes).
        size: Length, to begin with where it must end on an event; shape (lanes,).
        precision: Of each component, shape (m, lanes).
        landing: Where some of the lanes must end.
        chain: A component whose slope is another component, times the slope of a third if there is one. It is taken
            from the newest of that other one, as Nystrom methods do, which halves the number of sweeps.
    """

    start: FloatArray
    size: FloatArray
    precision: FloatArray
    landing: Landing | None
    chain: Chain | None = None

    def take(self, lanes: IntArray) -> StepTask:
        """Some of the lanes."""
        landing = None if self.landing is None else self.landing.take(lanes)
        return StepTask(self.start[:, lanes], self.size[lanes], self.precision[:, lanes], landing, self.chain)

    def states(self, size: FloatArray, slopes: FloatArray) -> FloatArray:
        """At the stages, shape (m, stages, lanes)."""
        state = self.start[:, None] + size * (TO_STAGES @ slopes)
        if self.chain is not None:
            row, speed, clock = self.chain
            rate = state[speed] if clock is None else state[speed] * slopes[clock]
            state[row] = self.start[row] + size * (TO_STAGES @ rate)
        return np.asarray(state)

    def found(self, size: FloatArray, slopes: FloatArray, failed: NDArray[np.bool_], sweeps: int) -> CollocationStep:
        """The step with its error: the part that the last two of its polynomials have."""
        tail = _largest(ANALYSIS[-2:] @ slopes, self.precision / size)
        return CollocationStep(self, size, slopes, np.where(failed, np.inf, tail / (2.0 * STAGES)), sweeps)


@dataclass
class CollocationStep:
    """A trial step of some lanes.

    Attributes:
        task: What was looked for.
        size: Length, shape (lanes,).
        slopes: Derivatives at the stages, shape (m, stages, lanes).
        error: Estimated error over the precision asked, infinite where the sweeps did not converge; shape (lanes,).
        sweeps: How many sweeps it took.
    """

    task: StepTask
    size: FloatArray
    slopes: FloatArray
    error: FloatArray
    sweeps: int

    def end(self) -> FloatArray:
        """State at the end, exactly on its event where there is one."""
        start, landing = self.task.start, self.task.landing
        end = start + self.size * (ENDS @ self.slopes)[:, 0]
        if landing is not None:
            at = landing.component[landing.due], np.flatnonzero(landing.due)
            end[at] = start[at] + landing.span[landing.due]
        return np.asarray(end)

    def polynomial(self) -> FloatArray:
        """Powers of z in [-1, 1] of the change of state, shape (m, 11, lanes)."""
        # BLAS sums products with eleven rows in another order for two lanes than for many, on some processors.
        return np.asarray(np.einsum("ij,mjl->mil", CHANGE, self.size * self.slopes))

    def put(self, lanes: IntArray, other: CollocationStep) -> None:
        """Replace some lanes."""
        self.size = self.size.copy()
        self.size[lanes], self.slopes[:, :, lanes], self.error[lanes] = other.size, other.slopes, other.error


def swept_step(derivative: Derivative, task: StepTask, course: Course) -> CollocationStep:
    """Sweep until no stage moves; a lane that has converged is left alone, so that no lane feels its neighbours.

    Args:
        derivative: From states (m, stages, lanes) to their slopes.
        task: The step.
        course: Where its stages are looked for first.
    """
    size, allowed = task.size, task.precision / task.size
    slopes, before = course.guess(size), np.full(size.size, np.inf)
    moving, failed = np.ones(size.size, dtype=np.bool_), np.zeros(size.size, dtype=np.bool_)
    for sweep in range(1, SWEEPS + 1):
        new = derivative(task.states(size, slopes))
        change = _largest(new - slopes, allowed)
        slopes = new if np.count_nonzero(moving) == moving.size else np.where(moving, new, slopes)
        if task.landing is not None:
            size, missed = _corrected(task, task.landing, size, slopes, moving)
            change = np.maximum(change, missed)
        moving &= ~(change <= SWEEP_TOLERANCE)
        if sweep > PATIENCE:
            failed |= moving & (~(change < SLOW * before) | (sweep == SWEEPS))
            moving &= ~failed
        if not np.count_nonzero(moving):
            break
        before = change
    return task.found(size, slopes, failed, sweep)


def newton_step(derivative: Derivative, task: StepTask) -> CollocationStep:
    """The same step by simplified Newton iteration, for slopes that answer fast: Gauss collocation is A-stable."""
    components, lanes = task.start.shape
    base, size, count = task.start[:, None], task.size, components * STAGES
    jacobian = _jacobian(derivative, task.start)
    slopes, failed, sweep = np.repeat(derivative(base), STAGES, axis=1), np.full(lanes, True), 0
    while failed.any() and sweep < SWEEPS:
        sweep += 1
        residual = derivative(base + size * (TO_STAGES @ slopes)) - slopes
        if not np.all(np.isfinite(residual)):
            break
        coupling = np.einsum("l,ij,abl->laibj", size, TO_STAGES, jacobian).reshape(lanes, count, count)
        move = np.linalg.solve(np.eye(count) - coupling, np.moveaxis(residual, 2, 0).reshape(lanes, count, 1))
        update = np.moveaxis(move.reshape(lanes, components, STAGES), 0, 2)
        change = _largest(update, task.precision / size)
        # A lane that has converged is left alone.
        slopes = np.where(failed, slopes + update, slopes)
        if task.landing is not None:
            size, missed = _corrected(task, task.landing, size, slopes, failed)
            change = np.maximum(change, missed)
        failed = np.logical_and(failed, ~(change <= SWEEP_TOLERANCE))
    return task.found(size, slopes, failed, sweep)


def _corrected(
    task: StepTask, landing: Landing, size: FloatArray, slopes: FloatArray, moving: NDArray[np.bool_]
) -> tuple[FloatArray, FloatArray]:
    """Lengths nearer to the event, by Newton's method, and what the correction moves in units of the precision."""
    both = ENDS @ slopes
    change, at_end = both[:, 0], both[:, 1]
    miss = (landing.span - size * landing.of(change)) / landing.of(at_end)
    miss = np.where(landing.due & moving, miss, 0.0)
    return _lengthened(size, miss), np.maximum.reduce(np.abs(at_end) / task.precision) * np.abs(miss)


def _lengthened(size: FloatArray, miss: FloatArray) -> FloatArray:
    """Lengths after a correction that must not be wild."""
    return np.where(np.isfinite(miss), np.minimum(np.maximum(size + miss, LEAST * size), MOST * size), size)


def _jacobian(derivative: Derivative, start: FloatArray) -> FloatArray:
    """d(slope a)/d(state b) by one-sided differences, shape (m, m, lanes)."""
    step = _DIFFERENCE * np.maximum(1.0, np.abs(start))
    shifted = start[:, None] + np.eye(start.shape[0])[:, :, None] * step[:, None]
    return np.asarray((derivative(shifted) - derivative(start[:, None])) / step)


def _largest(values: FloatArray, allowed: FloatArray) -> FloatArray:
    """Largest magnitude over components and stages, in units of what is allowed; shape (lanes,)."""
    shares = np.abs(values) / allowed[:, None]
    return np.asarray(np.maximum.reduce(shares.reshape(-1, shares.shape[-1])))

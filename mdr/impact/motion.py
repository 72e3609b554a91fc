"""Motion of rigid bodies that hit a layer, many at once, each phase one polynomial in a power of time.

Stress of a spring that was touched at t_c, over 2 E* y_1^2 dx, with w_j = G_j/G_0 and rates r_j = 1/tau_j
(w_0 = G_inf/G_0, r_0 = 0), eta the dashpot over G_0:

    sum_j [s_j(t) - exp(-r_j (t - t_c)) s_j(t_c)] + eta v,     s_j' = w_j v - r_j s_j             Eqs. (51), (52)

Growth: only K = K(depth) of layer and profile matters,

    M v' = -2 E* [sum_j L_j + eta K v],    L_j' = w_j K v - r_j L_j.

Shrinkage: the edge is where it was at an instant theta of the growth, and its spring is free of stress,

    sum_j [s_j(t) - exp(-r_j (t - theta)) s_j(theta)] + eta v = 0,
    M v' = -2 E* [K (sum_j s_j + eta v) - sum_j exp(-r_j (t - theta)) (s_j K - L_j)],   K and L_j at theta.

The force is stationary in theta, so that theta of the last sweep leaves Newton's method quadratic. Unknown are the
speeds at the nodes and the duration. A growth ends at the turn, or where the edge passes a break of the profile; a
shrinkage ends where the edge is back at the start of the growth's piece.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from contact.records.validation import BoolArray, FloatArray
from mdr.impact.rules import Rule, interpolated, times
from mdr.impact.track import Track

# Sweeps of Newton's method; five are usual.
_SWEEPS = 60
# Relative size of a correction that ends them, and one below which they end when corrections stop falling.
_EXACT, _STALLED = 1e-13, 1e-9
# The same of speeds alone: what a dashpot has nearly stopped has an uncertain duration.
_STALLED_SPEED = 1e-11
# Largest change of ln T in a sweep, halved while corrections stay above a share of the last. With twice as much steps
# overshoot, with half they are slower.
_LONGEST_STEP, _SHORTEST_STEP, _FALLS = 0.5, 0.05, 0.8
# Correction of the speeds over their largest, below which the duration is corrected too.
_SETTLED = 0.7
# Share of a phase before which it may not end; nodes beyond are within a Newton step of the end.
_ENDED = 0.7
# Most steps of the search for theta, and the size of the last, in shares of the growth: its square is rounding.
_EDGE_STEPS, _EDGE_STEP = 40, 1e-9


@dataclass(frozen=True, eq=False)
class Impacts:
    """Impacts that are solved together, n of them with m branches each, in the units of their tracks.

    Attributes:
        tracks: K and a over the depth of each impact.
        velocity: v_0, shape (n,).
        pull: 2 E*/M [1/s^2], shape (n,).
        weights: w_j, shape (n, m).
        rates: r_j [1/s], shape (n, m).
        viscosity: eta [s], shape (n,).
    """

    tracks: Sequence[Track]
    velocity: FloatArray
    pull: FloatArray
    weights: FloatArray
    rates: FloatArray
    viscosity: FloatArray

    @property
    def are_elastic(self) -> bool:
        """Whether every layer is elastic, so that shrinkages are growths reversed."""
        return not (self.rates.any() or self.viscosity.any())

    def springs(self, depth: FloatArray, piece: int) -> FloatArray:
        """K, dK/d(depth) and a at depths of shape (n, k) on one piece, shape (3, n, k)."""
        values = np.empty((3, *depth.shape))
        for track in {id(track): track for track in self.tracks}.values():
            members = [i for i, other in enumerate(self.tracks) if other is track]
            values[:, members] = track.at(depth[members], piece)
        return values


class State(NamedTuple):
    """Motion between two phases: time, speed and depth, shape (n,), s_j and L_j, shape (n, m)."""

    time: FloatArray
    speed: FloatArray
    depth: FloatArray
    stress: FloatArray
    load: FloatArray


@dataclass(eq=False)
class Phase(ABC):
    """One phase of n impacts, with k nodes; series at nodes and end have shape (n, k + 1).

    Attributes:
        impacts: Their constants.
        piece: Number of the piece of their tracks.
        rule: Nodes in time.
        start: State at the start.
        duration: T [s], shape (n,).
        speed: v at the nodes, shape (n, k).
        sweeps: Number of sweeps of Newton's method.
        correction: Last corrections of v/v_0 and ln T, shape (2, n).
        force: Force over 2 E* at nodes and end.
        end_speed: v at the end, shape (n,).
        stiffness: K at nodes and end.
        radius: a at nodes and end.
        final: State at the end.
    """

    impacts: Impacts
    piece: int
    rule: Rule
    start: State
    duration: FloatArray
    speed: FloatArray
    sweeps: int = field(default=0, init=False)
    correction: FloatArray = field(init=False)
    force: FloatArray = field(init=False)
    end_speed: FloatArray = field(init=False)
    stiffness: FloatArray = field(init=False)
    radius: FloatArray = field(init=False)
    final: State = field(init=False)

    @abstractmethod
    def forces(self) -> FloatArray:
        """Compute K, a and the force; returns its derivatives by the speeds at the nodes, shape (n, k + 1, k)."""

    @abstractmethod
    def end(self, step: FloatArray, speed: FloatArray, force: FloatArray) -> tuple[FloatArray, FloatArray]:
        """What vanishes at the end, and its rate in time, after a step of the speeds.

        Args:
            step: Changes of the speeds at the nodes, shape (n, k).
            speed: v at the end after them, shape (n,).
            force: Force over 2 E* at the end after them, without the dashpot, shape (n,).
        """

    @abstractmethod
    def beyond_end(self) -> BoolArray:
        """Whether each node lies beyond the end of the phase, shape (n, k)."""

    @property
    def depth(self) -> FloatArray:
        """Depth at nodes and end."""
        return self.start.depth[:, None] + self.duration[:, None] * times(self.rule.integrals, self.speed)

    def speed_at(self, s: FloatArray) -> FloatArray:
        """Speeds at places s, shape (n, q) or (q,)."""
        return interpolated(self.speed[:, None], np.atleast_2d(s))[:, 0]

    def solve(self) -> None:
        """Newton's method for the speeds and ln T.

        On a solution a longer duration moves the nodes along v(t), so that v at the nodes changes by v' times the
        shift of the nodes, and the end condition at its rate in time.
        """
        n = self.duration.size
        self.done, last, longest = np.zeros(n, dtype=bool), np.full(n, np.inf), np.full(n, _LONGEST_STEP)
        self.correction = np.full((2, n), np.inf)
        for self.sweeps in range(1, _SWEEPS + 1):
            self._operators()
            if self._shorten():
                self._operators()
            speed_step, duration_step = self._newton_step()
            scale = np.maximum(np.abs(self.speed).max(axis=1), np.abs(self.start.speed))
            both = np.stack([np.abs(speed_step).max(axis=1) / scale, np.abs(duration_step)])
            both = np.where(np.isfinite(both), both, np.inf)
            size = both.sum(axis=0)
            stalled = (size < _STALLED) | ((both[0] < _STALLED_SPEED) & (size < _LONGEST_STEP))
            relative = np.stack([both[0] * scale / self.impacts.velocity, both[1]])
            self.correction = np.where(self.done, self.correction, relative)
            self.done = self.done | (size < _EXACT) | (stalled & (size > last / 2))
            if self.done.all():
                return
            slower = np.where(size > _FALLS * last, longest / 2, longest * 1.5)
            longest = np.minimum(np.maximum(slower, _SHORTEST_STEP), _LONGEST_STEP)
            settled = both[0] < _SETTLED
            share = np.where(settled, np.minimum(1.0, longest / np.maximum(both[1], 1e-300)), 1.0)
            moves = ~self.done & np.isfinite(size)
            stretch = np.where(moves & settled, share * duration_step, 0.0)
            acceleration = -self.impacts.pull[:, None] * self.force[:, :-1]
            shift = (self.duration * stretch)[:, None] * self.rule.share[:-1]
            move = np.where(moves[:, None], share[:, None] * speed_step, 0.0)
            self.speed = self.speed + move + acceleration * shift
            self.duration = self.duration * np.exp(stretch)
            last = np.where(settled, size, np.inf)

    def _newton_step(self) -> tuple[FloatArray, FloatArray]:
        """Corrections of v at the instants of the nodes, shape (n, k), and of ln T, shape (n,).

        The residuals are those of v = v_0 - 2 E*/M int F dt at the nodes, and of the condition at the end.
        """
        by_speed, k = self.forces(), self.speed.shape[1]
        impulses = (self.impacts.pull * self.duration)[:, None, None] * self.rule.integrals
        change = self.start.speed[:, None] - times(impulses, self.force[:, :-1])
        self.end_speed = change[:, -1]
        matrix = impulses @ by_speed[:, :k]
        step = _solved(matrix[:, :k] + np.eye(k), change[:, :k] - self.speed)
        end_speed = self.end_speed - (matrix[:, -1] * step).sum(axis=1)
        end_force = self.force[:, -1] + (by_speed[:, -1] * step).sum(axis=1)
        value, rate = self.end(step, end_speed, end_force)
        return step, -value / (rate * self.duration)

    def _operators(self) -> None:
        """Matrices that depend on the duration: integrals with memory, fading, and response of the stress to v."""
        b, T, k = self.impacts, self.duration, self.speed.shape[1]
        rates = b.rates * T[:, None]
        self.memory = T[:, None, None, None] * self.rule.memory(rates)
        self.fading = np.exp(-rates[..., None] * self.rule.share)
        self.response = (b.weights[..., None, None] * self.memory).sum(axis=1)
        self.response[:, :k] += b.viscosity[:, None, None] * np.eye(k)

    def relaxed(self, source: FloatArray, start: FloatArray) -> FloatArray:
        """Solution of u_j' = w_j source - r_j u_j at nodes and end, shape (n, m, k + 1)."""
        driven = self.impacts.weights[..., None] * source[:, None]
        return times(self.memory, driven) + start[..., None] * self.fading

    def _shorten(self) -> bool:
        """Shorten durations to the first node beyond the end of the phase; returns whether any was shortened.

        Without this Newton's method may converge to a later solution, at which the speed or the force vanishes again.
        """
        shares = self.rule.share[:-1]
        beyond = self.beyond_end() & ~self.done[:, None] & (shares < _ENDED)
        if not beyond.any():
            return False
        share = np.where(beyond.any(axis=1), shares[beyond.argmax(axis=1)], 1.0)
        shortened = self.speed_at(self.rule.place(share[:, None] * shares))
        self.speed = np.where((share < 1)[:, None], shortened, self.speed)
        self.duration = self.duration * share
        return True


@dataclass(eq=False)
class Growth(Phase):
    """Growth of the contact from the touch or a break to the turn, or to a break at depths `until`, shape (n,)."""

    until: FloatArray | None = None
    load: FloatArray = field(init=False)

    def beyond_end(self) -> BoolArray:
        """Whether the body moves back."""
        return np.asarray(self.speed < 0)

    def forces(self) -> FloatArray:
        """F/(2 E*) = sum_j L_j + eta K v."""
        v, T, eta, k = self.speed, self.duration[:, None], self.impacts.viscosity[:, None], self.speed.shape[1]
        integrals, response = self.rule.integrals[:-1], self.response
        self.stiffness, slope, self.radius = self.impacts.springs(self.depth, self.piece)
        K = self.stiffness[:, :k]
        self.load = self.relaxed(K * v, self.start.load)
        self.force = self.load.sum(axis=1)
        self.force[:, :k] += eta * K * v
        return np.asarray(response * K[:, None] + (response * (v * slope[:, :k] * T)[:, None]) @ integrals)

    def end(self, step: FloatArray, speed: FloatArray, force: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The speed at the turn, or the depth less that of the break."""
        if self.until is None:
            return speed, -self.impacts.pull * (force + self.impacts.viscosity * self.stiffness[:, -1] * speed)
        return self.depth[:, -1] + self.duration * (self.rule.integrals[-1] * step).sum(axis=1) - self.until, speed

    def finish(self) -> State:
        """State at the end; a shrinkage looks up s_j, L_j, depth and v, `past`, at the start, the nodes and the end."""
        start, depth, end_speed = self.start, self.depth, self.end_speed * (self.until is not None)
        self.stress = self.relaxed(self.speed, start.stress)
        rows = [self.stress, self.load, depth[:, None], np.column_stack([self.speed, end_speed])[:, None]]
        first = np.concatenate([start.stress, start.load, start.depth[:, None], start.speed[:, None]], axis=1)
        self.past = np.concatenate([first[..., None], np.concatenate(rows, axis=1)], axis=2)
        time = start.time + self.duration
        self.final = State(time, end_speed, depth[:, -1], self.stress[..., -1], self.load[..., -1])
        return self.final


@dataclass(eq=False)
class Shrinkage(Phase):
    """Shrinkage of the contact from the turn or a break until the edge is back where a growth started.

    Attributes:
        growth: The growth.
        share: theta at the nodes as a share of the growth, shape (n, k).
        is_guessed: Whether speeds and theta come from a similar motion, and not from an elastic one.
        stress: s_j at nodes and end.
        forgotten: exp(-r_j (t - theta)) (s_j K - L_j) at nodes and end, K, s_j and L_j at theta.
    """

    growth: Growth
    share: FloatArray
    is_guessed: bool
    stress: FloatArray = field(init=False)
    forgotten: FloatArray = field(init=False)

    def _operators(self) -> None:
        """Matrices that depend on the duration, and the stresses."""
        super()._operators()
        self.stress = self.relaxed(self.speed, self.start.stress)

    def forces(self) -> FloatArray:
        """F/(2 E*) = K (sum_j s_j + eta v) - sum_j forgotten_j."""
        g, m, k = self.growth, self.impacts.rates.shape[1], self.speed.shape[1]
        first = self._first_spring()
        if self.sweeps > 1 or self.is_guessed:
            self._find_edge(first[:, :k])
        share = np.column_stack([self.share, np.zeros(len(first))])
        past = interpolated(g.past, g.rule.place(self.share), with_ends=True)
        past = np.concatenate([past, g.past[..., :1]], axis=2)
        self.stiffness, _, self.radius = self.impacts.springs(past[:, -2], self.piece)
        self.forgotten = self.fading_since(share) * (past[:, :m] * self.stiffness[:, None] - past[:, m : 2 * m])
        self.force = self.stiffness * first - self.forgotten.sum(axis=1)
        return np.asarray(self.stiffness[..., None] * self.response)

    def end(self, step: FloatArray, speed: FloatArray, force: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The stress of the innermost spring of the growth."""
        b, eta, first = self.impacts, self.impacts.viscosity, self.growth.start.stress
        change = b.weights * (self.memory[:, :, -1] * step[:, None]).sum(axis=-1)
        stress = self.stress[..., -1] + change - self.fading_since(np.zeros_like(self.force))[..., -1] * first
        acceleration = -b.pull * (force + eta * self.stiffness[:, -1] * speed)
        rate = (b.weights * speed[:, None] - b.rates * stress).sum(axis=1) + eta * acceleration
        return stress.sum(axis=1) + eta * speed, rate

    def beyond_end(self) -> BoolArray:
        """Whether even the innermost spring is released: a layer that relaxed nearly whole lets go early."""
        if self.sweeps == 1 and not self.is_guessed:
            return np.zeros(self.speed.shape, dtype=bool)
        innermost = self.growth.start.stress[..., None] * self.fading_since(np.zeros_like(self.fading[:, 0]))
        released = self._first_spring() < innermost.sum(axis=1)
        return np.asarray(released[:, :-1] & (self.impacts.viscosity == 0)[:, None])

    def _first_spring(self) -> FloatArray:
        """sum_j s_j + eta v at nodes and end, without the dashpot at the end."""
        total = self.stress.sum(axis=1)
        total[:, :-1] += self.impacts.viscosity[:, None] * self.speed
        return np.asarray(total)

    def fading_since(self, share: FloatArray) -> FloatArray:
        """exp(-r_j (t - theta)) at the nodes, and at the end if theta is given there, shape (n, m, ..)."""
        g, now = self.growth, self.start.time[:, None] + self.duration[:, None] * self.rule.share[: share.shape[1]]
        lag = now - g.start.time[:, None] - g.duration[:, None] * share
        return np.asarray(np.exp(-self.impacts.rates[..., None] * lag[:, None]))

    def _find_edge(self, stress: FloatArray) -> None:
        """Find theta by safeguarded Newton steps for y = (1 - share)^q, nearly linear in time.

        q = 2 from a turn on, where both speeds vanish.
        """
        g, b, m = self.growth, self.impacts, self.impacts.rates.shape[1]
        q = 2.0 if g.until is None else 1.0
        y, known = (1 - self.share) ** q, np.broadcast_to(self.done[:, None], self.share.shape)
        low, high = np.zeros_like(y), np.ones_like(y)
        for _ in range(_EDGE_STEPS):
            share = 1 - y ** (1 / q)
            past, fading = interpolated(g.past, g.rule.place(share), with_ends=True), self.fading_since(share)
            excess = stress - (fading * past[:, :m]).sum(axis=1)
            low, high = np.where(excess < 0, y, low), np.where(excess < 0, high, y)
            slope = (fading * b.weights[..., None]).sum(axis=1) * past[:, -1] * g.duration[:, None]
            new, middle = y - excess * q * y ** (1 - 1 / q) / slope, (low + high) / 2
            # Before the first touch nothing is pressed: a root beyond y = 1 is there.
            new = np.where((new > high) & (high == 1), 1.0, np.where((new >= low) & (new <= high), new, middle))
            close = np.abs(new - y) < _EDGE_STEP
            y, known = np.where(known, y, new), known | close
            if known.all():
                break
        self.share = np.where(self.done[:, None], self.share, 1 - y ** (1 / q))

    def finish(self) -> State:
        """State at the end."""
        time, load = self.start.time + self.duration, self.growth.start.load
        self.final = State(time, self.end_speed, self.depth[:, -1], self.stress[..., -1], load)
        return self.final


def _solved(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solutions of linear systems, nan where one is singular: a body that never turns."""
    try:
        return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0])
    except np.linalg.LinAlgError:
        if len(matrix) == 1:
            return np.full_like(right, np.nan)
        return np.concatenate([_solved(matrix[[i]], right[[i]]) for i in range(len(matrix))])

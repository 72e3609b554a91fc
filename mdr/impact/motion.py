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

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from contact.records.validation import BoolArray, FloatArray
from mdr.impact.rules import Rule, interpolated, resampling
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
# Share of a phase before which it may not end; nodes beyond are within a Newton step of the end.
_ENDED = 0.7
# Most steps of the search for theta, and the size of the last, in shares of the growth: its square is rounding.
_EDGE_STEPS, _EDGE_STEP = 40, 1e-9


@dataclass(frozen=True, eq=False)
class Bodies:
    """Impacts that are solved together, in the units of their tracks; n of them, each with m branches.

    Attributes:
        tracks: K and a of each.
        power: p of the first phase.
        reach: Depth up to which each is tabulated, shape (n,).
        velocity: v_0, shape (n,).
        pull: 2 E*/M [1/s^2] in these units, shape (n,).
        weights: w_j, shape (n, m).
        rates: r_j [1/s], shape (n, m).
        viscosity: eta [s], shape (n,).
    """

    tracks: Sequence[Track]
    power: int
    reach: FloatArray
    velocity: FloatArray
    pull: FloatArray
    weights: FloatArray
    rates: FloatArray
    viscosity: FloatArray

    @property
    def is_elastic(self) -> bool:
        """Whether the layer is elastic, so that shrinkages mirror growths."""
        return not (self.rates.any() or self.viscosity.any())

    def springs(self, depth: FloatArray, piece: int) -> FloatArray:
        """K, dK/d(depth) and a at depths of shape (n, k) on one piece, shape (3, n, k)."""
        depth, found = np.minimum(depth, self.reach[:, None]), np.empty((3, *depth.shape))
        for track in {id(one): one for one in self.tracks}.values():
            own = [i for i, one in enumerate(self.tracks) if one is track]
            found[:, own] = track.at(depth[own], piece)
        return found

    def until(self, piece: int) -> FloatArray:
        """Depths at the end of a piece, infinite if it is the last, shape (n,)."""
        return np.array([track.until(piece) for track in self.tracks])


class State(NamedTuple):
    """Between two phases: time, speed, depth, s_j and L_j, shapes (n,) and (n, m)."""

    time: FloatArray
    speed: FloatArray
    depth: FloatArray
    stress: FloatArray
    load: FloatArray


@dataclass(eq=False)
class Phase:
    """One phase of some impacts; rows at nodes and end have shape (n, k + 1).

    Attributes:
        bodies: The impacts.
        piece: Of their tracks.
        rule: Nodes.
        start: State at its start.
        duration: T [s], shape (n,).
        speed: At the nodes, shape (n, k).
        unsure: Last corrections of the speeds over the largest, and of ln T, shape (2, n).
        sweeps: Of Newton's method.
        force: Over 2 E* at the nodes, shape (n, k).
        radius: a at the nodes and maybe the end.
    """

    bodies: Bodies
    piece: int
    rule: Rule
    start: State
    duration: FloatArray
    speed: FloatArray
    unsure: FloatArray = field(default_factory=lambda: np.zeros((2, 0)))
    sweeps: int = 0
    force: FloatArray = field(default_factory=lambda: np.zeros(0))
    radius: FloatArray = field(default_factory=lambda: np.zeros(0))

    @property
    def depth(self) -> FloatArray:
        """At nodes and end."""
        rise = times(self.rule.integrals, self.speed)
        return np.asarray(self.start.depth[:, None] + self.duration[:, None] * rise)

    def series(self) -> FloatArray:
        """Depth, speed, force over 2 E* and radius at the nodes, shape (4, n, k)."""
        k = self.speed.shape[1]
        return np.stack([self.depth[:, :k], self.speed, self.force, self.radius[:, :k]])

    def speeds(self, share: FloatArray) -> FloatArray:
        """Speeds at shares of the duration, shape (n, k)."""
        return self.rule.at(self.speed, self.rule.place(share))

    def resampled(self, nodes: int) -> FloatArray:
        """Speeds at so many nodes, shape (n, nodes)."""
        return times(resampling(self.speed.shape[1], nodes), self.speed)

    def lengthen(self) -> None:
        """Operators that depend on the duration."""
        b, T = self.bodies, self.duration
        n, m = b.rates.shape
        self._memory = np.empty((n, m, *self.rule.integrals.shape))
        self._memory[:, 0] = T[:, None, None] * self.rule.integrals
        self._memory[:, 1:] = T[:, None, None, None] * self.rule.memory(b.rates[:, 1:] * T[:, None])
        self._fade = np.exp(-(b.rates * T[:, None])[..., None] * self.rule.share)
        whole = (b.weights[..., None, None] * self._memory).sum(axis=1)
        self._relax_end = whole[:, -1]
        self._answer = whole[:, :-1] + b.viscosity[:, None, None] * np.eye(self.rule.nodes.size)

    def remembered(self, source: FloatArray, start: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Solution of u' = w source - r u at nodes and end, and its change with T; shapes (n, m, k + 1)."""
        b, T = self.bodies, self.duration[:, None, None]
        driven = b.weights[..., None] * source[:, None]
        grown = times(self._memory, driven)
        faded = start[..., None] * self._fade
        rates = b.rates[..., None]
        change = times(self._memory, driven - rates * grown[..., :-1]) / T - rates * self.rule.share * faded
        return grown + faded, change

    def cut(self, ended: BoolArray) -> bool:
        """Shortens durations to the first node beyond the end of the phase; returns whether any was shortened.

        Without this Newton's method may converge to a later solution, at which the speed or the force vanishes again.
        Nodes after the share `_ENDED` of the phase do not count.

        Args:
            ended: whether each node lies beyond the end, shape (n, k).
        """
        shares = self.rule.share[:-1]
        ended = ended & (shares < _ENDED)
        if not ended.any():
            return False
        share = np.where(ended.any(axis=1), shares[ended.argmax(axis=1)], 1.0)
        self.speed = np.where((share < 1)[:, None], self.speeds(share[:, None] * shares), self.speed)
        self.duration = self.duration * share
        return True

    def newton(self, force: FloatArray, by_speed: FloatArray, by_time: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Residual of the motion and its derivatives by speeds and ln T, the end's speed in the last row.

        Args:
            force: Over 2 E*, shape (n, k).
            by_speed: Its derivatives, shape (n, k, k).
            by_time: Its derivative by T, shape (n, k).
        """
        n, k = self.speed.shape
        T, pull = self.duration[:, None], self.bodies.pull[:, None]
        integrals = self.rule.integrals
        lost = pull * T * times(integrals, force)
        system = np.empty((n, k + 1, k + 1))
        system[:, :, :k] = (pull * T)[..., None] * (integrals @ by_speed)
        system[:, :, k] = lost + pull * T**2 * times(integrals, by_time)
        system[:, np.arange(k), np.arange(k)] += 1
        missed = np.concatenate([self.speed, np.zeros((n, 1))], axis=1) - self.start.speed[:, None] + lost
        self.force, self.end_speed = force, -missed[:, -1]
        return missed, system

    def iterate(self, system: Callable[[BoolArray | None], tuple[FloatArray, FloatArray]]) -> None:
        """Newton's method on a residual and its derivatives; `system` is told which impacts are done."""
        n = self.duration.size
        done, last, longest = np.zeros(n, dtype=bool), np.full(n, np.inf), np.full(n, _LONGEST_STEP)
        self.unsure = np.full((2, n), np.inf)
        for sweep in range(_SWEEPS):
            missed, matrix = system(done if sweep else None)
            step = _solved(matrix, missed)
            scale = np.maximum(np.abs(self.speed).max(axis=1), np.abs(self.start.speed))
            # Nodes move with the duration: the change of a speed at its instant counts.
            drift = self.bodies.pull[:, None] * self.force * self.duration[:, None] * self.rule.share[:-1]
            both = np.stack([np.abs(step[:, :-1] + drift * step[:, -1:]).max(axis=1) / scale, np.abs(step[:, -1])])
            both = np.where(np.isfinite(both), both, np.inf)
            size = both.sum(axis=0)
            stalled = (size < _STALLED) | ((both[0] < _STALLED_SPEED) & (size < _LONGEST_STEP))
            now = ~done & ~((size < _EXACT) | (stalled & (size > last / 2)))
            self.unsure = np.where(done, self.unsure, both)
            done, self.sweeps = ~now, sweep + 1
            if done.all():
                return
            slower = np.where(size > _FALLS * last, longest / 2, longest * 1.5)
            longest = np.minimum(np.maximum(slower, _SHORTEST_STEP), _LONGEST_STEP)
            share = np.minimum(1.0, longest / np.maximum(both[1], 1e-300))
            move = np.where((now & np.isfinite(size))[:, None], share[:, None] * step, 0.0)
            self.speed = self.speed - move[:, :-1]
            self.duration = self.duration * np.exp(-move[:, -1])
            last = size


class Growth(Phase):
    """From the touch, or a break, to the turn or the next break at depths `until`."""

    def solve(self, until: FloatArray | None) -> None:
        """Newton's method."""
        self.turned = until is None

        def system(done: BoolArray | None) -> tuple[FloatArray, FloatArray]:
            if done is not None:
                self.cut((self.speed < 0) & ~done[:, None])
            return self._system(until)

        self.iterate(system)

    def _system(self, until: FloatArray | None) -> tuple[FloatArray, FloatArray]:
        self.lengthen()
        b, v, k = self.bodies, self.speed, self.speed.shape[1]
        T, inner, last = self.duration[:, None], self.rule.integrals[:-1], self.rule.integrals[-1]
        depth = self.depth
        self.stiffness, rise, self.radius = b.springs(depth, self.piece)
        K, rise = self.stiffness[:, :-1], rise[:, :-1]
        self.load, change = self.remembered(K * v, self.start.load)
        force = self.load[..., :-1].sum(axis=1) + b.viscosity[:, None] * K * v
        by_speed = self._answer * K[:, None] + (self._answer * (v * rise * T)[:, None]) @ inner
        by_time = change[..., :-1].sum(axis=1) + times(self._answer, rise * v * times(inner, v))
        missed, system = self.newton(force, by_speed, by_time)
        if until is not None:
            missed[:, -1] = depth[:, -1] - until
            system[:, -1, :k] = T * last
            system[:, -1, k] = (T * v * last).sum(axis=1)
        return missed, system

    def finish(self) -> State:
        """Rows that a shrinkage looks up, and the state at the end."""
        speed, depth = np.zeros_like(self.end_speed) if self.turned else self.end_speed, self.depth
        self.stress, _ = self.remembered(self.speed, self.start.stress)
        ends = np.concatenate([self.speed, speed[:, None]], axis=1)
        self.past = np.concatenate([self.stress, self.load, depth[:, None], ends[:, None]], axis=1)
        return State(self.start.time + self.duration, speed, depth[:, -1], self.stress[..., -1], self.load[..., -1])


class Shrinkage(Phase):
    """From the turn, or a break, until the edge is back where a growth started."""

    growth: Growth
    share: FloatArray
    stress: FloatArray
    forgotten: FloatArray

    def solve(self, growth: Growth, share: FloatArray, *, searched: bool) -> None:
        """Newton's method; theta, first at a share of the growth, is searched for at once or after one sweep."""
        self.growth, self.share = growth, share
        none = np.zeros(self.duration.size, dtype=bool) if searched else None
        self.iterate(lambda done: self._system(none if done is None else done))

    def _system(self, found: BoolArray | None, *, whole: bool = True) -> tuple[FloatArray, FloatArray]:
        self.lengthen()
        b, g, v, k = self.bodies, self.growth, self.speed, self.speed.shape[1]
        self.stress, change = self.remembered(v, self.start.stress)
        total = self.stress[..., :-1].sum(axis=1) + b.viscosity[:, None] * v
        if b.tracks[0].is_punch:
            K, lost, later, self.radius = g.stiffness[:, :-1], 0 * v, 0 * v, g.radius[:, :-1]
        else:
            if found is not None:
                # A layer that relaxed nearly whole lets go early, and its force would come back later.
                held = (g.start.stress[..., None] * self.since(0 * v)).sum(axis=1)
                released = (total < held) & ((b.viscosity == 0) & ~found)[:, None]
                if whole and self.cut(released):
                    return self._system(found, whole=False)
                self._find_edge(total, found)
            K, lost, later = self._at_edge()
        self.stiffness = K
        by_time = K * change[..., :-1].sum(axis=1) - later
        missed, system = self.newton(K * total - lost, K[..., None] * self._answer, by_time)
        end = self.start.time + self.duration - g.start.time
        held = np.exp(-b.rates * end[:, None]) * g.start.stress
        system[:, -1] *= -b.viscosity[:, None]
        system[:, -1, :k] += self._relax_end
        system[:, -1, k] += self.duration * (change[..., -1].sum(axis=1) + (b.rates * held).sum(axis=1))
        missed[:, -1] = self.stress[..., -1].sum(axis=1) + b.viscosity * self.end_speed - held.sum(axis=1)
        return missed, system

    def ago(self, share: FloatArray) -> FloatArray:
        """t - theta at the nodes."""
        g = self.growth
        now = self.start.time[:, None] + self.duration[:, None] * self.rule.share[:-1]
        return np.asarray(now - g.start.time[:, None] - g.duration[:, None] * share)

    def since(self, share: FloatArray) -> FloatArray:
        """exp(-r_j (t - theta)) at the nodes, shape (n, m, k)."""
        return np.asarray(np.exp(-self.bodies.rates[..., None] * self.ago(share)[:, None]))

    def _find_edge(self, total: FloatArray, found: BoolArray) -> None:
        """theta, as a share of the growth, by safeguarded Newton steps for y = (1 - share)^q, nearly linear in time.

        q = 2 from a turn on, where both speeds vanish. Impacts that are `found` keep theirs.
        """
        g, b, m = self.growth, self.bodies, self.bodies.rates.shape[1]
        q = 2.0 if g.turned else 1.0
        y, done = (1 - self.share) ** q, np.broadcast_to(found[:, None], self.share.shape)
        low, high = np.zeros_like(y), np.ones_like(y)
        for _ in range(_EDGE_STEPS):
            share = 1 - y ** (1 / q)
            old = interpolated(g.past, g.rule.place(share))
            fade = self.since(share)
            excess = total - (fade * old[:, :m]).sum(axis=1)
            low, high = np.where(excess < 0, y, low), np.where(excess < 0, high, y)
            slope = (fade * b.weights[..., None]).sum(axis=1) * old[:, -1] * g.duration[:, None]
            step = excess * q * y ** (1 - 1 / q) / slope
            new, middle = y - step, (low + high) / 2
            # Before the first touch nothing is pressed: a root beyond y = 1 is there.
            new = np.where((new > high) & (high == 1), 1.0, np.where((new >= low) & (new <= high), new, middle))
            moved = np.abs(new - y)
            y, done = np.where(done, y, new), done | (moved < _EDGE_STEP)
            if done.all():
                break
        self.share = np.where(found[:, None], self.share, 1 - y ** (1 / q))

    def _at_edge(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """K, what the springs in contact have forgotten since, and its change with T; shape (n, k) each."""
        g, b, m = self.growth, self.bodies, self.bodies.rates.shape[1]
        old = interpolated(g.past, g.rule.place(self.share))
        K, _, self.radius = b.springs(old[:, -2], self.piece)
        self.forgotten = self.since(self.share) * (old[:, :m] * K[:, None] - old[:, m : 2 * m])
        later = (-b.rates[..., None] * self.rule.share[:-1] * self.forgotten).sum(axis=1)
        return K, self.forgotten.sum(axis=1), later

    def finish(self) -> State:
        """The state at the end."""
        time, load = self.start.time + self.duration, self.growth.start.load
        return State(time, self.end_speed, self.depth[:, -1], self.stress[..., -1], load)


def _solved(matrix: FloatArray, right: FloatArray) -> FloatArray:
    """Solutions of linear systems, nan where one is singular: a body that never turns."""
    try:
        return np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0])
    except np.linalg.LinAlgError:
        if len(matrix) == 1:
            return np.full_like(right, np.nan)
        return np.concatenate([_solved(matrix[[i]], right[[i]]) for i in range(len(matrix))])


def times(matrix: FloatArray, vector: FloatArray) -> FloatArray:
    """Products of matrices and vectors, each by itself, so that they do not depend on the number of them."""
    return np.asarray((matrix @ vector[..., None])[..., 0])

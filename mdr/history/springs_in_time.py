"""A bed of viscoelastic springs under a prescribed depth: each spring is independent of all others.

In units of the instantaneous modulus a spring in contact carries f = g_inf w + eta w' + sum_j s_j with
s_j' = g_j w' - s_j/tau_j; a free one carries nothing, and its surface u creeps back by the same law. A spring is
touched where the indenter reaches its surface, and released where its force reaches zero. Between two instants the
depth is linear in time and everything is an exponential: steps may be long.

That is all of the contact, loading, unloading or reloading: with the factor A = C C^T of the layer's equation
(psi = C^T phi for pressures, C^-1 W for displacements; C is lower triangular and knows no time), pressures within a are
springs within a, and the viscoelastic law holds spring by spring. What it takes is one circle of contact.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from contact.records.validation import FloatArray
from contact.scene.effects import Relaxation

_ROOT_STEPS = 12  # of the Illinois rule, for the instant within a step where a spring is touched or released


@dataclass(frozen=True)
class SpringLaw:
    """A relaxation function in units of its instantaneous modulus.

    Attributes:
        long_term: g_inf.
        viscosity: eta over the modulus [s].
        weights: g_j, shape (branches, 1).
        times: tau_j [s], shape (branches, 1).
    """

    long_term: float
    viscosity: float
    weights: FloatArray
    times: FloatArray
    _modes: dict[float, FloatArray] = field(default_factory=dict, compare=False)

    @classmethod
    def of(cls, relaxation: Relaxation) -> SpringLaw:
        """From moduli in pascals."""
        modulus = relaxation.instantaneous_modulus
        return cls(
            relaxation.long_term_modulus / modulus,
            relaxation.viscosity / modulus,
            relaxation.moduli[:, None] / modulus,
            relaxation.times[:, None],
        )

    @property
    def is_elastic(self) -> bool:
        """Whether forces know the present only."""
        return self.viscosity == 0.0 and not np.any(self.weights)

    def pressed(self, branches: FloatArray, speed: float, time: FloatArray | float) -> FloatArray:
        """s_j after a time at constant speed."""
        decay = np.exp(-time / self.times)
        return np.asarray(decay * branches - self.weights * self.times * np.expm1(-time / self.times) * speed)

    def force(self, w: FloatArray, branches: FloatArray, speed: float) -> FloatArray:
        """Force of springs in contact."""
        return np.asarray(self.long_term * w + self.viscosity * speed + branches.sum(axis=0))

    def free(self, state: FloatArray, time: FloatArray) -> FloatArray:
        """Surface u and s_j of free springs, shape (1 + branches, n), each after its own time."""
        values, vectors, inverse = self._spectrum
        modal = np.exp(np.multiply.outer(values, time)) * (inverse @ state)
        return np.asarray((vectors @ modal).real)

    def recovered(self, state: FloatArray, time: float) -> FloatArray:
        """The same, all after one time; exact for repeated eigenvalues too."""
        if time not in self._modes:
            self._modes[time] = expm(time * self._generator())
        return np.asarray(self._modes[time] @ state)

    def _generator(self) -> FloatArray:
        """d(u, s)/dt of a free spring: g_inf u + eta u' + sum s = 0 and s' = g u' - s/tau."""
        weights, rates = self.weights[:, 0], 1.0 / self.times[:, 0]
        if self.viscosity > 0.0:
            speed = -np.concatenate([[self.long_term], np.ones(weights.size)]) / self.viscosity
        else:  # differentiated: (g_inf + sum g) u' = sum s/tau, and the bracket is one
            speed = np.concatenate([[0.0], rates])
        generator: FloatArray = np.outer(np.concatenate([[1.0], weights]), speed)
        generator[1:, 1:] -= np.diag(rates)
        return np.asarray(generator, dtype=np.float64)

    @cached_property
    def _spectrum(self) -> tuple[NDArray[np.complex128], NDArray[np.complex128], NDArray[np.complex128]]:
        values, vectors = np.linalg.eig(self._generator().astype(np.complex128))
        return values, vectors, np.linalg.inv(vectors)


@dataclass(frozen=True)
class BedState:
    """All springs at one instant.

    Attributes:
        depth: delta [m].
        touching: Which springs are in contact, shape (n,).
        surface: Displacement u of each spring's end [m]: delta - g where touching.
        branches: s_j [m], shape (branches, n).
    """

    depth: float
    touching: NDArray[np.bool_]
    surface: FloatArray
    branches: FloatArray


def undeformed(law: SpringLaw, profile: FloatArray, depth: float) -> BedState:
    """The bed at first sight: a depth that is there from the start has been reached at once."""
    touching = profile < depth
    surface = np.where(touching, depth - profile, 0.0)
    return BedState(depth, touching, surface, law.weights * surface)


def advance(law: SpringLaw, profile: FloatArray, state: BedState, depth: float, time: float) -> BedState:
    """The bed after a time [s] in which the depth has moved linearly to a new value."""
    speed = (depth - state.depth) / time
    reached, at = _reached(law, profile, state, speed, time)
    free = ~state.touching
    moved = law.recovered(np.vstack([state.surface, state.branches])[:, free], time)
    surface, branches = state.surface.copy(), state.branches.copy()
    surface[free], branches[:, free] = moved[0], moved[1:]
    if reached.any():
        met = law.free(np.vstack([state.surface, state.branches])[:, reached], at)
        branches[:, reached] = law.pressed(met[1:], speed, time - at)
    held = state.touching
    branches[:, held] = law.pressed(state.branches[:, held], speed, time)
    grazed = reached & (law.force(depth - profile, branches, speed) < 0.0)  # touched and gone within the step
    branches[:, grazed] = law.recovered(np.vstack([state.surface, state.branches])[:, grazed], time)[1:]
    touching = held | (reached & ~grazed)
    surface[touching] = depth - profile[touching]
    return _released(law, profile, state, BedState(depth, touching, surface, branches), time)


def _reached(
    law: SpringLaw, profile: FloatArray, state: BedState, speed: float, time: float
) -> tuple[NDArray[np.bool_], FloatArray]:
    """Springs that the indenter reaches within a step, and when."""
    free = np.flatnonzero(~state.touching)
    start = np.vstack([state.surface, state.branches])[:, free]

    def gap(own: NDArray[np.intp], at: FloatArray) -> FloatArray:
        return np.asarray(law.free(start[:, own], at)[0] - (state.depth + speed * at - profile[free[own]]))

    ahead = law.recovered(start, time)[0] - (state.depth + speed * time - profile[free]) < 0.0
    own = np.flatnonzero(ahead)
    virgin = ~np.any(start[:, own], axis=0)
    bent = np.zeros(own.size) if virgin.all() else _instant(lambda at: gap(own, at), own.size, time)
    straight = (profile[free[own]] - state.depth) / speed if speed != 0.0 else bent
    reached = np.zeros(profile.size, dtype=np.bool_)
    reached[free[own]] = True
    return reached, np.where(virgin, np.clip(straight, 0.0, time), bent)


def _instant(falling: Callable[[FloatArray], FloatArray], count: int, time: float) -> FloatArray:
    """Where functions that end below zero first do so: the Illinois rule; at once where they start there."""
    low, high, side = np.zeros(count), np.full(count, time), np.zeros(count)
    above, below = np.maximum(falling(low), 0.0), falling(high)
    for _ in range(_ROOT_STEPS):
        at = low + (high - low) * np.divide(above, above - below, out=np.zeros(count), where=above > 0.0)
        value = falling(at)
        stays = value > 0.0
        below = np.where(stays, np.where(side > 0.0, 0.5 * below, below), value)
        above = np.where(stays, value, np.where(side < 0.0, 0.5 * above, above))
        low, high, side = np.where(stays, at, low), np.where(stays, high, at), np.where(stays, 1.0, -1.0)
    return np.asarray(at)


def _released(law: SpringLaw, profile: FloatArray, before: BedState, after: BedState, time: float) -> BedState:
    """Let go the springs that would pull at the end of a step, from the instant on where they began to."""
    speed = (after.depth - before.depth) / time
    pulling = after.touching & (law.force(after.surface, after.branches, speed) < 0.0)
    if not pulling.any():
        return after
    own = np.flatnonzero(pulling)
    w, branches = before.depth - profile[own], before.branches[:, own]

    def force(at: FloatArray) -> FloatArray:
        return law.force(w + speed * at, law.pressed(branches, speed, at), speed)

    at = _instant(force, own.size, time)
    let_go = np.vstack([w + speed * at, law.pressed(branches, speed, at)])
    moved = law.free(let_go, time - at)
    surface, rest, touching = after.surface.copy(), after.branches.copy(), after.touching & ~pulling
    surface[own], rest[:, own] = moved[0], moved[1:]
    return BedState(after.depth, touching, surface, rest)


def released_at_once(law: SpringLaw, profile: FloatArray, state: BedState, time: float) -> BedState:
    """The bed a time after the indenter was taken away; the depth is that of an indenter which just rests on it."""
    free = np.vstack([state.surface, state.branches])
    held = state.touching
    if held.any() and law.viscosity == 0.0:  # an elastic jump back to where each spring carries nothing
        back = law.force(state.surface[held], state.branches[:, held], 0.0)
        free[:, held] -= (
            np.vstack([np.ones((1, back.size)), np.broadcast_to(law.weights, (law.weights.size, back.size))]) * back
        )
    moved = law.recovered(free, time)
    resting = float(np.min(moved[0] + profile))
    return BedState(resting, np.zeros(profile.size, dtype=np.bool_), moved[0], moved[1:])

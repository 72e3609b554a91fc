"""A bed of viscoelastic springs under a prescribed depth: each spring is independent of all others.

In units of the instantaneous modulus a spring in contact carries f = g_inf w + eta w' + sum_j g_j e_j, where each
branch has its elastic strain e_j' = w' - e_j/tau_j; a free one carries nothing, and its surface u creeps back by the
same law. A spring is touched where the indenter reaches its surface, and released where its force reaches zero. Between
two instants the depth is linear in time and everything is an exponential: steps may be long.

That is all of the contact, loading, unloading or reloading: with the factor A = C C^T of the layer's equation
(psi = C^T phi for pressures, C^-1 W for displacements; C is lower triangular and knows no time), pressures within a are
springs within a, and the viscoelastic law holds spring by spring. What it takes is one circle of contact.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from contact import NotConvergedError
from contact.records.validation import FloatArray
from contact.scene.effects import Relaxation
from mdr.history.first_crossing import first_below
from mdr.history.recovery import Modes, modes

# Within a step each spring is looked at after these shares of what is left of it and after these multiples of each
# relaxation time: a touch or release that is over before the end of the step is seen there.
_SHARES = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
_MULTIPLES = np.array([0.5, 2.0])

# How often a spring may be touched or released within one step. A sum of exponentials changes its sign no more often
# than it has terms: a spring that is not done by then goes back and forth by rounding.
_MOST_EVENTS = 40

# Of the largest terms of a force or a gap: nearer to zero its sign is rounding.
_ROUNDING = 8.0 * float(np.finfo(float).eps)


@dataclass(frozen=True)
class SpringLaw:
    """A relaxation function in units of its instantaneous modulus.

    Attributes:
        long_term: g_inf.
        viscosity: eta over the modulus [s].
        weights: g_j, shape (branches,).
        times: tau_j [s], decreasing and no two of them equal, shape (branches,).
    """

    long_term: float
    viscosity: float
    weights: FloatArray
    times: FloatArray

    @classmethod
    def of(cls, relaxation: Relaxation) -> SpringLaw:
        """From moduli in pascals; relaxation times must increase."""
        modulus = relaxation.instantaneous_modulus
        weights, times = relaxation.moduli[::-1] / modulus, relaxation.times[::-1]
        return cls(relaxation.long_term_modulus / modulus, relaxation.viscosity / modulus, weights, times)

    @property
    def is_elastic(self) -> bool:
        """Whether forces know the present only."""
        return self.viscosity == 0.0 and not self.weights.size

    @cached_property
    def clock(self) -> float:
        """The law's own unit of time [s]."""
        return float(self.times[0]) if self.times.size else self.viscosity or 1.0

    @cached_property
    def modes(self) -> Modes:
        """How a free spring creeps back, in units of the clock."""
        return modes(self.long_term, self.viscosity / self.clock, self.weights, self.clock / self.times)

    def pressed(self, strains: FloatArray, speed: float, time: FloatArray) -> FloatArray:
        """e_j after times at constant speed, shape (branches, instants, springs).

        Args:
            strains: Now, shape (branches, springs).
            speed: [m/s].
            time: [s], shape (instants, springs), or (instants, 1) where they are the same for all.
        """
        own = self.times[:, None, None]
        return np.asarray(np.exp(-time / own) * strains[:, None] - own * np.expm1(-time / own) * speed)

    def force(self, w: FloatArray, strains: FloatArray, speed: float) -> FloatArray:
        """Force of springs in contact; the first axis of the strains is that of the branches."""
        return np.asarray(self.long_term * w + self.viscosity * speed + np.tensordot(self.weights, strains, 1))

    def creep_speed(self, surface: FloatArray, strains: FloatArray) -> FloatArray:
        """u' of free springs [m/s]: their force is zero and stays so."""
        if self.viscosity > 0.0:
            return np.asarray(-(self.long_term * surface + np.tensordot(self.weights, strains, 1)) / self.viscosity)
        return np.asarray(np.tensordot(self.weights / self.times, strains, 1))

    def outruns(self, speed: float, surface: float, strains: FloatArray) -> bool:
        """Whether a body at this speed [m/s] is no slower than a free spring.

        A surface at rest creeps by roundings of its strains, which are as large as itself at most.
        """
        u = np.asarray(surface)
        at_rest = _ROUNDING * np.abs(self.creep_speed(u, np.full(strains.shape, surface)))
        return bool(speed >= self.creep_speed(u, strains) - at_rest)

    def faded(self, amplitudes: FloatArray, time: FloatArray) -> FloatArray:
        """Amplitudes of a free spring's modes after times as in `pressed`, shape (modes, instants, springs)."""
        return np.asarray(np.exp(-self.modes.rates[:, None, None] * (time / self.clock)) * amplitudes[:, None])

    def free(self, surface: FloatArray, strains: FloatArray, time: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Surface u, shape (springs,), and e_j, shape (branches, springs), of free springs after times, (1, springs).

        A force that such a spring still carries goes at once, and its surface jumps.
        """
        faded = self.faded(self.modes.amplitudes(surface, strains), time)[:, 0]
        return faded.sum(axis=0), self.modes.strains @ faded


@dataclass(frozen=True)
class BedState:
    """All springs at one instant.

    Attributes:
        depth: delta [m].
        touching: Which springs are in contact, shape (n,).
        surface: Displacement u of each spring's end [m]: delta - g where touching.
        strains: e_j [m], shape (branches, n).
    """

    depth: float
    touching: NDArray[np.bool_]
    surface: FloatArray
    strains: FloatArray


def undeformed(law: SpringLaw, profile: FloatArray, depth: float) -> BedState:
    """The bed at first sight: a depth that is there from the start has been reached at once."""
    touching = profile < depth
    surface = np.where(touching, depth - profile, 0.0)
    return BedState(depth, touching, surface, np.repeat(surface[None], law.weights.size, axis=0))


def advance(law: SpringLaw, profile: FloatArray, state: BedState, depth: float, time: float) -> BedState:
    """The bed after a time [s] in which the depth has moved linearly to a new value.

    Raises:
        NotConvergedError: If a spring is touched and released without end.
    """
    step = _Step(law, profile, state, (depth - state.depth) / time, time)
    moving = np.arange(profile.size)
    for _ in range(_MOST_EVENTS):
        held = step.touching[moving]
        moving = np.concatenate([step.hold(moving[held]), step.creep(moving[~held])])
        if not moving.size:
            surface = np.where(step.touching, depth - profile, step.surface)
            return BedState(depth, step.touching, surface, step.strains)
    raise NotConvergedError(
        f"{moving.size} springs are touched and released more than {_MOST_EVENTS} times between two instants",
        {"springs": float(moving.size)},
    )


class _Step:
    """Springs on their way through a step, each at an instant of its own."""

    def __init__(self, law: SpringLaw, profile: FloatArray, state: BedState, speed: float, time: float) -> None:
        self.law, self.speed = law, speed
        self.touching, self.surface, self.strains = state.touching.copy(), state.surface.copy(), state.strains.copy()
        self.w, self.left = state.depth - profile, np.full(profile.size, time)
        instants = np.multiply.outer(_MULTIPLES, law.times).ravel()
        self.instants = np.sort(instants[instants < time])[:, None]

    def hold(self, own: NDArray[np.intp]) -> NDArray[np.intp]:
        """Keep springs in contact until they would pull; those that are released before the end of the step."""
        law, speed, w, strains = self.law, self.speed, self.w[own], self.strains[:, own]

        def force(some: NDArray[np.intp], time: FloatArray) -> FloatArray:
            return law.force(w[some] + speed * time, law.pressed(strains[:, some], speed, time), speed)

        rounding = _ROUNDING * self._sizes(own, np.tensordot(law.weights, np.abs(strains), 1))
        at, ends = first_below(force, self._times(own), rounding)
        self.strains[:, own] = law.pressed(strains, speed, at)[:, 0]
        self._move(own, at[0])
        self.surface[own] = self.w[own]
        self.touching[own[ends]] = False
        return own[ends]

    def creep(self, own: NDArray[np.intp]) -> NDArray[np.intp]:
        """Let free springs creep until the indenter reaches them; those that are touched before the end of the step."""
        law, speed, w = self.law, self.speed, self.w[own]
        amplitudes = law.modes.amplitudes(self.surface[own], self.strains[:, own])

        def gap(some: NDArray[np.intp], time: FloatArray) -> FloatArray:
            return np.asarray(law.faded(amplitudes[:, some], time).sum(axis=0) - (w[some] + speed * time))

        rounding = _ROUNDING * self._sizes(own, np.abs(amplitudes).sum(axis=0))
        at, ends = first_below(gap, self._times(own), rounding)
        self.surface[own], self.strains[:, own] = law.free(self.surface[own], self.strains[:, own], at)
        self._move(own, at[0])
        self.touching[own[ends]] = True
        return own[ends]

    def _times(self, own: NDArray[np.intp]) -> FloatArray:
        """When to look at springs [s], from now on, shape (instants, 1 or springs)."""
        left = self.left[own]
        if left.size and left.min() == left.max():
            left = left[:1]
        return np.sort(np.concatenate([np.minimum(self.instants, left), np.multiply.outer(_SHARES, left)]), axis=0)

    def _sizes(self, own: NDArray[np.intp], inner: FloatArray) -> FloatArray:
        """Size of the terms in a force or a gap [m]."""
        return np.asarray(np.abs(self.w[own]) + abs(self.speed) * self.left[own] + inner)

    def _move(self, own: NDArray[np.intp], at: FloatArray) -> None:
        self.w[own] += self.speed * at
        self.left[own] -= at


def released_at_once(law: SpringLaw, profile: FloatArray, state: BedState, time: float) -> BedState:
    """The bed a time after the indenter was taken away; the depth is that of an indenter which just rests on it."""
    surface, strains = law.free(state.surface, state.strains, np.full((1, 1), time))
    resting = float(np.min(surface + profile))
    return BedState(resting, np.zeros(profile.size, dtype=np.bool_), surface, strains)

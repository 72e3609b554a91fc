"""Courses of impacts from touch to release: growth piece by piece, then back through the same pieces."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from contact.records.validation import FloatArray, IntArray
from mdr.impact.motion import Bodies, Growth, Phase, Shrinkage, State
from mdr.impact.rules import rule

# Samples of a phase from which the search for the largest force starts. With a third of them narrow peaks are missed.
_PLACES = 129


class Pressed(NamedTuple):
    """Growth of some impacts within one piece of their tracks, and the shrinkage back through it; None if elastic."""

    lanes: IntArray
    growth: Growth
    shrinkage: Shrinkage | None


@dataclass(frozen=True)
class Course:
    """Motions of n impacts.

    Attributes:
        bodies: The impacts.
        parts: Growths in their order, each with its shrinkage.
        turn: State at the turn.
        end: State at the release.
        unsure: Sums over the phases of the last corrections of speed/v_0, ln(duration) and rebound/speed, shape (3, n).
        short: Whether a contact grows beyond its track, shape (n,); its results are invalid then.
    """

    bodies: Bodies
    parts: tuple[Pressed, ...]
    turn: State
    end: State
    unsure: FloatArray
    short: NDArray[np.bool_]

    @property
    def is_elastic(self) -> bool:
        """Whether the layer is elastic, so that the shrinkage mirrors the growth."""
        return not (self.bodies.rates.any() or self.bodies.viscosity.any())

    def outcomes(self) -> FloatArray:
        """Restitution, contact time, largest force over 2 E*, depth and radius, shape (5, n)."""
        force, radius = np.zeros((2, self.short.size))
        for index, growth, _ in self.parts:
            force[index] = np.maximum(force[index], _largest(growth))
            radius[index] = growth.radius[:, -1]
        return np.stack([-self.end.speed / self.bodies.velocity, self.end.time, force, self.turn.depth, radius])


def course(bodies: Bodies, nodes: int, guess: Course | FloatArray) -> Course:
    """Compute the motions of n impacts.

    Args:
        bodies: Impacts on flat punches only, or on tips of one exponent only, with equal numbers of branches.
        nodes: Number of nodes per phase.
        guess: The same motions at another resolution; or durations of the growths [s] and their initial decay rates
            of the speed [1/s], shape (2, n).
    """
    n, m = bodies.rates.shape
    state = State(np.zeros(n), bodies.velocity.copy(), np.zeros(n), np.zeros((n, m)), np.zeros((n, m)))
    unsure, short = np.zeros((3, n)), np.zeros(n, dtype=bool)
    like = guess if isinstance(guess, Course) else None
    if isinstance(guess, Course):
        parts = list(_alike(bodies, nodes, state, guess))
    else:
        parts = list(_growths(bodies, nodes, guess, state, short))
    turn = State(*(one.copy() for one in state))
    found = Course(bodies, tuple(parts), turn, state, unsure, short)
    for number in reversed(range(len(parts))):
        index, growth, _ = parts[number]
        unsure[:2, index] += growth.unsure
        if not found.is_elastic:
            shrinkage = _mirrored(growth, state.take(index), like.parts[number].shrinkage if like else None)
            shrinkage.solve(growth, searched=like is not None)
            # If a dashpot has stopped a body, the speeds of its rebound are far below v_0.
            whole = np.abs(shrinkage.speed).max(axis=1) / shrinkage.bodies.velocity
            speed, duration = shrinkage.unsure
            unsure[:, index] += np.stack([speed * whole, duration, speed])
            state.put(index, shrinkage.finish())
            parts[number] = Pressed(index, growth, shrinkage)
    if found.is_elastic:
        state = state._replace(time=2 * turn.time, speed=-bodies.velocity, depth=0 * turn.depth)
    return replace(found, parts=tuple(parts), end=state)


def _growths(
    bodies: Bodies, nodes: int, guess: FloatArray, state: State, short: NDArray[np.bool_]
) -> Iterator[Pressed]:
    """Solve the growths piece by piece; the state advances to the turn.

    On each piece the turn is sought first. Bodies that turn beyond its end are solved again up to the end.
    """
    going = np.arange(bodies.velocity.size)
    r = rule(nodes, bodies.power, ending=False)
    duration, rate = guess
    lost = np.exp(-(rate * duration)[:, None] * r.share[:-1])
    speed = bodies.velocity[:, None] * (1 - r.share[:-1]) * lost
    for piece in range(max(len(track.pieces) for track in bodies.tracks) or 1):
        own = bodies.take(going)
        trial = Growth(own, piece, r, state.take(going), duration, speed)
        trial.solve(None)
        until = np.array([track.until(piece) for track in own.tracks])
        passes = trial.depth[:, -1] > until
        is_last = np.array([piece + 1 >= len(track.pieces) for track in own.tracks])
        short[going[passes & is_last]] = True
        stays, goes = np.flatnonzero(~passes), np.flatnonzero(passes & ~is_last)
        if stays.size:
            yield _pressed(trial.part(stays), going[stays], state, None)
        if not goes.size:
            return
        part = trial.part(goes)
        passed = np.array([[np.interp(until[i], trial.depth[i], r.share)] for i in goes])
        before, r = r, rule(nodes, 2, ending=False)
        duration = part.duration * (1 - passed[:, 0])
        speed = _speeds(part, passed + (1 - passed) * r.share[:-1])
        part.speed = _speeds(part, passed * before.share[:-1])
        part.duration = part.duration * passed[:, 0]
        yield _pressed(part, going[goes], state, until[goes])
        going = going[goes]


def _alike(bodies: Bodies, nodes: int, state: State, like: Course) -> Iterator[Pressed]:
    """Solve the growths through the same pieces as in another course, whose motion is the first guess."""
    for index, old, _ in like.parts:
        r = rule(nodes, old.rule.power, ending=False)
        speed = _speeds(old, np.broadcast_to(r.share[:-1], (index.size, nodes)))
        growth = Growth(bodies.take(index), old.piece, r, state.take(index), old.duration, speed)
        until = None if old.turned else np.array([track.until(old.piece) for track in growth.bodies.tracks])
        yield _pressed(growth, index, state, until)


def _pressed(growth: Growth, index: IntArray, state: State, until: FloatArray | None) -> Pressed:
    """Solve a growth to the turn, or to depths `until`, and store the state at its end in `state`."""
    growth.solve(until)
    state.put(index, growth.finish(turned=until is None))
    return Pressed(index, growth, None)


def _mirrored(growth: Growth, start: State, like: Shrinkage | None) -> Shrinkage:
    """The unsolved shrinkage back through a growth; the guess is that of another resolution or the elastic one."""
    nodes = growth.speed.shape[1]
    r = rule(nodes, growth.rule.power, ending=True)
    if like is None:
        # An elastic body that entered a piece at a speed v leaves it at -v.
        duration, speed = growth.duration.copy(), -growth.speed[:, ::-1]
        share = np.broadcast_to(1 - r.share[:-1], speed.shape)
    else:
        duration, speed = like.duration, _speeds(like, np.broadcast_to(r.share[:-1], growth.speed.shape))
        share = np.array([np.interp(r.share[:-1], like.rule.share[:-1], one) for one in like.share])
    guess = Shrinkage(growth.bodies, growth.piece, r, start, duration, speed)
    guess.share = share
    return guess


def _speeds(phase: Phase, share: FloatArray) -> FloatArray:
    """Speeds of a phase at shares of its duration, shape (n, k)."""
    r = phase.rule
    s = 1 - (1 - share) ** (1 / r.power) if isinstance(phase, Shrinkage) else share ** (1 / r.power)
    return r.at(phase.speed, s)


def _largest(phase: Growth) -> FloatArray:
    """Largest force over 2 E* of a growth, by Newton steps on its polynomial from the largest of `_PLACES` samples.

    A viscous layer relaxes at the turn, so that the force is smaller after it.
    """
    fit = (phase.rule.analysis @ phase.force[..., None])[..., 0]
    places = np.linspace(0, 1, _PLACES)
    values = phase.rule.at(phase.force, np.broadcast_to(places, (fit.shape[0], _PLACES)))
    s = places[np.clip(values.argmax(axis=1), 1, _PLACES - 2)]
    slope, second = (legendre.legder(fit.T, order) * 2.0**order for order in (1, 2))
    for _ in range(4):
        rise, curved = (
            np.array([legendre.legval(2 * x - 1, one) for x, one in zip(s, c.T, strict=True)]) for c in (slope, second)
        )
        s = np.clip(s - np.where(curved < 0, rise / np.where(curved < 0, curved, 1.0), 0.0), 0, 1)
    return np.asarray(np.maximum(phase.rule.at(phase.force, s[:, None])[:, 0], values.max(axis=1)))

"""Courses of impacts from touch to release: growth piece by piece, then back through the same pieces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.numerics import gauss
from contact.records.validation import BoolArray, FloatArray
from mdr.impact.motion import Bodies, Growth, Phase, Shrinkage, State, times
from mdr.impact.rules import resampling, rule, slopes, vander

# Samples of a phase from which the search for the largest force starts. With a third of them narrow peaks are missed.
_PLACES = 129
# Newton steps of that search: from neighbouring samples two reach the last digit of the force, one leaves 1e-9.
_PEAK_STEPS = 3

# Last correction below which a growth has a turn. With a tenth a longer track is tabulated later, if at all.
_TURNS = 1e-3


class Divided(Exception):
    """Impacts that cannot go on together.

    Args:
        apart: Those that pass a break of the profile, or that exceed the depth up to which their track is tabulated.
        is_short: Whether it is the latter.
    """

    def __init__(self, apart: BoolArray, *, is_short: bool) -> None:
        super().__init__()
        self.apart, self.is_short = apart, is_short


@dataclass(frozen=True, eq=False)
class Course:
    """Motions of n impacts through the same pieces of their tracks.

    Attributes:
        bodies: The impacts.
        growths: In their order.
        shrinkages: In theirs, back through the same pieces; none if elastic.
        turn: State at the turn.
        end: State at the release.
        unsure: Sums over the phases of the last corrections of speed/v_0, ln(duration) and rebound/speed, shape (3, n).
    """

    bodies: Bodies
    growths: list[Growth]
    shrinkages: list[Shrinkage]
    turn: State
    end: State
    unsure: FloatArray

    @property
    def phases(self) -> list[Phase]:
        """All in their order."""
        return [*self.growths, *self.shrinkages]

    def outcomes(self) -> FloatArray:
        """Restitution, contact time, largest force over 2 E*, depth and radius, shape (5, n)."""
        force = np.max([_largest(growth) for growth in self.growths], axis=0)
        radius = self.growths[-1].radius[:, -1]
        return np.stack([-self.end.speed / self.bodies.velocity, self.end.time, force, self.turn.depth, radius])


def course(bodies: Bodies, nodes: int, guess: Course | FloatArray) -> Course:
    """Compute the motions of n impacts.

    Args:
        bodies: Impacts on flat punches only, or on tips of one exponent only, with equal numbers of branches.
        nodes: Number of nodes per phase.
        guess: The same motions at another resolution; or durations of the growths [s] and their initial decay rates
            of the speed [1/s], shape (2, n).

    Raises:
        Divided: If some impacts pass more breaks of the profile than others, or exceed their tracks.
    """
    n, m = bodies.rates.shape
    touch = State(np.zeros(n), bodies.velocity.copy(), np.zeros(n), np.zeros((n, m)), np.zeros((n, m)))
    like = guess if isinstance(guess, Course) else None
    growths = _alike(bodies, nodes, touch, like) if like else _growths(bodies, nodes, touch, np.asarray(guess))
    turn = growths[-1].finish()
    unsure = np.zeros((3, n))
    for growth in growths:
        unsure[:2] += growth.unsure
    if bodies.is_elastic:
        end = turn._replace(time=2 * turn.time, speed=-bodies.velocity, depth=0 * turn.depth)
        return Course(bodies, growths, [], turn, end, unsure)
    shrinkages, state = list[Shrinkage](), turn
    for number, growth in enumerate(growths[::-1]):
        back = _mirrored(growth, state, like.shrinkages[number] if like else None)
        shrinkages.append(back)
        state = back.finish()
        # If a dashpot has stopped a body, the speeds of its rebound are far below v_0.
        whole = np.abs(back.speed).max(axis=1) / bodies.velocity
        speed, duration = back.unsure
        unsure += np.stack([speed * whole, duration, speed])
    return Course(bodies, growths, shrinkages, turn, state, unsure)


def _growths(bodies: Bodies, nodes: int, state: State, guess: FloatArray) -> list[Growth]:
    """Growths piece by piece to the turn. On each the turn is sought first; beyond its end it is solved up to that.

    Raises:
        Divided: As `course` does.
    """
    r, (duration, rate), found = rule(nodes, bodies.power, ending=False), guess, list[Growth]()
    share = r.share[:-1]
    speed = bodies.velocity[:, None] * np.cos(np.pi / 2 * share) * np.exp(-(rate * duration)[:, None] * share)
    while True:
        growth = Growth(bodies, len(found), r, state, duration, speed)
        growth.solve(None)
        until, depth = bodies.until(len(found)), growth.depth
        # A body that never turns in a layer that relaxes completely is no reason for a longer track.
        short = (depth[:, -1] > bodies.reach) & (growth.unsure.sum(axis=0) < _TURNS)
        passes = depth[:, -1] > until
        if short.any() or passes.any() > passes.all():
            raise Divided(short if short.any() else passes, is_short=bool(short.any()))
        found.append(growth)
        if not passes.any():
            return found
        passed = np.array([[np.interp(*row, r.share)] for row in zip(until, depth, strict=True)])
        last, r = r, rule(nodes, 2, ending=False)
        duration, speed = growth.duration * (1 - passed[:, 0]), growth.speeds(passed + (1 - passed) * r.share[:-1])
        growth.speed = growth.speeds(passed * last.share[:-1])
        growth.duration = growth.duration * passed[:, 0]
        growth.solve(until)
        state = growth.finish()


def _alike(bodies: Bodies, nodes: int, state: State, like: Course) -> list[Growth]:
    """Growths through the same pieces as in another course, whose motion is the first guess."""
    found = list[Growth]()
    for old in like.growths:
        state = found[-1].finish() if found else state
        r = rule(nodes, old.rule.power, ending=False)
        growth = Growth(bodies, old.piece, r, state, old.duration, old.resampled(nodes))
        growth.solve(None if old.turned else bodies.until(old.piece))
        found.append(growth)
    return found


def _mirrored(growth: Growth, start: State, like: Shrinkage | None) -> Shrinkage:
    """The shrinkage back through a growth; the guess is that of another resolution or the elastic one."""
    r = rule(growth.speed.shape[1], growth.rule.power, ending=True)
    if like is None:
        # An elastic body that entered a piece at a speed v leaves it at -v.
        duration, speed = growth.duration.copy(), -growth.speed[:, ::-1]
        share = np.broadcast_to(1 - r.share[:-1], speed.shape)
    else:
        duration, speed = like.duration, like.resampled(r.nodes.size)
        share = np.array([np.interp(r.share[:-1], like.rule.share[:-1], one) for one in like.share])
    found = Shrinkage(growth.bodies, growth.piece, r, start, duration, speed)
    found.solve(growth, share, searched=like is not None)
    return found


def _largest(growth: Growth) -> FloatArray:
    """Largest force over 2 E* of a growth, by Newton steps on its polynomial from the largest of `_PLACES` samples.

    A viscous layer relaxes at the turn, so that the force is smaller after it.
    """
    r = growth.rule
    count = r.nodes.size
    values = times(resampling(count, _PLACES), growth.force)
    places, _ = gauss(_PLACES)
    s, fit = places[values.argmax(axis=1)], times(r.analysis, growth.force)
    for _ in range(_PEAK_STEPS):
        basis = vander(s, count)
        rise, curved = ((basis[:, None] @ times(rows, fit)[..., None])[:, 0, 0] for rows in slopes(count))
        s = np.clip(s - np.where(curved < 0, rise / np.where(curved < 0, curved, 1.0), 0.0), 0.0, 1.0)
    last = (vander(s, count)[:, None] @ fit[..., None])[:, 0, 0]
    return np.asarray(np.maximum(last, np.maximum(values.max(axis=1), growth.force[:, -1])))

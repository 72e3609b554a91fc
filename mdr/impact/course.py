"""Courses of impacts from touch to release: growth piece by piece, then back through the same pieces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.numerics import gauss
from contact.records.validation import BoolArray, FloatArray
from mdr.impact.motion import Growth, Impacts, Phase, Shrinkage, State
from mdr.impact.rules import interpolated, rule, times

# Samples of a phase from which the search for the largest force starts. With a third of them narrow peaks are missed.
_PLACES = 129
# Newton steps of that search: from neighbouring samples two reach the last digit of the force, one leaves 1e-9.
_PEAK_STEPS = 3
# Last correction below which a growth has a turn. With a tenth a longer track is tabulated later, if at all.
_TURNS = 1e-3


class Divided(Exception):
    """Impacts that cannot be solved together.

    Args:
        apart: Whether each passes a break of the profile, or exceeds its track, shape (n,).
        is_short: Whether it is the latter.
    """

    def __init__(self, apart: BoolArray, *, is_short: bool) -> None:
        super().__init__()
        self.apart, self.is_short = apart, is_short


@dataclass(frozen=True, eq=False)
class Course:
    """Motions of n impacts through the same pieces of their tracks.

    Attributes:
        growths: Phases until the turn.
        shrinkages: Phases from the turn on, back through the same pieces.
        end: State at the release.
    """

    growths: list[Growth]
    shrinkages: list[Shrinkage]
    end: State

    @property
    def phases(self) -> list[Phase]:
        """All phases in their order."""
        return [*self.growths, *self.shrinkages]

    def outcomes(self) -> FloatArray:
        """Restitution, contact time, largest force over 2 E*, depth and radius, shape (5, n)."""
        force = np.max([_largest_force(growth) for growth in self.growths], axis=0)
        last, velocity = self.growths[-1], self.growths[0].impacts.velocity
        return np.stack([-self.end.speed / velocity, self.end.time, force, last.depth[:, -1], last.radius[:, -1]])

    def corrections(self) -> FloatArray:
        """Sums over the phases of the last corrections of v/v_0 and ln T, shape (2, n)."""
        return np.asarray(np.sum([phase.correction for phase in self.phases], axis=0))


def first_guess(impacts: Impacts, nodes: int, power: int, duration: FloatArray, decay: FloatArray) -> Course:
    """A growth v_0 cos(pi t/(2 T)) exp(-decay t) with t/T = s^power, without shrinkage.

    Args:
        impacts: The impacts.
        nodes: Number of nodes per phase.
        power: p of time of the first phase.
        duration: Time T to the turn [s], shape (n,).
        decay: Initial decay rate of the speed [1/s], shape (n,).
    """
    (n, m), now = impacts.rates.shape, rule(nodes, power, is_ending=False)
    touch = State(np.zeros(n), impacts.velocity.copy(), np.zeros(n), np.zeros((n, m)), np.zeros((n, m)))
    t = now.share[:-1]
    speed = impacts.velocity[:, None] * np.cos(np.pi / 2 * t) * np.exp(-(decay * duration)[:, None] * t)
    return Course([Growth(impacts, 0, now, touch, duration, speed)], [], touch)


def course(impacts: Impacts, nodes: int, guess: Course) -> Course:
    """Compute the motions of n impacts.

    Args:
        impacts: Impacts on tips of one exponent only, with equal numbers of branches.
        nodes: Number of nodes per phase.
        guess: The same motions at another resolution, or a first guess.

    Raises:
        Divided: If some impacts pass more breaks of the profile than others, or exceed their tracks.
    """
    growths = _growths(impacts, nodes, guess.growths)
    shrinkages, state = list[Shrinkage](), growths[-1].finish()
    for number, growth in enumerate(growths[::-1]):
        similar = guess.shrinkages[number] if guess.shrinkages and not impacts.are_elastic else None
        shrinkages.append(_shrinkage(growth, state, similar))
        state = shrinkages[-1].finish()
    return Course(growths, shrinkages, state)


def _growths(impacts: Impacts, nodes: int, guesses: list[Growth]) -> list[Growth]:
    """Growths piece by piece to the turn. A first guess that passes a break is solved up to it, and from it on.

    Raises:
        Divided: As `course` does.
    """
    growths, state, guesses = list[Growth](), guesses[0].start, list(guesses)
    deepest = np.array([track.deepest for track in impacts.tracks])
    while guesses:
        guess, piece = guesses.pop(0), len(growths)
        now, until = rule(nodes, guess.rule.power, is_ending=False), [track.until(piece) for track in impacts.tracks]
        growth = Growth(impacts, piece, now, state, guess.duration, guess.speed_at(now.nodes))
        growth.until = None if guess.until is None else np.array(until)
        growth.solve()
        # A body that never turns in a layer that relaxes completely is no reason for a longer track.
        passes = growth.depth[:, -1] > until
        short = (growth.depth[:, -1] > deepest) & (growth.correction.sum(axis=0) < _TURNS) & ~passes
        if guess.sweeps == 0 and (short.any() or passes.any() > passes.all()):
            raise Divided(short if short.any() else passes, is_short=bool(short.any()))
        if guess.sweeps == 0 and passes.any():
            passed = np.array([[np.interp(*row, now.share)] for row in zip(until, growth.depth, strict=True)])
            later = rule(nodes, 2, is_ending=False)
            speed = growth.speed_at(now.place(passed + (1 - passed) * later.share[:-1]))
            guesses.append(Growth(impacts, piece, later, state, growth.duration * (1 - passed[:, 0]), speed))
            growth.speed = growth.speed_at(now.place(passed * now.share[:-1]))
            growth.duration, growth.until = growth.duration * passed[:, 0], np.array(until)
            growth.solve()
        growths.append(growth)
        state = growth.finish()
    return growths


def _shrinkage(growth: Growth, start: State, similar: Shrinkage | None) -> Shrinkage:
    """The shrinkage back through a growth; the first guess is that of another resolution, or the elastic one."""
    now = rule(growth.speed.shape[1], growth.rule.power, is_ending=True)
    if similar is None:
        # An elastic body that entered a piece at a speed v leaves it at -v.
        duration, speed = growth.duration, -growth.speed[:, ::-1]
        share = np.tile(1 - now.share[:-1], (len(speed), 1))
    else:
        duration, speed = similar.duration, similar.speed_at(now.nodes)
        share = np.array([np.interp(now.share[:-1], similar.rule.share[:-1], row) for row in similar.share])
    back = Shrinkage(growth.impacts, growth.piece, now, start, duration, speed, growth, share, similar is not None)
    back.solve()
    return back


def _largest_force(growth: Growth) -> FloatArray:
    """Largest force over 2 E* of a growth, by Newton steps on its polynomial from the largest of `_PLACES` samples.

    A viscous layer relaxes at the turn, so that the force is smaller after it.
    """
    values, derivative = growth.force[:, :-1], growth.rule.derivative
    slope = times(derivative, values)
    force = np.stack([values, slope, times(derivative, slope)], axis=1)
    places = gauss(_PLACES)[0][None]
    samples = interpolated(force[:, :1], places)[:, 0]
    s = places[0, samples.argmax(axis=1)][:, None]
    for _ in range(_PEAK_STEPS):
        _, first, second = np.moveaxis(interpolated(force, s), 1, 0)
        s = np.clip(s - np.where(second < 0, first / np.where(second < 0, second, 1.0), 0.0), 0.0, 1.0)
    peak = interpolated(force[:, :1], s)[:, 0, 0]
    return np.asarray(np.maximum(peak, np.maximum(samples.max(axis=1), growth.force[:, -1])))

"""Depth of a spring bed under a prescribed force: one unknown per step, which the force raises monotonically."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from bem.polynomials.root_steps import MOST_STEPS
from contact import NotConvergedError
from contact.records.validation import FloatArray
from mdr.history.contact_edge import SpringBed, carried
from mdr.history.springs_in_time import BedState, SpringLaw, advance, released_at_once, undeformed

# Relative difference to the target force at which the depth is found.
_TOLERANCE = 1e-12
# Share of an interval's larger force that may be missed, since a finite number of springs may leave a jump; chosen.
_ACCEPTABLE = 1e-6
# How many times longer than the last step the next may be; chosen.
_REACH = 4.0
# Share of an interval's larger force below which an indenter that is let go counts as free at the end; chosen.
_LEAST = 1e-9


@dataclass(frozen=True)
class Ramp:
    """A force that moves linearly.

    Attributes:
        begin: At the start [N].
        end: At the end [N].
        duration: [s].
    """

    begin: float
    end: float
    duration: float


def to_force(law: SpringLaw, bed: SpringBed, state: BedState, ramp: Ramp, substeps: int) -> tuple[BedState, float]:
    """Follow a ramp of force.

    Substeps grow quadratically, since a layer creeps fastest after a change of rate; they shrink with the third power
    towards a release, where the depth is a power of the force between 1/2 and 1. Within one the depth is linear.
    With a bare dashpot, whose force knows the speed, equilibrium is asked for in the middle of the substep; then the
    few springs that hold to the last carry no force as small as that before a release, and substeps do not shrink.

    Returns:
        The bed at the end, and the speed of the depth there [m/s].

    Raises:
        NotConvergedError: If no depth carries the force.
    """
    fades = ramp.end <= 0.0 and law.viscosity == 0.0
    instants = ramp.duration * _graded(np.arange(substeps + 1) / substeps, fades=fades)
    share, speed = (0.5 if law.viscosity > 0.0 else 1.0), 0.0
    for begin, end in pairwise(instants):
        time = float(end - begin)
        target = float(ramp.begin + (ramp.end - ramp.begin) * (begin + share * time) / ramp.duration)
        if target <= 0.0:
            state, speed = released_at_once(law, bed.profile, state, time), 0.0
            continue
        largest = max(ramp.begin, ramp.end)
        depth = _depth(law, bed, state, (max(target, _LEAST * largest), largest), share * time)
        speed = (depth - state.depth) / (share * time)
        state = advance(law, bed.profile, state, state.depth + speed * time, time)
    return state, speed


def _graded(s: FloatArray, *, fades: bool) -> FloatArray:
    """Shares of the duration for equidistant s in [0, 1]; the slope of the first is 12 s (1-s)^2."""
    return np.asarray(s**2 * (6.0 - 8.0 * s + 3.0 * s**2) if fades else s**2)


def pressed_at_once(law: SpringLaw, bed: SpringBed, force: float) -> BedState:
    """The undeformed bed under a force that is there from the start."""

    def excess(depth: float) -> float:
        return carried(law, bed, undeformed(law, bed.profile, depth), 0.0)[0] - force

    # A flat punch is as stiff from the start.
    guess = float(bed.profile[np.isfinite(bed.profile)].max()) or force / bed.core
    return undeformed(law, bed.profile, _root(excess, 0.0, guess, (force, force)))


def _depth(law: SpringLaw, bed: SpringBed, state: BedState, target: tuple[float, float], time: float) -> float:
    """Depth after a time, under which the bed then carries the first of two forces; see `_root`."""

    def excess(depth: float) -> float:
        after = advance(law, bed.profile, state, depth, time)
        return carried(law, bed, after, (depth - state.depth) / time)[0] - target[0]

    return _root(excess, state.depth, state.depth + _first_move(law, bed, state, excess(state.depth), time), target)


def _first_move(law: SpringLaw, bed: SpringBed, state: BedState, excess: float, time: float) -> float:
    """Newton's first step, with the stiffness that the springs in contact have over this time."""
    modulus = law.long_term + law.viscosity / time
    modulus += float((law.weights * law.times * -np.expm1(-time / law.times)).sum()) / time
    touched = np.where(state.touching, bed.density, 0.0)
    springs = bed.core + float(sum(touched[own].sum() * bed.step(own.start) for own in bed.sections()))
    scale = float(bed.profile[np.isfinite(bed.profile)].max()) or float(np.abs(state.depth))
    return -excess / (modulus * springs) if springs > 0.0 else -np.sign(excess) * 1e-3 * scale


def _root(excess: Callable[[float], float], first: float, second: float, target: tuple[float, float]) -> float:
    """Root of an increasing function by secants, bisecting once it is enclosed and a secant leaves the enclosure.

    Args:
        excess: A force less the target.
        first: A depth [m].
        second: Another one.
        target: The force [N], met to rounding where it can be, and one of which a millionth may be left.
    """
    low, high = -np.inf, np.inf
    older, newer, before, now = first, second, excess(first), excess(second)
    for _ in range(MOST_STEPS):
        low = max([low, *(d for d, e in ((older, before), (newer, now)) if e < 0.0)])
        high = min([high, *(d for d, e in ((older, before), (newer, now)) if e > 0.0)])
        if abs(now) <= _TOLERANCE * target[0]:
            return newer
        move = -now * (newer - older) / (now - before) if now != before else newer - older
        following = newer + min(max(move, -_REACH * abs(newer - older)), _REACH * abs(newer - older))
        if not low < following < high:
            following = 0.5 * (low + high) if np.isfinite(low + high) else newer + _REACH * (newer - older)
        older, newer, before = newer, float(following), now
        now = excess(newer)
        if newer in (low, high, older):
            break
    if abs(now) > _ACCEPTABLE * target[1]:
        raise NotConvergedError("no depth carries the prescribed force", {"force": abs(now) / target[1]})
    return newer

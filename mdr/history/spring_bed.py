"""Springs under a moving indenter, each followed exactly from one touch or release to the next.

Springs are independent of each other: with the factor A = C C^T of the layer's equation pressures within a are springs
within a, and the viscoelastic law is valid spring by spring. Spring g is touched where the indenter at depth delta
reaches its surface, delta - g = u, and released where its force would pull, f = 0. While the depth is quadratic in time
both functions are

    c + v A(t) + a B(t) + sum_k c_k exp(-r_k t)

with increasing A and B (`SpringLaw.drive`), so every term is monotonic: on an interval the terms at both ends bound the
function and its slope, and intervals are cut until each has no root or one (`first_fall`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.numerics import EPS
from contact import NotConvergedError
from contact.records.validation import FloatArray
from mdr.history.spring_law import SpringLaw

# Touches and releases of one spring between two instants. A sum of k exponentials has fewer than k + 2 roots.
_MOST_EVENTS = 40
# Of the largest terms of a force or a gap: nearer to zero its sign is rounding.
_ROUNDING = 8 * EPS
# Share of an interval below which it is not cut further: two roots as close make a touch that carries nothing.
_SHORTEST = 1e-9
# Newton steps to a root; six are usual.
_MOST_STEPS = 80


class Course(NamedTuple):
    """c + v A(t) + a B(t) + sum_k c_k exp(-r_k t) of n springs.

    Attributes:
        constant: c, shape (n,).
        amplitudes: c_k, shape (k, n).
        rates: r_k [1/s], shape (k,).
        speed: v of each spring, shape (n,).
        acceleration: a.
        drive: B, A and A' at times.
        size: Size of what c is the difference of, shape (n,).
    """

    constant: FloatArray
    amplitudes: FloatArray
    rates: FloatArray
    speed: FloatArray
    acceleration: float
    drive: Callable[[FloatArray, bool], tuple[FloatArray | float, FloatArray, FloatArray]]
    size: FloatArray

    def terms(self, i: NDArray[np.intp], t: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Terms of springs i at times t [s], shape (n,), and their slopes, each of shape (3 + k, n)."""
        t = t[:1] if (t == t[:1]).all() else t
        values, slopes = np.empty((2, 3 + self.rates.size, i.size))
        v, a = self.speed[i], self.acceleration
        B, A, slope = self.drive(t, a != 0)
        values[0], values[1], values[2] = self.constant[i], v * A, a * B
        values[3:] = self.amplitudes[:, i] * np.exp(-self.rates[:, None] * t)
        slopes[0], slopes[1], slopes[2] = 0.0, v * slope, a * A
        slopes[3:] = -self.rates[:, None] * values[3:]
        return values, slopes

    def is_above(
        self,
        i: NDArray[np.intp],
        span: FloatArray,
        start: tuple[FloatArray, FloatArray],
        end: tuple[FloatArray, FloatArray],
    ) -> NDArray[np.bool_]:
        """Whether springs i stay above zero, within rounding, for a span [s] between terms at its start and end.

        Convex terms lie above their tangents, concave ones above their chords: A is concave, B and exp are convex.
        """
        convex = np.empty(start[0].shape, dtype=np.bool_)
        convex[0], convex[1], convex[2] = True, self.speed[i] <= 0, self.acceleration >= 0
        convex[3:] = self.amplitudes[:, i] >= 0
        at_end = np.where(convex, start[0] + span * start[1], end[0]).sum(axis=0)
        at_start = np.where(convex, end[0] - span * end[1], start[0]).sum(axis=0)
        rounding = _ROUNDING * (self.size[i] + np.abs(start[0]).sum(axis=0))
        from_start = (start[0].sum(axis=0) >= -rounding) & (at_end >= -rounding)
        return np.asarray(from_start | ((end[0].sum(axis=0) >= -rounding) & (at_start >= -rounding)))

    def is_positive(self, i: NDArray[np.intp], terms: FloatArray) -> NDArray[np.bool_]:
        """Whether sums of terms are zero or above, within rounding."""
        return np.asarray(terms.sum(axis=0) >= -_ROUNDING * (self.size[i] + np.abs(terms).sum(axis=0)))


def _motion(t: FloatArray, _: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Way after a time t [s] at unit acceleration, at unit speed, and the slope of the latter."""
    return t * t / 2, t, np.ones_like(t)


def first_fall(course: Course, span: FloatArray) -> FloatArray:
    """First times in [0, span] [s] from which courses that begin at zero or above are negative, shape (n,), or inf."""
    event = np.full(span.size, np.inf)
    if not span.size:
        return event
    i, low, high = np.arange(span.size), np.zeros(span.size), span
    at_low = course.terms(i, low)
    keep = course.is_positive(i, at_low[0])
    event[~keep] = 0.0
    while True:
        i, low, high = i[keep], low[keep], high[keep]
        if not i.size:
            return event
        at_low = (at_low[0][:, keep], at_low[1][:, keep])
        at_high = course.terms(i, high)
        rises = np.minimum(at_low[1], at_high[1]).sum(axis=0) >= 0
        falls = np.maximum(at_low[1], at_high[1]).sum(axis=0) <= 0
        decided = falls | (high - low <= _SHORTEST * span[i])
        clear = rises | course.is_above(i, high - low, at_low, at_high)
        clear |= decided & course.is_positive(i, at_high[0])
        root = decided & ~clear
        if root.any():
            event[i[root]] = _root(course, i[root], low[root], high[root])
        keep = ~root & ~(clear & (high >= span[i]))
        step = (high - low) * np.where(clear, 4.0, 0.25)
        low = np.where(clear, high, low)
        at_low = np.where(clear, at_high[0], at_low[0]), np.where(clear, at_high[1], at_low[1])
        high = np.minimum(low + step, span[i])


def _root(course: Course, i: NDArray[np.intp], low: FloatArray, high: FloatArray) -> FloatArray:
    """Roots of courses i that fall from low to high [s], by Newton's rule within brackets."""
    t = low
    for _ in range(_MOST_STEPS if i.size else 0):
        terms, slopes = course.terms(i, t)
        value, slope = terms.sum(axis=0), np.minimum(slopes.sum(axis=0), -1e-300)
        low, high = np.where(value > 0, t, low), np.where(value > 0, high, t)
        with np.errstate(over="ignore"):
            new = t - value / slope
        new = np.where((new >= low) & (new <= high), new, (low + high) / 2)
        small = np.abs(value) <= EPS * np.abs(terms).sum(axis=0)
        if (small | (np.abs(new - t) <= EPS * high)).all():
            break
        t = new
    return t


class Path(NamedTuple):
    """Depths that are quadratic between instants.

    Attributes:
        time: Instants [s], shape (n,).
        depth: delta there [m], shape (n,).
        speed: At the start of each interval [m/s], shape (n - 1,).
        acceleration: In each interval [m/s^2], shape (n - 1,).
        free: In which intervals the indenter is taken away, shape (n - 1,).
    """

    time: FloatArray
    depth: FloatArray
    speed: FloatArray
    acceleration: FloatArray
    free: NDArray[np.bool_]

    @classmethod
    def linear(cls, time: FloatArray, depth: FloatArray) -> Path:
        """Depths that are linear between instants."""
        speed = np.diff(depth) / np.diff(time)
        return cls(time, depth, speed, np.zeros(speed.size), np.zeros(speed.size, dtype=np.bool_))

    @property
    def final_speed(self) -> FloatArray:
        """Speed at which each instant is reached [m/s], zero at the first, shape (n,)."""
        return np.append(0.0, self.speed + self.acceleration * np.diff(self.time))

    @property
    def peaks(self) -> FloatArray:
        """Largest depth so far [m] at each instant, between instants too, shape (n,)."""
        with np.errstate(divide="ignore", invalid="ignore"):
            turn = np.nan_to_num(-self.speed / self.acceleration, nan=0.0, posinf=0.0, neginf=0.0)
        turn = np.where(self.free, 0.0, np.clip(turn, 0, np.diff(self.time)))
        inner = self.depth[:-1] + turn * (self.speed + turn * self.acceleration / 2)
        return np.maximum.accumulate(np.maximum(self.depth, np.append(self.depth[0], inner)))


@dataclass
class SpringBed:
    """Springs at one instant.

    Attributes:
        law: Of each spring.
        g: MDR profile where they stand [m], shape (n,).
        touching: Which are in contact, shape (n,).
        surface: Displacement u of their ends [m], shape (n,).
        strains: e_j [m], shape (m, n).
        late: How long ago in the last interval they were touched or released [s], zero if not, shape (n,).
        pace: Slope of force or gap then [m/s], shape (n,).
    """

    law: SpringLaw
    g: FloatArray
    touching: NDArray[np.bool_]
    surface: FloatArray
    strains: FloatArray
    late: FloatArray
    pace: FloatArray

    @classmethod
    def undeformed(cls, law: SpringLaw, g: FloatArray, depth: float) -> SpringBed:
        """The bed at first touch; a depth [m] that is there from the start has been reached at once."""
        surface = np.maximum(depth - g, 0.0)
        strains = np.repeat(surface[None], law.weights.size, axis=0)
        return cls(law, g, surface > 0, surface, strains, np.zeros(g.size), np.zeros(g.size))

    def copy(self) -> SpringBed:
        """The same springs, to be advanced on their own."""
        return replace(self, touching=self.touching.copy(), surface=self.surface.copy(), strains=self.strains.copy())

    def beyond(self, number: int) -> SpringBed:
        """The springs from a number on."""
        own = slice(number, None)
        rows = (self.g[own], self.touching[own], self.surface[own], self.strains[:, own])
        return SpringBed(self.law, *rows, self.late[own], self.pace[own])

    def along(self, path: Path, k: int) -> None:
        """Advance through interval k of a path."""
        span = float(path.time[k + 1] - path.time[k])
        if path.free[k]:
            self.release(span)
        else:
            self.advance(float(path.depth[k]), (float(path.speed[k]), float(path.acceleration[k])), span)

    def release(self, span: float) -> None:
        """Advance by a time [s] without the indenter."""
        self.surface, self.strains = self.law.free(self.surface, self.strains, np.array([span]))
        self.touching, self.late = np.zeros(self.g.size, dtype=np.bool_), np.zeros(self.g.size)

    def advance(self, depth: float, motion: tuple[float, float], span: float) -> None:
        """Advance by a time [s] under an indenter that starts at a depth [m].

        Args:
            depth: At the start [m].
            motion: Speed at the start [m/s] and acceleration [m/s^2].
            span: The time [s].

        Raises:
            NotConvergedError: If a spring is touched and released without end.
        """
        spent = np.zeros(self.g.size)
        self.late, self.pace = np.zeros(self.g.size), np.zeros(self.g.size)
        moving = np.arange(self.g.size)
        for _ in range(_MOST_EVENTS):
            held = self.touching[moving]
            parts = [self._stretch(i, depth, motion, span, spent) for i in (moving[held], moving[~held])]
            moving = np.concatenate(parts)
            if not moving.size:
                end = depth + span * (motion[0] + span * motion[1] / 2)
                self.surface = np.where(self.touching, end - self.g, self.surface)
                return
        raise NotConvergedError(
            f"{moving.size} springs are touched and released more than {_MOST_EVENTS} times between two instants",
            {"springs": float(moving.size)},
        )

    def _stretch(
        self, i: NDArray[np.intp], depth: float, motion: tuple[float, float], span: float, spent: FloatArray
    ) -> NDArray[np.intp]:
        """Advance springs i, all in contact or all free, to their next event or the end; those with an event."""
        if not i.size:
            return i
        law, now, a, touching = self.law, spent[i], motion[1], bool(self.touching[i[0]])
        v, w = motion[0] + a * now, depth + now * (motion[0] + now * a / 2) - self.g[i]
        course = (self._force if touching else self._gap)(i, w, v, a, self.g[i] + abs(depth))
        left = span - now
        event = first_fall(course, left)
        ends = event < np.inf
        t = np.where(ends, event, left)
        shared = t[:1] if (t == t[0]).all() else t
        if touching:
            self.strains[:, i] = law.pressed(self.strains[:, i], (v, a), shared)
        else:
            self.surface[i], self.strains[:, i] = law.free(self.surface[i], self.strains[:, i], shared)
        spent[i] = now + t
        last = i[ends]
        if last.size:
            at = t[ends]
            self.surface[last] = w[ends] + at * (v[ends] + at * a / 2)
            self.touching[last] = not touching
            self.late[last] = span - spent[last]
            self.pace[last] = np.abs(course.terms(np.flatnonzero(ends), at)[1].sum(axis=0))
        return last

    def _force(self, i: NDArray[np.intp], w: FloatArray, v: FloatArray, a: float, size: FloatArray) -> Course:
        """Force of springs in contact."""
        fading = self.law.weights[:, None] * self.strains[:, i]
        return Course(self.law.long_term * w, fading, 1 / self.law.times, v, a, self.law.drive, size)

    def _gap(self, i: NDArray[np.intp], w: FloatArray, v: FloatArray, a: float, size: FloatArray) -> Course:
        """Gap between surface and indenter of free springs."""
        amplitudes = self.law.modes.amplitudes(self.surface[i], self.strains[:, i])
        return Course(-w, amplitudes, self.law.modes.rates, -v, -a, _motion, size)

    def forces(self, speed: float) -> FloatArray:
        """f at an indenter's speed [m/s], zero where free, shape (n,)."""
        return np.where(self.touching, self.law.force(self.surface, self.strains, speed), 0.0)

    def edge(self, depth: float, speed: float) -> FloatArray:
        """Positive in contact, negative outside, and zero at the front, at a depth [m] and speed [m/s], shape (n,).

        It continues the force across a front that has receded, and the gap across one that has advanced.
        """
        gap, since = self.surface + self.g - depth, self.pace * self.late
        creep = -self.law.modes.rates @ self.law.modes.amplitudes(self.surface, self.strains)
        inside = np.where(self.late > 0, np.minimum(self.forces(speed), since), self.forces(speed))
        outside = np.where((self.late > 0) & (creep > speed), since, gap)
        return np.where(self.touching, np.maximum(inside, 1e-300), -np.maximum(outside, 0.0))


def followed(law: SpringLaw, g: FloatArray, path: Path) -> Iterator[SpringBed]:
    """The bed at each instant of a path; one object that is advanced."""
    bed = SpringBed.undeformed(law, g, float(path.depth[0]))
    yield bed
    for k in range(path.time.size - 1):
        bed.along(path, k)
        yield bed

"""Springs under a moving indenter, each followed exactly from one touch or release to the next.

Springs are independent of each other: with the factor A = C C^T of the layer's equation pressures within a are springs
within a, and the viscoelastic law is valid spring by spring. Spring g is touched where the indenter at depth delta
reaches its surface, delta - g = u, and released where its force would pull, f = 0. While the depth is a polynomial of
time both are, since the last touch or release at time theta,

    c + C(t) + sum_k c_k exp(-r_k (t - theta))

with one C(t) for all springs: the force of a spring that has been in contact from the start without any strain, or
-delta(t). Signs of these functions are taken at times that crowd towards theta, where exponentials change fastest, and
the first root is computed by Newton's rule.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import hyp1f1

from bem.numerics import EPS
from contact import NotConvergedError
from contact.records.validation import FloatArray
from mdr.history.spring_law import SpringLaw

# Touches and releases of one spring between two instants. A sum of k exponentials has fewer than k + 2 roots.
_MOST_EVENTS = 40
# Of the largest terms of a force or a gap: nearer to zero its sign is rounding. It doubles with each touch and release.
_ROUNDING = 8 * EPS
# Signs are taken at sixteenths of what is left of an interval, and at halves of it down to 2^-6 of the fastest
# relaxation time. Two roots in between are a touch that carries hardly anything: with eighths some carry 1e-9 of the
# largest force.
_PARTS, _HALVES_MORE, _MOST_HALVES = 16, 6, 40
# Samples of a depth between two instants, whose largest one is computed.
_PEAK_SAMPLES = 33
# Newton steps to a root; six are usual.
_MOST_STEPS = 80
_AT_END = np.ones(1)


@dataclass(frozen=True)
class Motion:
    """The indenter in an interval.

    Attributes:
        law: Of the springs.
        way: Coefficients of the depth as a polynomial in the share of the interval [m], shape (p + 1,).
        span: The interval [s].
        rounding: Of the largest terms of a force or a gap: nearer to zero its sign is rounding.
    """

    law: SpringLaw
    way: FloatArray
    span: float
    rounding: float = _ROUNDING

    @cached_property
    def rise(self) -> FloatArray:
        """Coefficients of the slope of the depth [m]."""
        return self.way[1:] * np.arange(1, self.way.size)

    def depth(self, s: FloatArray) -> FloatArray:
        """Depth at shares of the interval [m]."""
        return polynomial(self.way, s)

    def strains(self, s: FloatArray) -> FloatArray:
        """e_j of a spring in contact from the start, without strain then, at shares of the interval [m], (m, ..).

        int_0^s exp(-x (s - v)) v^n dv = s^(n+1)/(n+1) 1F1(1, n+2, -x s), x = span/tau.
        """
        z = np.multiply.outer(self.span / self.law.times, s)
        terms = (rate * s ** (n + 1) / (n + 1) * hyp1f1(1.0, n + 2.0, -z) for n, rate in enumerate(self.rise.tolist()))
        return np.asarray(sum(terms))

    def force(self, s: FloatArray) -> FloatArray:
        """C of springs in contact, at shares of the interval."""
        law, strains = self.law, self.strains(s)
        dashpot = law.viscosity / self.span * polynomial(self.rise, s) if law.viscosity else 0.0
        return np.asarray(law.long_term * self.depth(s) + dashpot + _weighted(law.weights, strains))

    def force_slope(self, s: FloatArray) -> FloatArray:
        """Slope of C of springs in contact, at shares of the interval."""
        law, bend = self.law, self.rise[1:] * np.arange(1, self.rise.size)
        elastic = (law.long_term + law.weights.sum()) * polynomial(self.rise, s)
        dashpot = law.viscosity / self.span * polynomial(bend, s) if bend.size else 0.0
        return np.asarray(elastic + dashpot - _weighted(law.weights * self.span / law.times, self.strains(s)))


def polynomial(coefficients: FloatArray, s: FloatArray) -> FloatArray:
    """A polynomial at any shape of s."""
    value = np.full(s.shape, coefficients[-1])
    for one in coefficients[-2::-1].tolist():
        value = value * s + one
    return value


def _weighted(weights: FloatArray, rows: FloatArray) -> FloatArray:
    """Sum of weighted rows, of shape (m, ..)."""
    return np.asarray((weights @ rows.reshape(weights.size, math.prod(rows.shape[1:]))).reshape(rows.shape[1:]))


class Course(NamedTuple):
    """c + C(s) + sum_k c_k exp(-r_k (s - theta)) of n springs at shares s of an interval.

    Attributes:
        constant: c, shape (n,).
        amplitudes: c_k, shape (k, n).
        rates: r_k times the interval, shape (k,).
        start: theta of each spring, or of all, shape (n,) or (1,).
        shared: C at shares.
        slope: Slope of C at shares.
        rounding: Values whose sign is rounding, shape (n,).
    """

    constant: FloatArray
    amplitudes: FloatArray
    rates: FloatArray
    start: FloatArray
    shared: Callable[[FloatArray], FloatArray]
    slope: Callable[[FloatArray], FloatArray]
    rounding: FloatArray

    def among(self, some: NDArray[np.intp]) -> Course:
        """The courses of some springs."""
        start = self.start[some] if self.start.size > 1 else self.start
        return self._replace(
            constant=self.constant[some], amplitudes=self.amplitudes[:, some], start=start, rounding=self.rounding[some]
        )

    def fading(self, s: FloatArray) -> FloatArray:
        """Exponential terms at shares of shape (q, n) or (q, 1); shape (k, q, n)."""
        return np.exp(np.multiply.outer(-self.rates, s - self.start)) * self.amplitudes[:, None]

    def values(self, s: FloatArray) -> FloatArray:
        """Values at shares of shape (q, n) or (q, 1); shape (q, n)."""
        return np.asarray(self.constant + self.shared(s) + self.fading(s).sum(axis=0))

    def with_slopes(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Values and slopes at one share of each spring, shape (n,)."""
        fading = self.fading(s[None])[:, 0]
        return self.constant + self.shared(s) + fading.sum(axis=0), self.slope(s) - self.rates @ fading


def first_fall(course: Course) -> FloatArray:
    """First shares of the interval from which courses that begin at zero or above are negative, or inf, shape (n,)."""
    event = np.full(course.constant.size, np.inf)
    fastest = max(float(course.rates.max(initial=1.0)), 1.0)
    halves = int(np.clip(np.ceil(np.log2(fastest)) + _HALVES_MORE, 4, _MOST_HALVES))
    shares = np.unique(np.concatenate([[0.0], 0.5 ** np.arange(halves), np.arange(1, _PARTS) / _PARTS]))
    s = course.start + (1 - course.start) * shares[:, None]
    # Exponentials fade, so that no value is less than all terms at their least.
    shared = course.shared(s)
    least = course.fading(s[[0, -1]]).min(axis=1).sum(axis=0) + course.constant + shared.min(axis=0)
    some = np.flatnonzero(least <= course.rounding)
    few = course.among(some)
    s = s[:, some] if s.shape[1] > 1 else s
    falls = few.values(s) < -few.rounding
    s = np.broadcast_to(s, falls.shape)
    ends = falls.any(axis=0)
    first, which = np.argmax(falls, axis=0)[ends], np.flatnonzero(ends)
    if which.size:
        event[some[ends]] = _root(few.among(which), s[np.maximum(first - 1, 0), which], s[first, which])
    return event


def _root(course: Course, low: FloatArray, high: FloatArray) -> FloatArray:
    """Roots of courses that fall between two shares of the interval, by Newton's rule within brackets."""
    t = low
    for _ in range(_MOST_STEPS):
        value, slope = course.with_slopes(t)
        low, high = np.where(value > 0, t, low), np.where(value > 0, high, t)
        with np.errstate(over="ignore"):
            new = t - value / np.minimum(slope, -1e-300)
        new = np.where((new >= low) & (new <= high), new, (low + high) / 2)
        small = np.abs(value) <= course.rounding / 8
        if (small | (np.abs(new - t) <= EPS * high)).all():
            break
        t = np.where(small, t, new)
    return t


class Path(NamedTuple):
    """Depths that are polynomials between instants.

    Attributes:
        time: Instants [s], shape (n,).
        depth: delta there [m], shape (n,).
        ways: Coefficients of the depth over the share of each interval [m], shape (n - 1, p + 1).
        free: In which intervals the indenter is taken away, shape (n - 1,).
    """

    time: FloatArray
    depth: FloatArray
    ways: FloatArray
    free: NDArray[np.bool_]

    @classmethod
    def linear(cls, time: FloatArray, depth: FloatArray) -> Path:
        """Depths that are linear between instants."""
        return cls(time, depth, np.column_stack([depth[:-1], np.diff(depth)]), np.zeros(time.size - 1, dtype=np.bool_))

    def until(self, k: int) -> Path:
        """The path up to instant k."""
        return Path(self.time[: k + 1], self.depth[: k + 1], self.ways[:k], self.free[:k])

    @property
    def final_speed(self) -> FloatArray:
        """Speed at which each instant is reached [m/s], zero at the first, shape (n,)."""
        return np.append(0.0, self.ways @ np.arange(self.ways.shape[1]) / np.diff(self.time))

    @property
    def peaks(self) -> FloatArray:
        """Largest depth so far [m] at each instant, between instants too, shape (n,)."""
        inner = (
            (self.ways @ np.vander(np.linspace(0, 1, _PEAK_SAMPLES), self.ways.shape[1], increasing=True).T).max(axis=1)
            if self.ways.shape[1] > 2
            else -np.inf
        )
        inner = np.where(self.free, 0.0, inner)
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
        events: Shares of the last interval at which springs were touched or released, and their numbers.
    """

    law: SpringLaw
    g: FloatArray
    touching: NDArray[np.bool_]
    surface: FloatArray
    strains: FloatArray
    late: FloatArray
    pace: FloatArray
    events: list[tuple[FloatArray, NDArray[np.intp]]] = field(default_factory=list)

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
            self.advance(path.ways[k], span)

    def release(self, span: float) -> None:
        """Advance by a time [s] without the indenter."""
        self.surface, self.strains = self.law.free(self.surface, self.strains, np.array([span]))
        self.touching, self.late, self.events = np.zeros(self.g.size, dtype=np.bool_), np.zeros(self.g.size), []

    def advance(
        self, way: FloatArray, span: float, nodes: FloatArray = _AT_END
    ) -> tuple[FloatArray, NDArray[np.bool_]]:
        """Advance by a time [s] under an indenter.

        Args:
            way: Coefficients of the depth over the share of that time [m].
            span: The time [s].
            nodes: Shares, increasing, the last one 1, shape (q,).

        Returns:
            Displacements of all ends [m] and whether springs touch at the nodes, each of shape (q, n).

        Raises:
            NotConvergedError: If a spring is touched and released without end.
        """
        motion, count = Motion(self.law, way, span), self.g.size
        seen = np.zeros((nodes.size, count)), np.zeros((nodes.size, count), dtype=np.bool_)
        self.late, self.pace = np.zeros(count), np.zeros(count)
        self.events = []
        theta, moving = np.zeros(count), np.arange(count)
        for number in range(_MOST_EVENTS):
            # A spring that is touched and released at one instant is so by rounding.
            motion = replace(motion, rounding=_ROUNDING * 2.0**number)
            held = self.touching[moving]
            moving = np.concatenate(
                [self._stretch(i, motion, theta, nodes, seen) for i in (moving[held], moving[~held])]
            )
            if not moving.size:
                return seen
        raise NotConvergedError(
            f"{moving.size} springs are touched and released more than {_MOST_EVENTS} times between two instants",
            {"springs": float(moving.size)},
        )

    def _stretch(
        self,
        i: NDArray[np.intp],
        motion: Motion,
        theta: FloatArray,
        nodes: FloatArray,
        seen: tuple[FloatArray, NDArray[np.bool_]],
    ) -> NDArray[np.intp]:
        """Advance springs i, all in contact or all free, to their next event or the end; those with an event."""
        if not i.size:
            return i
        touching, start = bool(self.touching[i[0]]), theta[i]
        start = start if start.any() else start[:1]
        course = (self._force if touching else self._gap)(i, motion, start)
        later, s = nodes[:, None] >= start, np.maximum(nodes[:, None], start)
        surface = motion.depth(s) - self.g[i] if touching else course.fading(s).sum(axis=0)
        for values, own in zip(seen, (surface, touching), strict=True):
            values[:, i] = np.where(later, own, values[:, i])
        event = first_fall(course)
        ends = event < np.inf
        last, rest, at = i[ends], i[~ends], event[ends]
        self._move(rest, motion, start[~ends] if start.size > 1 else start, _AT_END)
        if last.size:
            self._move(last, motion, start[ends] if start.size > 1 else start, at)
            self.surface[last], self.touching[last] = motion.depth(at) - self.g[last], not touching
            self.events.append((at, last))
            theta[last], self.late[last] = at, motion.span * (1 - at)
            self.pace[last] = np.abs(course.among(np.flatnonzero(ends)).with_slopes(at)[1]) / motion.span
        return last

    def _move(self, i: NDArray[np.intp], motion: Motion, start: FloatArray, end: FloatArray) -> None:
        """Move springs i, all in contact or all free, from shares of an interval to others."""
        if not i.size:
            return
        time = motion.span * (end - start)
        if self.touching[i[0]]:
            decay = np.exp(-np.divide.outer(time, self.law.times).T)
            self.strains[:, i] = motion.strains(end) + decay * (self.strains[:, i] - motion.strains(start))
            self.surface[i] = motion.depth(end) - self.g[i]
        else:
            self.surface[i], self.strains[:, i] = self.law.free(self.surface[i], self.strains[:, i], time)

    def _force(self, i: NDArray[np.intp], motion: Motion, start: FloatArray) -> Course:
        """Force of springs in contact."""
        law, constant = self.law, -self.law.long_term * self.g[i]
        fading = law.weights[:, None] * (self.strains[:, i] - motion.strains(start))
        own = self._rounding(i, motion, fading)
        return Course(constant, fading, motion.span / law.times, start, motion.force, motion.force_slope, own)

    def _gap(self, i: NDArray[np.intp], motion: Motion, start: FloatArray) -> Course:
        """Gap between surface and indenter of free springs."""
        fading = self.law.modes.amplitudes(self.surface[i], self.strains[:, i])
        rates, own = motion.span * self.law.modes.rates, self._rounding(i, motion, fading)
        return Course(
            self.g[i], fading, rates, start, lambda s: -motion.depth(s), lambda s: -polynomial(motion.rise, s), own
        )

    def _rounding(self, i: NDArray[np.intp], motion: Motion, fading: FloatArray) -> FloatArray:
        """Values whose sign is rounding, shape (n,)."""
        return np.asarray(motion.rounding * (self.g[i] + np.abs(motion.way).sum() + np.abs(fading).sum(axis=0)))

    def forces(self, speed: float) -> FloatArray:
        """f at an indenter's speed [m/s], zero where free, shape (n,)."""
        law = self.law
        pressed = law.long_term * self.surface + law.viscosity * speed + law.weights @ self.strains
        return np.where(self.touching, pressed, 0.0)

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

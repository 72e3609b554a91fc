"""Springs under a moving indenter, each followed exactly from one touch or release to the next.

Springs are independent of each other: with the factor A = C C^T of the layer's equation pressures within a are springs
within a, and the viscoelastic law is valid spring by spring. Spring g is touched where the indenter at depth delta
reaches its surface, delta - g = u, and released where its force would pull, f = 0. While the depth is a polynomial of
time both the force f of a spring in contact and the gap u - (delta - g) of a free one are

    c + C(t) + sum_k c_k exp(-r_k (t - theta))

with the instant theta of the last touch or release, and one polynomial C(t) for all springs: -delta(t), or the force of
a spring g = 0 whose strains are polynomials. The first root is bracketed by signs at times that are densest near theta,
where exponentials change fastest.

Surfaces keep the order of their profile: u + g never decreases with g. Proof: let the surfaces of springs g_1 < g_2
meet. Then u_2 - u_1 has never been smaller, so f_2 < f_1 for a decreasing relaxation function. Hence spring 1 is in
contact, and both surfaces move together. So springs touch up to one front, and f decreases outwards.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.numerics import EPS
from contact import NotConvergedError
from contact.records.validation import BoolArray, FloatArray
from mdr.history.spring_law import SpringLaw
from mdr.radius_search import roots

# Largest number of touches and releases in an interval. A sum of k exponentials has less than k + 2 roots.
_MOST_EVENTS = 40
# Rounding error of a force or a gap over its largest terms. It doubles with each touch and release.
_ROUNDING = 8 * EPS
# The sign of f or of the gap is computed at sixteenths of the rest of an interval, and at halves of it down to 2^-6 of
# the fastest relaxation time. With eighths some events are missed of springs with 1e-9 of the largest force.
_PARTS, _HALVES_MORE, _MOST_HALVES = 16, 6, 40
# Interval over relaxation time above which strains follow the indenter by a finite polynomial, and terms of the power
# series below. At half of it rounding errors are 64 times as large, at twice of it the series takes six terms more.
_FAST, _MOST_TERMS = 1.0, 24
_AT_END = np.ones(1)


class Motion(NamedTuple):
    """Polynomials in the share of one interval, by coefficients of rising powers.

    Attributes:
        depth: Depth w of the indenter [m], shape (p + 1,).
        strains: Strains P_j [m] towards which e_j decay in contact, shape (n, m).
        force: Force of a spring g = 0 with these strains [m], shape (n,).
    """

    depth: FloatArray
    strains: FloatArray
    force: FloatArray

    @classmethod
    def of(cls, law: SpringLaw, depth: FloatArray, span: float) -> Motion:
        """Motion in an interval of duration `span` [s]: P_j' = w' - x_j P_j, x_j = span/tau_j."""
        x, rise = span / law.times, np.zeros(_MOST_TERMS)
        rise[: depth.size - 1] = depth[1:] * np.arange(1, depth.size)
        (exact, series), slow = np.zeros((2, _MOST_TERMS, x.size)), np.where(x > _FAST, 0.0, x)
        for n in range(depth.size - 1)[::-1]:
            exact[n] = (rise[n] - (n + 1) * exact[n + 1]) / x
        # Next to x = 0 these coefficients cancel. There the power series converges, which is zero at first.
        for n in range(_MOST_TERMS - 1):
            series[n + 1] = (rise[n] - slow * series[n]) / (n + 1)
        strains = np.where(x > _FAST, exact, series)
        force = strains @ law.weights + law.viscosity / span * rise
        force[: depth.size] += law.long_term * depth
        last = np.flatnonzero(np.append(True, np.abs(np.column_stack([strains, force])[1:]).max(axis=1)))[-1]
        return cls(depth, strains[: last + 1], force[: last + 1])


def _polynomial(coefficients: FloatArray, s: FloatArray) -> FloatArray:
    """Polynomials at s from coefficients of rising powers, shape (n, ..)."""
    value = coefficients[-1] + 0 * s
    for coefficient in coefficients[-2::-1]:
        value *= s
        value += coefficient
    return np.asarray(value)


class Course(NamedTuple):
    """Forces or gaps c + C(s) + sum_k c_k exp(-r_k (s - theta)) of n springs at shares s of an interval.

    Attributes:
        constant: Constants c, shape (n,).
        amplitudes: Amplitudes c_k, shape (k, n).
        rates: r_k times the interval, shape (k,).
        start: theta of each spring, or of all, shape (n,) or (1,).
        shared: Coefficients of the polynomial C, by rising powers.
        rounding: Rounding errors of the values, shape (n,).
    """

    constant: FloatArray
    amplitudes: FloatArray
    rates: FloatArray
    start: FloatArray
    shared: FloatArray
    rounding: FloatArray

    def among(self, some: NDArray[np.intp] | BoolArray) -> Course:
        """Courses of some of the springs."""
        return self._replace(
            constant=self.constant[some],
            amplitudes=self.amplitudes[:, some],
            start=self.start[some] if self.start.size > 1 else self.start,
            rounding=self.rounding[some],
        )

    def fading(self, s: FloatArray) -> FloatArray:
        """Exponential terms at shares of shape (q, n) or (q, 1); shape (k, q, n)."""
        return np.exp(np.multiply.outer(-self.rates, s - self.start)) * self.amplitudes[:, None]

    def values(self, s: FloatArray) -> FloatArray:
        """Values at shares of shape (q, n) or (q, 1); shape (q, n)."""
        return np.asarray(self.constant + _polynomial(self.shared, s) + self.fading(s).sum(axis=0))


def first_fall(course: Course) -> FloatArray:
    """First shares of the interval from which courses that begin at zero or above are negative, or inf, shape (n,)."""
    event = np.full(course.constant.size, np.inf)
    fastest = max(float(course.rates.max(initial=1.0)), 1.0)
    halves = int(np.clip(np.ceil(np.log2(fastest)) + _HALVES_MORE, 4, _MOST_HALVES))
    shares = np.unique(np.concatenate([[0.0], 0.5 ** np.arange(halves), np.arange(1, _PARTS) / _PARTS]))
    s = course.start + (1 - course.start) * shares[:, None]
    # Lower bound of the course: every exponential is monotonic, so its least value is at one end.
    least = (
        course.fading(s[[0, -1]]).min(axis=1).sum(axis=0) + course.constant + _polynomial(course.shared, s).min(axis=0)
    )
    some = np.flatnonzero(least <= course.rounding)
    course, s = course.among(some), s[:, some] if s.shape[1] > 1 else s
    falls = course.values(s) < -course.rounding
    first, ends = np.argmax(falls, axis=0), np.flatnonzero(falls.any(axis=0))
    if not ends.size:
        return event
    course, s = course.among(ends), np.broadcast_to(s, falls.shape)
    low, high = s[np.maximum(first[ends] - 1, 0), ends], s[first[ends], ends]

    def negative(share: FloatArray, at: BoolArray) -> FloatArray:
        """The negative course, scaled so that the tolerance of the root search is its rounding error."""
        part = course.among(at)
        return np.asarray(-1e-14 * part.values((low[at] + share * (high - low)[at])[None])[0] / part.rounding)

    zero, one = np.zeros(ends.size), np.ones(ends.size)
    share = roots(negative, zero, np.minimum(negative(zero, one > 0), 0.0), one)
    event[some[ends]] = low + share * (high - low)
    return event


class Path(NamedTuple):
    """Depth in time, a polynomial between neighbouring instants.

    Attributes:
        time: Instants [s], shape (n,).
        depth: Depth delta at these instants [m], shape (n,).
        polynomials: Coefficients of the depth over the share of each interval [m], shape (n - 1, p + 1).
        free: Whether the indenter is absent in each interval, shape (n - 1,); None if it never is.
    """

    time: FloatArray
    depth: FloatArray
    polynomials: FloatArray
    free: BoolArray | None = None

    @classmethod
    def linear(cls, time: FloatArray, depth: FloatArray) -> Path:
        """Depths that are linear between instants."""
        return cls(time, depth, np.column_stack([depth[:-1], np.diff(depth)]))

    def until(self, k: int) -> Path:
        """The path up to instant k."""
        return Path(
            self.time[: k + 1], self.depth[: k + 1], self.polynomials[:k], None if self.free is None else self.free[:k]
        )

    @property
    def final_speed(self) -> FloatArray:
        """Speed at which each instant is reached [m/s], zero at the first, shape (n,)."""
        return np.append(0.0, self.polynomials @ np.arange(self.polynomials.shape[1]) / np.diff(self.time))


class Passage(NamedTuple):
    """Springs at the nodes of an interval, each of shape (q, n).

    Attributes:
        surface: Displacements u [m].
        touching: Whether each spring is in contact.
        edge: The force f [m] in contact, minus the gap [m] outside, so smooth across the front. For springs touched or
            released in this interval it is f or the gap continued as if the event had not happened.
    """

    surface: FloatArray
    touching: BoolArray
    edge: FloatArray


@dataclass
class SpringBed:
    """Springs at one instant.

    Attributes:
        law: Law of each spring.
        g: MDR profile at the springs [m], shape (n,).
        touching: Whether each spring is in contact, shape (n,).
        surface: Displacement u of the end of each spring [m], shape (n,).
        strains: Strains e_j of the branches [m], shape (m, n).
    """

    law: SpringLaw
    g: FloatArray
    touching: BoolArray
    surface: FloatArray
    strains: FloatArray

    @classmethod
    def undeformed(cls, law: SpringLaw, g: FloatArray, depth: float) -> SpringBed:
        """The bed at the first instant; a depth [m] > 0 at that instant is applied as a step."""
        surface = np.maximum(depth - g, 0.0)
        return cls(law, g, surface > 0, surface, np.repeat(surface[None], law.weights.size, axis=0))

    def copy(self) -> SpringBed:
        """Copy of the springs that can be advanced independently."""
        return replace(self, touching=self.touching.copy(), surface=self.surface.copy(), strains=self.strains.copy())

    def release(self, span: float) -> None:
        """Advance by a time [s] without the indenter."""
        self.surface, self.strains = self.law.free(self.surface, self.strains, span)
        self.touching = np.zeros(self.g.size, dtype=np.bool_)

    def advance(self, coefficients: FloatArray, span: float, nodes: FloatArray = _AT_END) -> Passage:
        """Advance by a time [s] under an indenter, and return the springs at the nodes.

        Args:
            coefficients: Coefficients of the depth [m] as a polynomial of the share s of the interval, 0 <= s <= 1.
            span: Duration of the interval [s].
            nodes: Shares s, increasing, the last one 1, shape (q,).

        Raises:
            NotConvergedError: If a spring is touched and released without end.
        """
        motion, shape = Motion.of(self.law, coefficients, span), (nodes.size, self.g.size)
        passage = Passage(np.zeros(shape), np.zeros(shape, dtype=np.bool_), np.zeros(shape))
        events, moving = np.zeros(self.g.size), np.arange(self.g.size)
        for number in range(_MOST_EVENTS):
            pressed = self.touching[moving]
            for group in (moving[pressed], moving[~pressed]):
                if group.size:
                    start = events[group] if number else np.zeros(1)
                    course = self._course(group, motion, span, start)
                    # Touch and release at the same instant are caused by rounding, so its bound is doubled.
                    course = course._replace(rounding=course.rounding * 2.0**number)
                    events[group] = self._stretch(group, course, motion, nodes, passage)
            moving = moving[events[moving] < np.inf]
            if not moving.size:
                return passage._replace(edge=np.where(passage.touching, 1, -1) * np.abs(passage.edge))
        raise NotConvergedError(
            f"{moving.size} springs are touched and released more than {_MOST_EVENTS} times between two instants",
            {"springs": float(moving.size)},
        )

    def _stretch(
        self, i: NDArray[np.intp], course: Course, motion: Motion, nodes: FloatArray, passage: Passage
    ) -> FloatArray:
        """Advance springs i, all in contact or all free, to their next event or the end of the interval.

        Returns the shares of these events, inf without one, shape of i.
        """
        is_pressed, event = bool(self.touching[i[0]]), first_fall(course)
        s = np.maximum(nodes[:, None], course.start)
        values, is_later = course.values(s), nodes[:, None] >= course.start
        surface = _polynomial(motion.depth, s) - self.g[i] if is_pressed else course.fading(s).sum(axis=0)
        passage.surface[:, i] = np.where(is_later, surface, passage.surface[:, i])
        passage.touching[:, i] = np.where(is_later, is_pressed, passage.touching[:, i])
        is_continued = (nodes[:, None] > event) | ~course.start.any()
        passage.edge[:, i] = np.where(is_continued, values, passage.edge[:, i])
        ends = event < np.inf
        for some, end in ((~ends, _AT_END), (ends, event[ends])):
            if some.any():
                self._move(i[some], motion, course.among(some), end)
        return event

    def _course(self, i: NDArray[np.intp], motion: Motion, span: float, start: FloatArray) -> Course:
        """Forces of springs i in contact, or gaps of free ones, over an interval, from states at its shares `start`."""
        g, law = self.g[i], self.law
        if self.touching[i[0]]:
            constant, rates, shared = -law.long_term * g, 1 / law.times, motion.force
            strains = self.strains[:, i] - _polynomial(motion.strains[..., None], start)
            fading = law.weights[:, None] * strains
        else:
            constant, rates, shared = g, law.modes.rates, -motion.depth
            fading = law.modes.amplitudes(self.surface[i], self.strains[:, i])
        rounding = _ROUNDING * (g + np.abs(motion.depth).sum() + np.abs(fading).sum(axis=0))
        return Course(constant, fading, span * rates, start, shared, rounding)

    def _move(self, i: NDArray[np.intp], motion: Motion, course: Course, end: FloatArray) -> None:
        """Set springs i to their state at shares `end`: those of their next events, or `_AT_END` without an event."""
        fading = course.fading(end[None])[:, 0]
        is_pressed, is_event = bool(self.touching[i[0]]), end is not _AT_END
        if is_pressed:
            self.strains[:, i] = _polynomial(motion.strains[..., None], end) + fading / self.law.weights[:, None]
        else:
            self.surface[i], self.strains[:, i] = fading.sum(axis=0), self.law.modes.strains @ fading
        if is_pressed or is_event:
            self.surface[i] = _polynomial(motion.depth, end) - self.g[i]
        self.touching[i] = is_pressed != is_event

    def forces(self, speed: float) -> FloatArray:
        """Forces f over the instantaneous modulus [m], zero of free springs, at a speed of the indenter [m/s], (n,)."""
        law = self.law
        pressed = law.long_term * self.surface + law.viscosity * speed + law.weights @ self.strains
        return np.where(self.touching, pressed, 0.0)


def followed(law: SpringLaw, g: FloatArray, path: Path) -> Iterator[tuple[SpringBed, FloatArray]]:
    """Yields at each instant of a path the bed, always the same advanced object, and `Passage.edge`, shape (n,)."""
    bed = SpringBed.undeformed(law, g, float(path.depth[0]))
    yield bed, path.depth[0] - g
    for k, span in enumerate(np.diff(path.time).tolist()):
        if path.free is not None and path.free[k]:
            bed.release(span)
            yield bed, np.full(g.size, -1.0)
        else:
            yield bed, bed.advance(path.polynomials[k], span).edge[-1]

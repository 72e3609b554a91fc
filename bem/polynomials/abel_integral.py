"""Nodes of int f(t)/sqrt(t^2 - r^2) dt over one stretch of the contact, for each radius r by itself.

On a stretch [start, stop] the integrand is analytic but for points at or beyond its ends: the radius r, its mirror
image -r, the start (where a kink leaves a square root) and, for a sphere, the pole of g' at the equator beyond stop.
With hi the larger and lo the smaller of the two neighbouring singularities below the interval,

    t = hi + (hi - lo) sinh^2(eta),    dt / sqrt((t - hi)(t - lo)) = 2 d(eta),

takes both away: the logarithm of the pressure at a kink is the length of the range of eta. Where a pole is closer than
half the interval, the outer half of it is taken by pole - t = (pole - stop) exp(xi), in which a pole and a logarithm
are entire. Both ranges are cut into Gauss panels no longer than one. How many there are, and where, depends on that
radius alone: other radii of the same call change nothing.

All positions are offsets from an origin (the rim of the flat end), which keep their digits where radii lose them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from bem.polynomials.gauss_panels import gauss_nodes
from bem.polynomials.mapped import MappedFunction, MappedGrid
from contact.records.validation import FloatArray

# Gauss nodes of a panel. Seen from a panel of length one the nearest singularity lies 0.35 beyond an end (the pole) or
# pi/2 beside it (t = -r), where the error of n nodes is below 3.0^(-2n): 1e-22 for 24.
NODES: Final = 24
# Longest first part of a stretch, relative to its distance from the singularity before it, and growth of the next
# parts. 32 samples leave 3.1^-32 there; with twice as much they leave 2.2^-32.
LONGEST_FIRST: Final = 2.0
GROWTH: Final = 3.0
# Where the pressure in the centre of a tip begins to be a pure power of t, relative to the stretch: profiles rise like
# r^n (1 + O(r)) at their tips, so the rounding unit is small enough.
TIP: Final = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Stretch:
    """A part of the contact between two radii where the profile is not analytic.

    Attributes:
        origin: Radius that offsets count from.
        start: Offset of the inner end.
        stop: Offset of the outer end.
        room: Distance from there to the pole of the integrand, infinite if it has none.
    """

    origin: float
    start: float
    stop: float
    room: float = np.inf

    @property
    def begins_at_tip(self) -> bool:
        """Whether the inner end is the axis."""
        return self.origin + self.start == 0.0


def graded_ends(ends: Sequence[float], nearest: float = math.inf) -> list[float]:
    """Ends of stretches cut so that each is short against its distance from the singularities before its start.

    Args:
        ends: Ends of the stretches, at all but the first of which the profile is not analytic.
        nearest: Distance of a singularity below each inner end, where it is less than the length of the stretch before.
    """
    graded = list(ends[:2])
    for before, start, stop in zip(ends, ends[1:], ends[2:], strict=False):
        step = min(start - before, nearest)
        while LONGEST_FIRST * step < stop - start:
            graded.append(start + step)
            step *= GROWTH
        graded.append(stop)
    return graded


@dataclass(frozen=True)
class AbelNodes:
    """Nodes t for some radii, shape (radii, nodes); lengths in any unit.

    Attributes:
        radius: r, shape (radii, 1).
        position: t.
        offset: t minus the stretch's origin.
        room: Distance from t to the pole.
        weight: Weights of int f(t)/sqrt(t^2 - r^2) dt.
    """

    radius: FloatArray
    position: FloatArray
    offset: FloatArray
    room: FloatArray
    weight: FloatArray


Integrand: TypeAlias = Callable[[AbelNodes], FloatArray]


def abel_integral(integrand: Integrand, stretch: Stretch, radius: FloatArray, offset: FloatArray) -> FloatArray:
    """int f(t)/sqrt(t^2 - r^2) dt over the part of a stretch beyond r.

    Args:
        integrand: f at nodes, shape (radii, nodes).
        stretch: Where to integrate.
        radius: r >= 0, shape (n,).
        offset: r minus the stretch's origin, with all its digits, shape (n,).

    Returns:
        Shape (n,), zero for radii beyond the stretch.
    """
    total = np.zeros_like(radius)
    centre = (radius == 0.0) & stretch.begins_at_tip
    ordinary = np.flatnonzero((offset < stretch.stop) & ~centre)
    for rows, nodes in _grouped(stretch, radius[ordinary], offset[ordinary]):
        total[ordinary[rows]] = np.sum(integrand(nodes) * nodes.weight, axis=1)
    if centre.any():
        total[centre] = _in_the_centre(integrand, stretch)
    return total


def _in_the_centre(integrand: Integrand, stretch: Stretch) -> float:
    """int f(t)/t dt from a tip: f is a power of t up to a tiny t0, and 1/t = sqrt(1 - (t0/t)^2)/sqrt(t^2 - t0^2)."""
    tiny = np.full(1, TIP * stretch.stop)
    first, second = (float(integrand(_single(stretch, t))[0, 0]) for t in (tiny, 2 * tiny))
    ((_, nodes),) = _grouped(stretch, tiny, tiny)
    outer = np.sum(integrand(nodes) * nodes.weight * np.sqrt(1 - (tiny / nodes.position) ** 2))
    return float(outer + first / np.log2(second / first))


def _single(stretch: Stretch, t: FloatArray) -> AbelNodes:
    """One node at a tip's distance t, for the radius zero."""
    t = t[:, None]
    return AbelNodes(np.zeros_like(t), t, t, stretch.stop + stretch.room - t, np.ones_like(t))


def _grouped(stretch: Stretch, radius: FloatArray, offset: FloatArray) -> Iterator[tuple[NDArray[np.intp], AbelNodes]]:
    """Nodes for the radii that need the same numbers of panels, and the places of these radii."""
    ranges = _Ranges.of(stretch, radius, offset)
    counts = np.column_stack([np.ceil(ranges.reach), np.ceil(ranges.growth)]).astype(np.intp)
    # As `np.unique`, which would load `numpy.ma`, a tenth of a first answer.
    for near, far in sorted(set(map(tuple, counts.tolist()))):
        rows = np.flatnonzero((counts == (near, far)).all(axis=1))
        parts = [ranges.near(rows, near), ranges.far(rows, far)] if far else [ranges.near(rows, near)]
        r = radius[rows, None]
        yield rows, AbelNodes(r, *(np.concatenate(columns, axis=1) for columns in zip(*parts, strict=True)))


@dataclass(frozen=True)
class _Ranges:
    """The two substitutions for each radius, shape (n,).

    Attributes:
        stretch: Where to integrate.
        radius: r.
        below: Whether r lies below the stretch.
        high: Offset of hi, the start of the interval.
        apart: t - r at t = hi.
        gap: hi - lo.
        length: Of the interval.
        reach: Largest eta.
        growth: Largest xi, zero without a pole near by.
    """

    stretch: Stretch
    radius: FloatArray
    below: NDArray[np.bool_]
    high: FloatArray
    apart: FloatArray
    gap: FloatArray
    length: FloatArray
    reach: FloatArray
    growth: FloatArray

    @classmethod
    def of(cls, stretch: Stretch, radius: FloatArray, offset: FloatArray) -> _Ranges:
        """The ranges for radii r, given with their offsets."""
        below = offset < stretch.start
        high = np.where(below, stretch.start, offset)
        length = stretch.stop - high
        gap = 2 * radius if stretch.begins_at_tip else np.abs(offset - stretch.start)
        # Where r is the start, only one singularity is left.
        gap = np.where(gap > 0, gap, length)
        is_close = stretch.room < length / 2
        inner = np.where(is_close, (length + stretch.room) / 2, length)
        growth = np.log(np.where(is_close, inner / stretch.room, 1.0))
        reach = np.arcsinh(np.sqrt(inner / gap))
        return cls(stretch, radius, below, high, np.where(below, high - offset, 0.0), gap, length, reach, growth)

    def near(self, rows: NDArray[np.intp], panels: int) -> tuple[FloatArray, ...]:
        """Position, offset, room and weight of the nodes in eta."""
        eta, width = _panels(self.reach[rows], panels)
        gap, high, radius = (column[rows, None] for column in (self.gap, self.high, self.radius))
        beyond = gap * np.sinh(eta) ** 2
        offset = np.minimum(high + beyond, self.stretch.stop)
        position = self.stretch.origin + offset
        room = (self.length[rows, None] - beyond) + self.stretch.room
        if self.stretch.begins_at_tip:
            return position, offset, room, 2 * width
        partner = np.where(self.below[rows, None], beyond, gap + beyond)
        return position, offset, room, 2 * width * np.sqrt(partner / (position + radius))

    def far(self, rows: NDArray[np.intp], panels: int) -> tuple[FloatArray, ...]:
        """The same of the nodes in xi."""
        xi, width = _panels(self.growth[rows], panels)
        high, radius, apart = (column[rows, None] for column in (self.high, self.radius, self.apart))
        room = self.stretch.room * np.exp(xi)
        beyond = self.length[rows, None] + self.stretch.room - room
        offset = np.minimum(high + beyond, self.stretch.stop)
        position = self.stretch.origin + offset
        return position, offset, room, width * room / np.sqrt((apart + beyond) * (position + radius))


def _panels(reach: FloatArray, panels: int) -> tuple[FloatArray, FloatArray]:
    """Gauss nodes and weights on [0, reach], shape (n, panels NODES)."""
    nodes, weights = gauss_nodes(NODES)
    share = ((np.arange(panels)[:, None] + nodes) / panels).ravel()
    return share * reach[:, None], np.tile(weights, panels) / panels * reach[:, None]


def arc_integral(radius: FloatArray, function: MappedFunction, origin: float, count: int) -> FloatArray:
    """int f(s)/sqrt(r^2 - s^2) ds over a function's whole range, for radii beyond it: s = r sin(theta) on each piece.

    Args:
        radius: r, shape (n,).
        function: f of s - origin.
        origin: Where the function begins.
        count: Gauss nodes on each piece, which crowd towards its start as the function's own do.

    Returns:
        Shape (n,).
    """
    v, omega = gauss_nodes(count)
    r, power = radius[:, None], function.grid.power[:, None]
    ends = np.minimum(origin + function.grid.ends, r)
    theta = np.arctan2(ends, np.sqrt(np.maximum((r - ends) * (r + ends), 0.0)))
    width = np.diff(theta, axis=1)[..., None]
    s = r[..., None] * np.sin(theta[:, :-1, None] + width * v**power)
    weights = width * power * v ** (power - 1) * omega
    values: FloatArray = np.sum(function(np.clip(s - origin, 0.0, function.grid.end)) * weights, axis=(1, 2))
    return values


def even_abel_integral(
    slope_over_t: Callable[[FloatArray], FloatArray], grid: MappedGrid, radius: FloatArray
) -> FloatArray:
    """int_r^a psi'(t)/sqrt(t^2 - r^2) dt of a smooth even function on [0, a].

    With t^2 = r^2 + s^2 the integrand psi'(t)/t is an even analytic function of t, hence analytic in s.

    Args:
        slope_over_t: psi'(t)/t.
        grid: The pieces of [0, a] on which psi is known; the range of s takes one more, with as many nodes.
        radius: r in [0, a], shape (n,).

    Returns:
        Shape (n,).
    """
    nodes, weights = gauss_nodes(grid.count)
    a, pieces = grid.end, len(grid.left) + 1
    s = ((np.arange(pieces)[:, None] + nodes) / pieces).ravel()
    # The last piece may end a rounding before the radius asked for.
    reach = np.sqrt(np.maximum(a - radius, 0.0) * (a + radius))[:, None]
    t = np.minimum(np.hypot(radius[:, None], reach * s), a)
    integral: FloatArray = reach[:, 0] / pieces * (slope_over_t(t) @ np.tile(weights, pieces))
    return integral

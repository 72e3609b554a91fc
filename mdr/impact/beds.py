"""Stiffness integral K and contact radius a as functions of the depth: all that an impact needs of layer and profile.

    K(d) = int_0^a(d) y_1^2 dx,   g(a(d)) = d                                                  Eqs. (3), (5), (6)

A track consists of pieces between the radii where the profile is not analytic. On each piece K and a are piecewise
polynomials of ln(1 + z/z_0), z = (d - d_0)^(1/q), d_0 the depth at its start: q = n under a tip r^n, 2 beyond a break
or a flat end, where g - d_0 is a power series in the root of a - b. The logarithm resolves all lengths of layer and
profile. Nodes are images of Lobatto nodes in ln(1 + u/u_0), a = u at a tip and b + u^2 elsewhere.

Under a power law f = C r^n lengths count in thicknesses L and depths in C L^n, so that one track serves all layers of
one kind. Other profiles count in metres. A track ends at one of the radii b + L 2^k of a ladder, so that the answer to
an impact does not depend on the others of its batch.
"""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from bem.equation import Sizes
from bem.flat_punch import FlatPunchSource, IntegralEquation
from bem.kernels.moduli import contact_modulus
from bem.kernels.of_layer import ContactKernel, contact_kernel, unit_of
from contact import ElasticLayer, FlatPunch, Profile, Scene, UnsupportedSceneError
from contact.records.validation import FloatArray
from mdr.equilibria import springs_on
from mdr.own_units import OwnUnits, is_power_law, own_units
from mdr.profiles import tip_of
from mdr.radius_search import largest_radius
from mdr.spring_bed import Springs

# Width of the panels in ln(u), and nodes less than `Sizes.radii`. With twice the width or half the nodes the error of K
# is 1e-7 instead of 1e-13.
_WIDTH, _FEWER = 0.5, 4
# Octaves of u below the smallest length, and largest number of octaves of a piece. Fewer make first touch less smooth.
_BELOW, _MOST = 2, 40
# Least log2 of the tabulated radii over the unit of length.
_LOWEST = -60
# Force times depth over the stored energy: its upper bound (cones on thin layers), and a usual value.
_MOST_WORK, _USUAL_WORK = 12.0, 2.5
# Largest exponent n of a tip r^n, and least log2 of tabulated heights: beyond these, energies underflow.
_FLATTEST, _UNDERFLOW = 40.0, -900.0
# Least distance of contacts from an upright end, over its radius.
_NEAR_END = 1e-6
# Number of tracks and ladders that are cached.
_KEPT = 128


class Piece(NamedTuple):
    """K and a between two depths.

    Attributes:
        start: Least depth.
        end: Largest depth.
        power: q.
        scale: z_0.
        is_tip: Whether it starts at a point, where K and a vanish; then the polynomials are those of K/z and a/z.
        ends: Ends of the m panels in ln(1 + z/z_0), shape (m + 1,).
        series: Chebyshev coefficients of K, a and dK/dln(1 + z/z_0), shape (m, k, 3).
    """

    start: float
    end: float
    power: float
    scale: float
    is_tip: bool
    ends: FloatArray
    series: FloatArray

    def at(self, depth: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """K, dK/d(depth) and a at depths of any shape; beyond the piece those of its end."""
        rise = np.clip(depth - self.start, 1e-300, self.end - self.start)
        z = rise ** (1 / self.power)
        place = np.log1p(z / self.scale)
        which = np.clip(np.searchsorted(self.ends, place) - 1, 0, len(self.series) - 1)
        low, high = self.ends[which], self.ends[which + 1]
        # T_n(cos x) = cos(n x): ten times as fast as the recurrence for a few points.
        angle = np.arccos(np.clip((2 * place - low - high) / (high - low), -1.0, 1.0))
        basis = np.cos(angle[..., None] * np.arange(self.series.shape[1]))
        K, a, slope = np.moveaxis((basis[..., None] * self.series[which]).sum(axis=-2), -1, 0)
        slope = slope / (self.scale + z)
        if self.is_tip:
            slope, K, a = K + z * slope, z * K, np.where(depth > self.start, z * a, 0.0)
        return K, slope * z / (self.power * rise), a


class Track:
    """K and a up to a largest contact radius.

    Args:
        springs: Springs of layer and profile.
        excess: Largest contact radius less the flat one, in the springs' unit of length; nothing under a flat punch.

    Attributes:
        flat: b.
        still: K at touch.
        pieces: None under a flat punch.
        fall: Radius beyond which g falls within `excess`, or None.
        floor: Relative rounding error of K and depth.
    """

    def __init__(self, springs: Springs, excess: float) -> None:
        tip = springs.tip
        self.flat = tip.flat
        self.fall: float | None = None
        self.still = float(springs.at([tip.flat]).K[0]) if tip.flat else 0.0
        self.pieces: tuple[Piece, ...] = ()
        top = tip.flat + excess
        self.floor = float(np.add(*springs.floor(np.array([top])))[0])
        if isinstance(tip.profile, FlatPunch):
            return
        ends = [0.0, *(b - tip.flat for b in tip.breaks if tip.flat < b < top * (1 - 1e-9)), excess]
        depth, stiffness = 0.0, self.still
        for low, high in pairwise(ends):
            piece, stiffness, self.fall = _piece(springs, low, high, depth, stiffness)
            self.pieces += (piece,) if piece else ()
            if self.fall is not None or piece is None:
                break
            depth = piece.end

    def until(self, piece: int) -> float:
        """Depth at the end of a piece."""
        return self.pieces[piece].end if self.pieces else np.inf

    def at(self, depth: FloatArray, piece: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """K, dK/d(depth) and a at depths of any shape on one piece."""
        if self.pieces:
            return self.pieces[piece].at(depth)
        return np.full_like(depth, self.still), np.zeros_like(depth), np.full_like(depth, self.flat)


def _piece(
    springs: Springs, low: float, high: float, start: float, stiffness: float
) -> tuple[Piece | None, float, float | None]:
    """Interpolate K and a for radii from b + `low` to b + `high`; depth and K at `low` are `start` and `stiffness`.

    Returns the piece (None if g falls before one panel is full), K at its end, and the last radius before g falls.
    """
    flat, is_tip = springs.tip.flat, springs.tip.flat + low == 0
    count = springs.sizes.radii - _FEWER
    # An upright end of the profile is at u = infinity: a = u/(1 + u/span).
    span = springs.tip.end - flat - low if springs.tip.profile.ends_upright else np.inf
    top = (high - low) / (1 - (high - low) / span)
    share, least = _shares(springs, flat + low, top, count)
    u = top * share ** (1 if is_tip else 2)
    excess = low + u / (1 + u / span)
    radius = flat + excess
    values = springs.at(radius, excess if flat else None)
    falls = np.flatnonzero(np.diff(values.g, prepend=start) <= 0)
    fall = float(radius[max(falls[0] - 1, 0)]) if falls.size else None
    panels = (falls[0] if falls.size else radius.size) // count
    if not panels:
        return None, stiffness, fall
    depth, K, a = (one[: panels * count] for one in (values.g, values.K, radius))
    power = springs.tip.exponent if is_tip else 2.0
    z, rows = (depth - start) ** (1 / power), np.stack([K, a])
    if is_tip:
        rows = rows / z
    scale = float(np.interp(least, share[: z.size], z))
    place = np.append(0.0, np.log1p(z / scale))
    first = np.array([stiffness, flat + low])
    if is_tip:
        first = _series(place[1 : count + 1], rows[:, :count], place[[0, count]])[:, :2].T @ (-1.0) ** np.arange(count)
    rows = np.hstack([first[:, None], rows])
    ends = place[::count]
    parts = [slice(i, i + count + 1) for i in range(0, z.size, count)]
    series = np.array([_series(place[part], rows[:, part], place[part][[0, -1]]) for part in parts])
    return Piece(start, float(depth[-1]), power, scale, is_tip, ends, series), float(K[-1]), fall


def _shares(springs: Springs, start: float, top: float, count: int) -> tuple[FloatArray, float]:
    """Lobatto nodes of u over its largest value without 0, panel by panel, and u_0 over it."""
    lengths = [length for length in (start, 0.0 if springs.kernel.is_uniform else springs.unit) if length]
    octaves = np.log2(top / min(lengths, default=top))
    octaves = min(max(octaves / (2 if start else 1), 0) + _BELOW, _MOST)
    least = 2.0**-octaves
    whole = np.log1p(1 / least)
    panels = int(np.ceil(whole / _WIDTH))
    lobatto = (1 - np.cos(np.pi * np.arange(1, count + 1) / count)) / 2
    return least * np.expm1(whole / panels * (np.arange(panels)[:, None] + lobatto).ravel()), least


def _series(place: FloatArray, rows: FloatArray, ends: FloatArray) -> FloatArray:
    """Chebyshev coefficients of the interpolants of two rows, and of the derivative of the first, shape (k, 3)."""
    half = (ends[1] - ends[0]) / 2
    basis = chebyshev.chebvander((place - ends[0]) / half - 1, place.size - 1)
    fit = np.linalg.solve(basis, rows.T)
    return np.column_stack([fit, np.append(chebyshev.chebder(fit[:, 0]), 0.0) / half])


class Bed(NamedTuple):
    """Layer and profile in their own units, 2 E* = 1.

    Attributes:
        kernel: Kernel of the layer.
        unit: Unit of length of the kernel.
        indenter: Profile.
        tabulated: Layer and table that springs come from; None if from the layer's equation.
    """

    kernel: ContactKernel
    unit: float
    indenter: Profile
    tabulated: tuple[ElasticLayer, FlatPunchSource] | None = None

    def springs(self, sizes: Sizes) -> Springs:
        """The springs at the given resolution."""
        if self.tabulated is not None:
            layer, source = self.tabulated
            springs = springs_on(layer, self.indenter, source)
            return springs if sizes == springs.sizes else springs.finer
        return Springs(self.kernel, self.unit, 0.5, tip_of(self.indenter), sizes)


def bed_of(scene: Scene, flat_punch: FlatPunchSource) -> tuple[Bed, OwnUnits]:
    """The bed of a scene and its units.

    Raises:
        UnsupportedSceneError: If a tip is too flat, or its heights are beyond doubles.
    """
    layer, indenter = scene.layer, scene.indenter
    tabulated = None if layer.is_half_space or isinstance(flat_punch, IntegralEquation) else (layer, flat_punch)
    if tabulated or not is_power_law(indenter):
        units = OwnUnits(layer, indenter, 1.0, 1.0, contact_modulus(layer))
    else:
        units = own_units(layer, indenter)
    exponent = tip_of(indenter).exponent
    if exponent > _FLATTEST:
        raise UnsupportedSceneError(
            f"indenter: impacts are modelled for tips up to r^{_FLATTEST:g}, not r^{exponent:g}"
        )
    if not 0 < units.depth < math.inf:
        raise UnsupportedSceneError(f"indenter: heights of a tip r^{exponent:g} over a thickness are beyond doubles")
    return Bed(contact_kernel(units.layer), unit_of(units.layer), units.indenter, tabulated), units


class Ladder:
    """Depth and force of elastic contacts over 2 E* at radii b + L 2^k, to a tenth; none under a flat punch.

    Args:
        springs: Springs of layer and profile.
    """

    def __init__(self, springs: Springs) -> None:
        self.springs, self.tip = springs, springs.tip
        self.excess, self.depth, self.force = np.empty((3, 0))
        end = min(self.tip.end * (1 - _NEAR_END * self.tip.profile.ends_upright), largest_radius(springs))
        self._last = end - self.tip.flat
        if not isinstance(self.tip.profile, FlatPunch):
            self.lowest = max(_LOWEST, int(_UNDERFLOW / self.tip.exponent))
            self._climb(np.arange(self.lowest, 1.0))

    @property
    def is_whole(self) -> bool:
        """Whether the last level is the widest possible contact."""
        return not self.excess.size or self.excess[-1] >= self._last

    def _climb(self, levels: FloatArray) -> None:
        """Append levels; the last one is at the widest possible contact if they exceed it."""
        u = self.springs.unit * np.exp2(levels)
        excess = u / (1 + u / (self.tip.end - self.tip.flat))
        inner = excess < self._last * (1 - _NEAR_END)
        excess = excess[inner] if inner.all() else np.append(excess[inner], self._last)
        values = self.springs.coarse.at(self.tip.flat + excess, excess)
        columns = np.stack([excess, values.g, values.g * values.K - values.M])
        self.excess, self.depth, self.force = np.hstack([[self.excess, self.depth, self.force], columns])

    def extend(self) -> None:
        """Append one level, unless the last one is the widest possible contact."""
        if not self.is_whole:
            self._climb(np.array([self.lowest + float(self.excess.size)]))

    def level(self, energy: float, impulse: float) -> int:
        """The first level at which the stored energy or the impulse of a dashpot certainly exceeds the given one."""
        while True:
            reached = (self.force * self.depth > _MOST_WORK * energy) | (self.force > 2 * impulse)
            if reached.any() or self.is_whole:
                return int(reached.argmax()) if reached.any() else max(self.excess.size - 1, 0)
            self.extend()

    def depth_of(self, energy: float, impulse: float) -> tuple[float, float]:
        """Approximate depths at which an elastic layer stores the energy, and a dashpot takes up the impulse."""
        self.level(energy, impulse)
        with np.errstate(divide="ignore"):
            depth, force = np.log(self.depth), np.log(self.force)
        elastic = np.exp(np.interp(np.log(_USUAL_WORK * energy), force + depth, depth))
        damped = np.exp(np.interp(np.log(impulse), force, depth)) if impulse < np.inf else np.inf
        return float(elastic), float(damped)


@lru_cache(maxsize=_KEPT)
def ladder_of(bed: Bed, sizes: Sizes) -> Ladder:
    """The ladder of a bed."""
    return Ladder(bed.springs(sizes))


@lru_cache(maxsize=_KEPT)
def track_of(bed: Bed, sizes: Sizes, excess: float) -> Track:
    """K and a of a bed up to a radius b + excess."""
    return Track(bed.springs(sizes), excess)

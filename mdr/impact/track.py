"""Stiffness integral K and contact radius a as functions of the depth: all that an impact needs of layer and profile.

    K(d) = int_0^a(d) y_1^2 dx,   g(a(d)) = d                                                  Eqs. (3), (5), (6)

Between radii where the profile is not analytic, K and a are smooth functions of ln(1 + z/z_0), z = (d - d_0)^(1/q),
d_0 the depth at the inner radius b: q = n under a tip r^n, 1 beyond a flat end where d rises like sqrt(a - b), and 2
beyond other breaks where d - d_0 is a power series in sqrt(a - b). Chebyshev series on panels interpolate K and a at
images of Lobatto nodes in ln(1 + s/s_0), with a = s under a tip and a = b + s^2 elsewhere. They resolve all lengths of
layer and profile.

A track ends at one of the radii b + u, u = 2^level, with whole and half levels. So the track of an impact does not
depend on other impacts.
Under a power law f = C r^n lengths count in thicknesses L and depths in C L^n: one track serves all layers of one kind.
Other profiles count in metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from bem.flat_punch import FlatPunchSource, IntegralEquation
from bem.kernels.moduli import contact_modulus
from contact import ElasticLayer, FlatPunch, Profile, Scene, UnsupportedSceneError
from contact.records.validation import FloatArray
from mdr.equilibria import springs_on
from mdr.own_units import OwnUnits, is_power_law, own_units
from mdr.profiles import tip_of
from mdr.radius_search import largest_radius
from mdr.spring_bed import Springs

# Width of the panels in ln(1 + s/s_0), and their degree less `Sizes.radii`. With twice the width or half the degree the
# error of K is 1e-7 instead of 1e-13.
_WIDTH, _LOWER_DEGREE = 0.5, 4
# s_0 over the smallest length. With twice as much the first touch is less smooth, with half a panel is added.
_FIRST_LENGTH = 0.25
# s of the first node over that of the second: g vanishes at a tip, so that series are extrapolated to it. Half as
# much and twice as much are as good.
_NEAR_START = 1 / 8
# Least depth and K that have a logarithm: loads below are those of the least level.
_SMALLEST = 1e-300
# Least distance of contacts from an upright end, over its radius.
_NEAR_END = 1e-6
# Largest exponent n of a tip r^n: beyond it, energies underflow.
_FLATTEST = 40.0
# Number of tracks, and of radii for first estimates, that are cached.
_CACHED = 512


@dataclass(frozen=True, eq=False)
class Bed:
    """Springs of a layer under a profile, at two resolutions whose change states errors.

    Attributes:
        springs: The springs.
        widest: Radius of the widest contact less that of the flat end.
    """

    springs: Springs
    widest: float

    def radius(self, level: float) -> float:
        """Contact radius of a level less that of the flat end, that of the widest contact at most."""
        return min(math.exp2(level), self.widest)


@lru_cache(maxsize=_CACHED)
def bed_of(layer: ElasticLayer, indenter: Profile, flat_punch: FlatPunchSource) -> Bed:
    """The bed of a layer under a profile, with flat-punch data from a source."""
    springs = springs_on(layer, indenter, flat_punch)
    end = springs.tip.end * (1 - _NEAR_END * indenter.ends_upright)
    return Bed(springs, min(end, largest_radius(springs)) - springs.tip.flat)


def units_of(scene: Scene, flat_punch: FlatPunchSource) -> OwnUnits:
    """Units in which the springs of a scene are tabulated.

    Raises:
        UnsupportedSceneError: If a tip is too flat, or its heights are beyond doubles.
    """
    layer, indenter = scene.layer, scene.indenter
    if is_power_law(indenter) and (layer.is_half_space or isinstance(flat_punch, IntegralEquation)):
        units = own_units(layer, indenter)
    else:
        units = OwnUnits(layer, indenter, 1.0, 1.0, contact_modulus(layer))
    exponent = tip_of(indenter).exponent
    if exponent > _FLATTEST:
        raise UnsupportedSceneError(
            f"indenter: impacts are modelled for tips up to r^{_FLATTEST:g}, not r^{exponent:g}"
        )
    if not 0 < units.depth < math.inf:
        raise UnsupportedSceneError(f"indenter: heights of a tip r^{exponent:g} over a thickness are beyond doubles")
    return units


class Piece(NamedTuple):
    """K and a between two radii, of which the inner one may be the tip.

    Attributes:
        start: Depth d_0 at the inner radius.
        end: Depth at the outer radius.
        power: q.
        scale: z_0.
        is_tip: Whether K and a vanish at the inner radius; then the series are those of K/z and a/z.
        edges: Ends of the m panels in ln(1 + z/z_0), shape (m + 1,).
        series: Chebyshev coefficients of K, a and dK/dln(1 + z/z_0), shape (m, k, 3).
    """

    start: float
    end: float
    power: float
    scale: float
    is_tip: bool
    edges: FloatArray
    series: FloatArray

    def at(self, depth: FloatArray) -> FloatArray:
        """K, dK/d(depth) and a at depths of any shape, shape (3, ..); beyond the end K goes on as a straight line."""
        rise = np.minimum(np.maximum(depth - self.start, 1e-300), self.end - self.start)
        z = rise ** (1 / self.power)
        place = np.log1p(z / self.scale)
        panel = np.searchsorted(self.edges[1:-1], place)
        low, high = self.edges[panel], self.edges[panel + 1]
        # T_n(cos x) = cos(n x): ten times as fast as the recurrence for a few points.
        angle = np.arccos(np.clip((2 * place - low - high) / (high - low), -1.0, 1.0))
        terms = np.cos(angle[..., None, None] * np.arange(self.series.shape[1]))
        K, a, slope = np.moveaxis((terms @ self.series[panel])[..., 0, :], -1, 0)
        by_z = slope / (self.scale + z)
        if self.is_tip:
            K, by_z, a = z * K, K + z * by_z, np.where(depth > self.start, z * a, 0.0)
        slope = by_z * z / (self.power * rise)
        # A body that relaxing springs of constant stiffness never turn would not show how far it passes the end.
        return np.stack([K + slope * np.maximum(depth - self.end, 0.0), slope, a])


class Track:
    """K and a from the first touch to a contact radius.

    Args:
        springs: Springs of layer and profile.
        top: Contact radius less that of the flat end.

    Attributes:
        flat: Radius of the flat end.
        touch_stiffness: K at the first touch.
        pieces: None under a flat punch.
        deepest: Depth up to which the track is tabulated, infinite under a flat punch.
        fall: Radius beyond which g falls, or None.
    """

    def __init__(self, springs: Springs, top: float) -> None:
        self.springs, tip = springs, springs.tip
        self.flat, self.pieces, self.deepest = tip.flat, list[Piece](), 0.0
        self.fall: float | None = None
        self.touch_stiffness = float(springs.at([tip.flat]).K[0]) if tip.flat else 0.0
        if isinstance(tip.profile, FlatPunch):
            self.deepest = math.inf
            return
        ends = [0.0, *(b - tip.flat for b in tip.breaks if b > tip.flat), tip.end - tip.flat]
        for low, high in pairwise(ends):
            if low < top and self.fall is None:
                self._append(low, high, min(high, top))

    def _append(self, low: float, high: float, top: float) -> None:
        """Append the piece from a radius `low`, cut at `top`, analytic up to `high`; all are less the flat radius."""
        springs, tip = self.springs, self.springs.tip
        is_tip = tip.flat + low == 0
        power, root = 2.0 if low else tip.exponent, 1 if is_tip else 2
        # An upright end of the profile is at u = infinity: a = b + u/(1 + u/span).
        span = tip.end - tip.flat - low if tip.profile.ends_upright else math.inf
        lengths = (tip.flat + low, 0.0 if springs.kernel.is_uniform else springs.unit, high - low)
        shortest = min(length for length in lengths if length)
        first = _FIRST_LENGTH * (shortest if shortest < math.inf else 1.0) ** (1 / root)
        widest = (top - low) / (1 - (top - low) / span)
        whole, degree = math.log1p(widest ** (1 / root) / first), springs.sizes.radii - _LOWER_DEGREE
        panels = math.ceil(whole / _WIDTH)
        lobatto = (1 - np.cos(np.pi * np.arange(degree + 1) / degree)) / 2
        s = first * np.expm1(whole / panels * (np.arange(panels)[:, None] + lobatto))
        s[0, 0] = _NEAR_START * s[0, 1]
        u = s**root
        excess = low + u / (1 + u / span)
        values = springs.at((tip.flat + excess).ravel(), excess.ravel() if tip.flat else None)
        g, rows = values.g.reshape(s.shape), np.stack([values.K.reshape(s.shape), tip.flat + excess])
        falling = np.argwhere(np.diff(g) <= 0)
        if falling.size:
            panels, self.fall = int(falling[0, 0]), float(rows[1][tuple(falling[0])])
        if panels:
            z = np.maximum(g - self.deepest, 0.0) ** (1 / power)
            scale = float(np.interp(first, s[0], z[0]))
            interpolants = _interpolants(np.log1p(z / scale)[:panels], (rows / z if is_tip else rows)[:, :panels])
            end = float(g[panels - 1, -1])
            self.pieces.append(Piece(self.deepest, end, power, scale, is_tip, *interpolants))
            self.deepest = end

    def until(self, piece: int) -> float:
        """Depth at the end of a piece, infinite if it is the last."""
        return self.pieces[piece].end if piece + 1 < len(self.pieces) else math.inf

    def at(self, depth: FloatArray, piece: int) -> FloatArray:
        """K, dK/d(depth) and a at depths of any shape on one piece, shape (3, ..)."""
        if not self.pieces:
            return np.stack([np.full_like(depth, value) for value in (self.touch_stiffness, 0.0, self.flat)])
        return self.pieces[piece].at(depth)


def _interpolants(place: FloatArray, rows: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Ends and Chebyshev series of m panels of K, a and dK/d(place), from values at k places each, shape (2, m, k)."""
    ends = np.append(0.0, place[:, -1])
    middle, half = (ends[1:] + ends[:-1]) / 2, np.diff(ends)[:, None] / 2
    basis = chebyshev.chebvander((place - middle[:, None]) / half, place.shape[1] - 1)
    series = np.linalg.solve(basis, np.moveaxis(rows, 0, -1))
    slope = chebyshev.chebder(series[..., 0], axis=1) / half
    return ends, np.concatenate([series, np.pad(slope, ((0, 0), (0, 1)))[..., None]], axis=2)


@lru_cache(maxsize=_CACHED)
def track_of(bed: Bed, level: float, *, finer: bool) -> Track:
    """K and a of a bed up to the radius of a level, or the same at the finer resolution whose change states errors."""
    return Track(bed.springs.finer if finer else bed.springs, bed.radius(level))


@lru_cache(maxsize=_CACHED)
def _rough(bed: Bed, level: float) -> tuple[float, float]:
    """ln(depth) and ln(K) at the radius of a level, to 1e-4."""
    flat, excess = bed.springs.tip.flat, np.array([bed.radius(level)])
    values = bed.springs.coarse.at(flat + excess, excess if flat else None)
    return math.log(max(float(values.g[0]), _SMALLEST)), math.log(max(float(values.K[0]), _SMALLEST))


def level_of(bed: Bed, order: int, value: float) -> tuple[float, float]:
    """Least whole or half level whose depth d has d^order K(d) above a value, and about the depth where both are equal.

    The level of the widest contact stands for all values beyond it.
    """
    springs, target = bed.springs, math.log(value)
    if isinstance(springs.tip.profile, FlatPunch):
        return 0, (value / float(springs.at([springs.tip.flat]).K[0])) ** (1 / order)

    def product(level: float) -> float:
        depth, K = _rough(bed, level)
        return order * depth + K

    level = round(math.log2(springs.unit))
    while product(level) < target and bed.radius(level) < bed.widest:
        level += 1
    while product(level - 1) > target:
        level -= 1
    (depth, K), (lower, lower_K) = _rough(bed, level), _rough(bed, level - 1)
    growth = order + (K - lower_K) / max(depth - lower, 1e-3)
    # A track is a fifth cheaper up to the half level where that is enough.
    is_half = 2 * target < product(level) + product(level - 1) and bed.radius(level - 0.5) < bed.widest
    return level - 0.5 * is_half, math.exp(depth + (target - product(level)) / growth)

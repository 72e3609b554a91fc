"""Stiffness integral K and contact radius a as functions of the depth: all that an impact needs of layer and profile.

    K(d) = int_0^a(d) y_1^2 dx,   g(a(d)) = d                                                  Eqs. (3), (5), (6)

A track consists of pieces between the radii where the profile is not analytic. On each piece K and a are piecewise
polynomials of ln(1 + z/z_0), z = (d - d_0)^(1/q), d_0 the depth at its start: q = n under a tip r^n, 2 beyond a break
or a flat end, where g - d_0 is a power series in the root of a - b. Nodes are images of Lobatto nodes in ln(1 + s/s_0),
a = s at a tip and b + s^2 elsewhere, which resolves all lengths of layer and profile. Panels do not depend on how far
an impact reaches: a track is extended when one reaches farther than all before.

Under a power law f = C r^n lengths count in thicknesses L and depths in C L^n, so that one track serves all layers of
one kind. Other profiles count in metres.
"""

from __future__ import annotations

import math
from functools import lru_cache
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
from mdr.spring_bed import Springs, SpringValues

# Width of the panels in ln(s), and nodes less than `Sizes.radii`. With twice the width or half the nodes the error of K
# is 1e-7 instead of 1e-13.
_WIDTH, _FEWER = 0.5, 4
# s_0 over the smallest length. With twice as much the first touch is less smooth, with half a panel is added.
_LEAST = 0.25
# Panels of a piece that are tabulated at first, up to half its smallest length or less; then one at a time.
_AT_FIRST = 2
# Least distance of contacts from an upright end, over its radius.
_NEAR_END = 1e-6
# Largest exponent n of a tip r^n: beyond it, energies underflow.
_FLATTEST = 40.0
# Number of tracks that are cached.
_KEPT = 256


class Bed(NamedTuple):
    """Layer and profile in their own units, and where the flat-punch data come from."""

    layer: ElasticLayer
    indenter: Profile
    flat_punch: FlatPunchSource


def units_of(scene: Scene, flat_punch: FlatPunchSource) -> OwnUnits:
    """The units in which the springs of a scene are tabulated.

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


class Piece:
    """K and a between two radii, tabulated from the inner one outwards.

    Args:
        springs: Springs of layer and profile.
        low: Radius at its start, less the flat one.
        high: Radius at its end, less the flat one.
        start: Depth at its start.
        stiffness: K there.

    Attributes:
        power: q.
        is_tip: Whether it starts at a point, where K and a vanish; then the polynomials are those of K/z and a/z.
        ends: Ends of the m panels in ln(1 + z/z_0), shape (m + 1,).
        series: Chebyshev coefficients of K, a and dK/dln(1 + z/z_0), shape (m, k, 3).
        panels: Number of panels up to its end.
        deepest: Depth up to which it is tabulated.
    """

    def __init__(self, springs: Springs, low: float, high: float, start: float, stiffness: float) -> None:
        tip, self.low, self.start, self.deepest = springs.tip, low, start, start
        self.is_tip, self.count = tip.flat + low == 0, springs.sizes.radii - _FEWER
        self.power, self._root = (tip.exponent, 1) if self.is_tip else (2.0, 2)
        # An upright end of the profile is at u = infinity: a = b + u/(1 + u/span).
        self._span = tip.end - tip.flat - low if tip.profile.ends_upright else np.inf
        top = (high - low) / (1 - (high - low) / self._span) if self._span < np.inf else high - low
        lengths = (tip.flat + low, 0.0 if springs.kernel.is_uniform else springs.unit, high - low)
        least = min(length for length in lengths if length)
        self._least = _LEAST * (least if least < np.inf else 1.0) ** (1 / self._root)
        whole = float(np.log1p(min(top ** (1 / self._root) / self._least, 1e300)))
        self.panels = math.ceil(whole / _WIDTH)
        self._width = whole / self.panels
        self._last = np.array([[stiffness], [tip.flat + low]])
        self.ends, self.series, self.scale = np.zeros(1), np.zeros((0, self.count + 1, 3)), 0.0

    def next_nodes(self) -> tuple[FloatArray, FloatArray]:
        """Nodes of the next panels: s, and radii less the flat one."""
        number = 1 if len(self.series) else min(_AT_FIRST, self.panels)
        lobatto = (1 - np.cos(np.pi * np.arange(1, self.count + 1) / self.count)) / 2
        place = (len(self.series) + np.arange(number)[:, None] + lobatto).ravel()
        s = self._least * np.expm1(self._width * place)
        u = s**self._root
        return s, self.low + u / (1 + u / self._span)

    def append(self, s: FloatArray, radius: FloatArray, values: SpringValues) -> None:
        """Append panels from values at their nodes."""
        z, rows = (values.g - self.start) ** (1 / self.power), np.stack([values.K, radius])
        rows = rows / z if self.is_tip else rows
        self.scale = self.scale or float(np.interp(self._least, s, z))
        place = np.log1p(z / self.scale)
        if self.is_tip and not len(self.series):
            first = _series(place[: self.count], rows[:, : self.count], np.array([0.0, place[self.count - 1]]))
            self._last = first[:, :2].T @ (-1.0) ** np.arange(self.count)[:, None]
        place, rows = np.append(self.ends[-1], place), np.hstack([self._last, rows])
        parts = [slice(i, i + self.count + 1) for i in range(0, s.size, self.count)]
        new = [_series(place[part], rows[:, part], place[part][[0, -1]]) for part in parts]
        self.series, self.ends = (
            np.concatenate([self.series, new]),
            np.append(self.ends, place[self.count :: self.count]),
        )
        self._last, self.deepest = rows[:, -1:], float(values.g[-1])

    def at(self, depth: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """K, dK/d(depth) and a at depths of any shape; beyond the piece those of its end."""
        rise = np.minimum(np.maximum(depth - self.start, 1e-300), self.deepest - self.start)
        z = rise ** (1 / self.power)
        place = np.log1p(z / self.scale)
        which = np.searchsorted(self.ends[1:-1], place)
        low, high = self.ends[which], self.ends[which + 1]
        # T_n(cos x) = cos(n x): ten times as fast as the recurrence for a few points.
        angle = np.arccos(np.minimum(np.maximum((2 * place - low - high) / (high - low), -1.0), 1.0))
        basis = np.cos(angle[..., None, None] * np.arange(self.series.shape[1]))
        found = (basis @ self.series[which])[..., 0, :]
        K, a, slope = found[..., 0], found[..., 1], found[..., 2] / (self.scale + z)
        if self.is_tip:
            slope, K, a = K + z * slope, z * K, np.where(depth > self.start, z * a, 0.0)
        return K, slope * z / (self.power * rise), a


def _series(place: FloatArray, rows: FloatArray, ends: FloatArray) -> FloatArray:
    """Chebyshev coefficients of the interpolants of two rows, and of the derivative of the first, shape (k, 3)."""
    half = (ends[1] - ends[0]) / 2
    basis = chebyshev.chebvander((place - ends[0]) / half - 1, place.size - 1)
    fit = np.linalg.solve(basis, rows.T)
    return np.column_stack([fit, np.append(chebyshev.chebder(fit[:, 0]), 0.0) / half])


class Track:
    """K and a up to any depth.

    Args:
        springs: Springs of layer and profile.

    Attributes:
        flat: b.
        still: K at touch.
        pieces: None under a flat punch.
        depth: Depths that are tabulated, shape (n,); one of them under a flat punch.
        stiffness: K there, shape (n,).
        widest: Largest contact radius.
        fall: Radius beyond which g falls, or None.
    """

    def __init__(self, springs: Springs) -> None:
        self.springs, tip = springs, springs.tip
        self.flat, self.pieces = tip.flat, list[Piece]()
        self.fall: float | None = None
        self.still = float(springs.at([tip.flat]).K[0]) if tip.flat else 0.0
        self.is_punch = isinstance(tip.profile, FlatPunch)
        self.depth: FloatArray = np.ones(int(self.is_punch))
        self.stiffness = self.still * self.depth
        self.widest = min(tip.end * (1 - _NEAR_END * tip.profile.ends_upright), largest_radius(springs))
        self._radii = [tip.flat, *(b for b in tip.breaks if tip.flat < b < self.widest), self.widest]

    @property
    def is_whole(self) -> bool:
        """Whether it ends at the widest possible contact."""
        full = len(self.pieces) == len(self._radii) - 1 and len(self.pieces[-1].series) == self.pieces[-1].panels
        return self.is_punch or self.fall is not None or full

    @property
    def deepest(self) -> float:
        """Largest depth that is tabulated."""
        return float(self.depth[-1]) if self.depth.size else 0.0

    def extend(self) -> None:
        """Tabulate some more panels, unless the track is whole or g falls."""
        if not self.pieces or len(self.pieces[-1].series) == self.pieces[-1].panels:
            low, high = (radius - self.flat for radius in self._radii[len(self.pieces) :][:2])
            stiffness = self.stiffness[-1] if self.pieces else self.still
            self.pieces.append(Piece(self.springs, low, high, self.deepest, float(stiffness)))
        piece = self.pieces[-1]
        s, excess = piece.next_nodes()
        radius = self.flat + excess
        values = self.springs.at(radius, excess if self.flat else None)
        falls = np.flatnonzero(np.diff(values.g, prepend=self.deepest) <= 0)
        if falls.size:
            self.fall = float(radius[max(falls[0] - 1, 0)])
        whole = (falls[0] if falls.size else s.size) // piece.count * piece.count
        if whole:
            values = SpringValues(*(one[:whole] for one in values))
            piece.append(s[:whole], radius[:whole], values)
            self.depth, self.stiffness = np.append(self.depth, values.g), np.append(self.stiffness, values.K)
        elif not len(piece.series):
            self.pieces.pop()

    def cover(self, depth: float) -> None:
        """Tabulate up to a depth, as far as there are contacts."""
        while self.deepest < depth and not self.is_whole:
            self.extend()

    def depth_of(self, order: int, value: float) -> float:
        """Approximate depth d with d^order K(d) = value."""
        rise, d = float(np.log(value)), np.log(self.depth)
        f = order * d + np.log(self.stiffness)
        tip = self.springs.tip
        below = rise - f[0] if self.is_punch else min(rise - f[0], 0.0)
        return float(np.exp(np.interp(rise, f, d) + below / (order + (0.0 if tip.flat else 1 / tip.exponent))))

    def reach(self, order: int, value: float) -> float:
        """Least tabulated depth d with d^order K(d) above a value; that of the widest contact if there is none."""
        if self.is_punch:
            return math.inf
        while True:
            above = self.depth**order * self.stiffness > value
            if above.any():
                return float(self.depth[above.argmax()])
            if self.is_whole:
                return self.deepest
            self.extend()

    def until(self, piece: int) -> float:
        """Depth at the end of a piece."""
        return self.pieces[piece].deepest if piece + 1 < len(self.pieces) else np.inf

    def at(self, depth: FloatArray, piece: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """K, dK/d(depth) and a at depths of any shape on one piece."""
        if self.is_punch:
            return np.full_like(depth, self.still), np.zeros_like(depth), np.full_like(depth, self.flat)
        return self.pieces[piece].at(depth)


@lru_cache(maxsize=_KEPT)
def track_of(bed: Bed, *, finer: bool) -> Track:
    """K and a of a bed, or the same at the finer resolution whose change states errors."""
    springs = springs_on(*bed)
    return Track(springs.finer if finer else springs)

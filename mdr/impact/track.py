"""Stiffness integral K and contact radius a as functions of the depth: all that an impact needs of layer and profile.

    K(d) = int_0^a(d) y_1^2 dx,   g(a(d)) = d                                                  Eqs. (3), (5), (6)

A track consists of pieces between the radii where the profile is not analytic. On each piece K and a are piecewise
polynomials of ln(1 + z/z_0), z = (d - d_0)^(1/q), d_0 the depth at its start: q = n under a tip r^n, 2 beyond a break
or a flat end, where g - d_0 is a power series in the root of a - b. The logarithm resolves all lengths of layer and
profile. Nodes are images of Lobatto nodes in ln(1 + u/u_0), a = u at a tip and b + u^2 elsewhere.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from contact import FlatPunch
from contact.records.validation import FloatArray
from mdr.spring_bed import Springs

# Width of the polynomials in ln(u), and nodes less than `Sizes.radii`. Twice as wide, or with half the nodes, K errs by
# 1e-7 in place of 1e-13.
_WIDTH, _FEWER = 0.5, 4
# Octaves of u below the smallest length, and most octaves of a piece. With fewer of both, touches are less smooth.
_BELOW, _MOST = 2, 40


class Piece(NamedTuple):
    """K and a between two depths.

    Attributes:
        start: Least depth.
        end: Largest depth.
        power: q.
        scale: z_0.
        is_tip: Whether it starts at a point, where K and a vanish; then the polynomials are those of K/z and a/z.
        ends: Of the polynomials in ln(1 + z/z_0), shape (m + 1,).
        series: Legendre coefficients of K, a and dK/dln(1 + z/z_0), shape (m, k, 3).
    """

    start: float
    end: float
    power: float
    scale: float
    is_tip: bool
    ends: FloatArray
    series: FloatArray

    def at(self, depth: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """K, dK/d(depth) and a at depths of any shape; constant beyond the piece."""
        rise = np.clip(depth - self.start, 1e-300, self.end - self.start)
        z = rise ** (1 / self.power)
        place = np.log1p(z / self.scale)
        which = np.clip(np.searchsorted(self.ends, place) - 1, 0, len(self.series) - 1)
        low, high = self.ends[which], self.ends[which + 1]
        basis = legendre.legvander((2 * place - low - high) / (high - low), self.series.shape[1] - 1)
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
    """The piece between two excesses from the depth and K at its start; K at its end; the radius where g falls."""
    flat, is_tip = springs.tip.flat, springs.tip.flat + low == 0
    count = springs.sizes.radii - _FEWER
    # Towards an upright end u has no end: a = u/(1 + u/room).
    room = springs.tip.end - flat - low if springs.tip.profile.ends_upright else np.inf
    top = (high - low) / (1 - (high - low) / room)
    share, least = _shares(springs, flat + low, top, count)
    grown = top * share ** (1 if is_tip else 2)
    excess = low + grown / (1 + grown / room)
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
    """Legendre coefficients between ends through rows at places, and of the first row's derivative, shape (k, 3)."""
    half = (ends[1] - ends[0]) / 2
    basis = legendre.legvander((place - ends[0]) / half - 1, place.size - 1)
    fit = np.linalg.solve(basis, rows.T)
    return np.column_stack([fit, np.append(legendre.legder(fit[:, 0]), 0.0) / half])

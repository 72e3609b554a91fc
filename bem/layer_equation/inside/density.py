"""The Abel density of a contact's pressure as the fields inside ask for it: by its slope."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from bem.polynomials.abel_integral import Stretch
from bem.polynomials.gauss_panels import PANEL_NODES, gauss_nodes
from contact.records.validation import FloatArray
from contact.scene.profiles import PowerLaw, Profile

# Ends of pieces lie so many times as far from a singularity of the profile's slope as the ends before them. Seen from
# a radius on the other side, where panels are equal in the logarithm of the distance, 20 Gauss nodes leave 2.47^-40 of
# such a piece; with 4 they left 2.15^-40, and 8.9e-15 of the stress under a sphere (scene 146 of seed 19501).
_GRADING = 3.0
# Share of its first piece by which a power-law tip is cut off: of the whole piece, 20 nodes left 4e-13 of the stress
# (exponents 1.05 to 4.7 against 48 nodes, 30 points, seed 3, 2026-11-22).
_TIP = 0.125
# Longest piece of the density over the thickness: longer ones left 2e-10 of the stress at a/h = 10, where panels that
# suit a depth span several thicknesses.
_LONGEST = 1.0
# Ends closer to another than this share of a piece are the same but for rounding.
_CLOSE = 1e-9
# Entries of a block of sin(kt): 32 MB.
_BLOCK = 1 << 22


@dataclass(frozen=True)
class Piece:
    """Part of the contact on which the slope is analytic but for its beginning.

    Attributes:
        start: First t.
        length: Of the piece.
        power: ``t = start + length u^power`` makes the slope's beginning smooth.
    """

    start: float
    length: float
    power: float


@dataclass(frozen=True)
class Density:
    """phi of ``p^(k) = (E*/pi) int_0^a phi cos(kt) dt``, lengths in one unit.

    Attributes:
        radius: a.
        edge_value: phi(a), zero but for flat punches and adhesion.
        pieces: From the axis to the edge.
        slope: phi'(t) at t = piece.start + offset, for a piece and offsets of any shape.
        scale: Length over which phi' varies, at least.
    """

    radius: float
    edge_value: float
    pieces: tuple[Piece, ...]
    slope: Callable[[Piece, FloatArray], FloatArray]
    scale: float

    @property
    def mean_pressure(self) -> float:
        """|F|/(pi a^2) in units of E*, of the edge value and of the rest, however much of the two cancels."""
        t, weighted = self._nodes(1.0 / self.radius)
        return 2.0 / math.pi * (abs(self.edge_value) * self.radius + abs(float(t @ weighted))) / self.radius**2

    def transform(self, wavenumber: FloatArray) -> FloatArray:
        """int_0^a phi cos(kt) dt at k > 0, shape (k,): by parts, phi(a) sin(ka)/k - int phi' sin(kt)/k dt."""
        t, weighted = self._nodes(float(wavenumber.max(initial=1.0)))
        total = self.edge_value * np.sin(wavenumber * self.radius)
        rows = max(1, _BLOCK // max(t.size, 1))
        for start in range(0, wavenumber.size, rows):
            some = slice(start, start + rows)
            total[some] -= np.sin(np.multiply.outer(wavenumber[some], t)) @ weighted
        return np.asarray(total / wavenumber)

    def _nodes(self, largest: float) -> tuple[FloatArray, FloatArray]:
        """Nodes t and phi' times weights, for waves up to a wavenumber."""
        u, w = gauss_nodes(PANEL_NODES)
        positions, weighted = [np.empty(0)], [np.empty(0)]
        for piece in self.pieces:
            panels = math.ceil(piece.power * piece.length / min(self.scale, 4.0 * math.pi / largest))
            at = ((np.arange(panels)[:, None] + u) / panels).ravel()
            offset = piece.length * at**piece.power
            stretch = piece.length * piece.power * at ** (piece.power - 1.0) / panels * np.tile(w, panels)
            positions.append(piece.start + offset)
            weighted.append(self.slope(piece, offset) * stretch)
        return np.concatenate(positions), np.concatenate(weighted)


def pieces_of(indenter: Profile, unit: float, stretches: Sequence[Stretch]) -> tuple[Piece, ...]:
    """Pieces of a contact from its axis to its edge: the flat end, then those between breakpoints of the profile.

    Args:
        indenter: Profile of revolution.
        unit: Length unit [m].
        stretches: Between the breakpoints, with the distance of the pole of the slope, lengths by `unit`.
    """
    flat = indenter.flat_radius / unit
    pieces = _no_longer([Piece(0.0, flat, 1.0)] if flat else [])
    previous = -math.inf
    for stretch in stretches:
        start, stop = flat + stretch.start, flat + stretch.stop
        power = 2.0 if start > 0.0 else 4.0 if isinstance(indenter, PowerLaw) else 1.0
        # Behind its own rim, which the power smooths, the slope is singular at the rim before it and at minus its own.
        ends = _graded(start, stop, min(2.0 * start, start - previous), stretch.room)
        previous = start
        if power == 4.0:
            # Beyond the tip the slope is singular a piece's beginning away.
            ends[1:1] = (start + away for away in _growing(_TIP * (ends[1] - start), ends[1] - start))
        pieces += _no_longer([Piece(one, two - one, power if one == start else 1.0) for one, two in pairwise(ends)])
    return tuple(pieces)


def cut_at(pieces: Sequence[Piece], ends: FloatArray) -> tuple[Piece, ...]:
    """Pieces that end at these places too."""
    parts = []
    for piece in pieces:
        share = (ends - piece.start) / piece.length
        inner = piece.start + piece.length * share[(share > _CLOSE) & (share < 1.0 - _CLOSE)]
        starts = [piece.start, *inner.tolist(), piece.start + piece.length]
        parts += [Piece(a, b - a, piece.power if a == piece.start else 1.0) for a, b in pairwise(starts)]
    return tuple(parts)


def _no_longer(pieces: list[Piece]) -> list[Piece]:
    """Pieces cut into parts on which psi, which varies over a thickness, is resolved."""
    parts = []
    for piece in pieces:
        count = max(1, math.ceil(piece.length / _LONGEST))
        width = piece.length / count
        parts += [Piece(piece.start + i * width, width, 1.0 if i else piece.power) for i in range(count)]
    return parts


def _graded(start: float, stop: float, behind: float, room: float) -> list[float]:
    """Ends of pieces between singularities of the slope, `behind` before start (zero: none) and `room` beyond stop.

    No piece is longer than twice its distance from them. The first may be three times as long as `behind`, since it is
    taken over the root of the way.
    """
    length, ends = stop - start, {start, stop}
    ends.update(stop - away for away in _growing(room, length))
    ends.update(start + away for away in _growing(_GRADING * behind, length))
    return sorted(ends)


def _growing(first: float, length: float) -> list[float]:
    """first, and then always `_GRADING` times as much, up to a length."""
    count = math.ceil(math.log(length / first) / math.log(_GRADING)) if 0.0 < first < length else 0
    return [first * _GRADING**i for i in range(count)]

"""The Abel density of a contact's pressure as the fields inside ask for it: by its slope."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bem.polynomials.gauss_panels import gauss_nodes
from contact.records.validation import FloatArray

# Gauss nodes of a panel over which sin(kt) turns at most twice.
_NODES = 20
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
        u, w = gauss_nodes(_NODES)
        positions, weighted = [np.empty(0)], [np.empty(0)]
        for piece in self.pieces:
            panels = math.ceil(piece.power * piece.length / min(self.scale, 4.0 * math.pi / largest))
            at = ((np.arange(panels)[:, None] + u) / panels).ravel()
            offset = piece.length * at**piece.power
            stretch = piece.length * piece.power * at ** (piece.power - 1.0) / panels * np.tile(w, panels)
            positions.append(piece.start + offset)
            weighted.append(self.slope(piece, offset) * stretch)
        return np.concatenate(positions), np.concatenate(weighted)

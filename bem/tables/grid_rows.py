"""Flat punches on one grid, ratio after ratio: a table of more rows begins with those of fewer."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from threading import Lock
from typing import NamedTuple

import numpy as np

from bem.grid.discs import punch
from bem.tables.tabulated_layer import Tabulable
from contact.records.validation import FloatArray

# Ratio a/h from which on rows are solved with periodic images, a gap between them.
THIN = 8.0


class TableRow(NamedTuple):
    """k_bar, and Chebyshev coefficients of q in 2 rho^2 - 1."""

    stiffness: float
    shape: FloatArray


@dataclass(frozen=True, eq=False)
class GridRows:
    """The punches that are known so far, and how to solve the next one.

    Attributes:
        cells: Grid cells across the punch's box.
        ratios: a/h of all rows that a table may have, increasing.
        layer: Of unit thickness.
    """

    cells: int
    ratios: FloatArray
    layer: Tabulable
    _known: list[TableRow] = field(default_factory=list)
    _growing: Lock = field(default_factory=Lock)

    def first(self, rows: int) -> list[TableRow]:
        """The punches of the first `rows` ratios."""
        with self._growing:
            while len(self._known) < rows:
                self._solve_next()
            return self._known[:rows]

    def _solve_next(self) -> None:
        """Solve one more ratio. An elastic base is felt beyond any period."""
        ratio = float(self.ratios[len(self._known)])
        thin = self.layer.is_uniform and ratio > THIN
        found = punch(self.layer, ratio * self.layer.surface.thickness, self.cells, "periodic" if thin else "free")
        self._known.append(TableRow(found.growth, found.series(found.degree) / (2.0 * found.growth)))


@lru_cache(maxsize=32)
def grid_rows(cells: int, smallest: float, largest: float, count: int, layer: Tabulable) -> GridRows:
    """The rows of a grid on log-spaced ratios, remembered with what was solved."""
    return GridRows(cells, np.geomspace(smallest, largest, count), layer)

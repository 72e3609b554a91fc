"""Flat punches on one grid, ratio after ratio: a table of more rows begins with those of fewer."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from functools import lru_cache
from threading import Lock

import numpy as np

from bem.grid.calibrated_disc import THIN, PunchSolution, measured_disc
from bem.tables.tabulated_layer import Tabulable
from contact import Layer
from contact.records.validation import FloatArray


@dataclass(frozen=True, eq=False)
class GridRows:
    """The punches that are known so far, and how to solve the next one.

    Each starts from the one before, so that it does not matter how many rows were asked for first.

    Attributes:
        cells: Grid cells across the punch's box.
        ratios: a/h of all rows that a table may have, increasing.
        layer: Of unit thickness.
    """

    cells: int
    ratios: FloatArray
    layer: Tabulable
    _known: list[PunchSolution] = field(default_factory=list)
    _growing: Lock = field(default_factory=Lock)

    def first(self, rows: int) -> list[PunchSolution]:
        """The punches of the first `rows` ratios; of all but the last, only stiffness and shape are kept."""
        with self._growing:
            while len(self._known) < rows:
                self._solve_next()
            return self._known[:rows]

    def _solve_next(self) -> None:
        """Solve one more ratio. An elastic base is felt beyond any period."""
        ratio = float(self.ratios[len(self._known)])
        disc = measured_disc(self.cells, self.layer.is_uniform and ratio > THIN)
        thickness = disc.radius / ratio
        layer = self.layer
        stretched = layer.replace(thickness=thickness) if isinstance(layer, Layer) else layer.stretched(thickness)
        start = self._known[-1].pressure if self._known else None
        solved = disc.on_layer(stretched, ratio, start)
        if self._known:
            self._known[-1] = dataclasses.replace(self._known[-1], pressure=np.zeros((0, 0)))
        self._known.append(solved)


@lru_cache(maxsize=32)
def grid_rows(cells: int, smallest: float, largest: float, count: int, layer: Tabulable) -> GridRows:
    """The rows of a grid on log-spaced ratios, remembered with what was solved."""
    return GridRows(cells, np.geomspace(smallest, largest, count), layer)

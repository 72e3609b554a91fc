"""Quadrants of square grids, and sequences of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from bem.grid.error_model import DIRECT
from contact import ElasticLayer, Profile, UnsupportedSceneError
from contact.records.validation import FloatArray

# Cells across the coarse grids on which first guesses and largest radii are looked for.
COARSE_CELLS: Final = 64
# Cells inside a contact's edge that the grid does not resolve: from there inwards the quotient of two pressures is
# regular again.
EDGE_CELLS: Final = 2.5
# Least number of cells across the coarsest grid of a sequence, from whose answer the finer ones start.
LEAST_CELLS: Final = 48


@dataclass(frozen=True, eq=False)
class QuadrantGrid:
    """The quadrant x, y > 0 of a square box.

    Attributes:
        cells: Cells across the whole box.
        cell_size: s [m].
    """

    cells: int
    cell_size: float

    @cached_property
    def radius(self) -> FloatArray:
        """r of the cell centres [m], shape (cells/2, cells/2)."""
        centre = self.cell_size * (np.arange(self.cells // 2) + 0.5)
        return np.asarray(np.hypot(centre[:, None], centre))


class Unresolved(UnsupportedSceneError):
    """Cells are too large for the layer or for what is left to an upright end, and two grids may agree all the same."""


def refuse_thin_layer(layer: ElasticLayer, cell_size: float, least: float) -> None:
    """Ask for a layer that is so many cells thick.

    Raises:
        Unresolved: If it is thinner.
    """
    thickness = layer.surface.thickness
    spanned = thickness / cell_size
    if spanned < least:
        raise Unresolved(
            f"the layer of thickness {thickness:g} m is {spanned:.2g} cells thick and needs {least:g}; "
            f"take {least / spanned:.1f} times as many points, or ask mdr or fem"
        )


def refuse_upright_end(indenter: Profile, radius: float, cell_size: float) -> None:
    """Ask for some cells between a contact's edge and an upright end, towards which the depth grows without bound.

    Raises:
        Unresolved: If there are fewer.
    """
    spanned = (indenter.max_radius - radius) / cell_size
    if indenter.ends_upright and spanned < DIRECT.end_cells:
        raise Unresolved(
            f"between the contact radius {radius:g} m and the upright end of the indenter at {indenter.max_radius:g} m "
            f"lie {spanned:.2g} cells of {DIRECT.end_cells:g} that are needed; take more points, or ask mdr"
        )


def prolonged(field: FloatArray) -> FloatArray:
    """The field on a grid of half the cell size, each value on four cells."""
    return np.repeat(np.repeat(field, 2, axis=0), 2, axis=1)


def grid_sequence(points: int) -> list[int]:
    """points, points/2, points/4, ... as long as they are even and not below `LEAST_CELLS`; coarsest first."""
    cells = [points]
    while cells[-1] % 4 == 0 and cells[-1] // 2 >= LEAST_CELLS:
        cells.append(cells[-1] // 2)
    return cells[::-1]

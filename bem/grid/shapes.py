"""Indenters that are no bodies of revolution, pressed into square cells.

The cells in contact follow from an active-set method: no tension inside, no penetration outside. The staircase outline
changes force and stiffness of a shape and of its mean profile alike. So the *ratio* of both on one grid is more
accurate than either. It multiplies the answer on discs (`bem.grid.pressed`), which has no such error.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import ceil
from typing import Final

import numpy as np
from scipy.ndimage import map_coordinates

from bem.grid.operators import GridOperator, grid_operator, pressed
from contact import ElasticLayer, NotConvergedError, Profile, Shape
from contact.records.validation import BoolArray, FloatArray

# Half the grid over the radius of the mean contact, and factor on it if a contact reaches the border. Twice the first
# takes twice as long and changes forces by 3e-10.
MARGIN: Final = 1.5
GROWTH: Final = 1.4
# Largest error of the displacement on the contact over the depth. At a hundred times of it forces are 4e-6 off, at a
# hundredth they change by 5e-9.
TOLERANCE: Final = 1e-7
# Largest number of changes of the active set; ten are usual.
MOST_SETS: Final = 60


@dataclass(frozen=True, eq=False)
class CellContact:
    """Contact of an indenter on cells of a quadrant or of the whole grid; lengths in cell sizes, pressures in E*.

    Attributes:
        radius: r of the cell centres, shape (m, m).
        angle: phi of the cell centres, shape (m, m).
        contact: Whether each cell is in contact, shape (m, m).
        pressure: p on the cells, shape (m, m).
    """

    radius: FloatArray
    angle: FloatArray
    contact: BoolArray
    pressure: FloatArray

    @property
    def copies(self) -> int:
        """Number of congruent parts of the surface, of which the grid is one: 4 for a quadrant."""
        return 4 if float(self.angle[0, 0]) > 0.0 else 1

    @property
    def load(self) -> float:
        """Force over E* s^2, s the side of a cell."""
        return self.copies * float(self.pressure.sum())

    def moment(self, order: int) -> float:
        """Sum of cos(n phi) over the cells in contact: int a^2/2 cos(n phi) dphi."""
        return self.copies * float(np.cos(order * self.angle[self.contact]).sum())

    def pressure_at(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """p at places in cell sizes, zero beyond the grid."""
        values = self.pressure
        if self.copies == 4:
            values, x, y = np.pad(values, ((1, 0), (1, 0)), mode="symmetric"), np.abs(x) + 0.5, np.abs(y) + 0.5
        else:
            x, y = (place + (values.shape[0] - 1) / 2 for place in (x, y))
        return np.asarray(map_coordinates(values, [x, y], order=1))


def pressed_cells(
    layer: ElasticLayer,
    indenter: Profile,
    depth: float,
    radius: float,
    cell_size: float,
    *,
    whole: bool,
    threads: int = 1,
    flat: bool = False,
) -> CellContact:
    """Contact at a depth [m].

    Args:
        layer: The layer.
        indenter: A shape, or a body of revolution on the same cells.
        depth: Depth [m].
        radius: First guess of the contact radius [m].
        cell_size: Side s of a cell [m].
        whole: Whether the whole grid is needed, for shapes without mirror symmetry in x.
        threads: Number of threads of the transforms.
        flat: Whether all cells within the outline are in contact.
    """
    half = ceil(MARGIN * radius / cell_size)
    while True:
        centre = np.arange(2 * half) - half + 0.5 if whole else np.arange(half) + 0.5
        r, phi = np.hypot(centre[:, None], centre), np.arctan2(centre, centre[:, None])
        height = indenter.polar(cell_size * r, phi) if isinstance(indenter, Shape) else indenter.height(cell_size * r)
        operator = _operator(layer, cell_size, 2 * half, threads, whole)
        contact, target = (height == 0.0 if flat else r < radius / cell_size), (depth - height) / cell_size
        contact, p = _active(operator, target, contact, flat=flat)
        if float(np.max(np.abs(centre)[contact.any(axis=1)], initial=0.0)) < half - 2:
            return CellContact(r, phi, contact, p)
        half = ceil(GROWTH * half)


@lru_cache(maxsize=4)
def _operator(layer: ElasticLayer, cell_size: float, cells: int, threads: int, whole: bool) -> GridOperator:
    return grid_operator(layer, cell_size, cells, "free", threads, whole=whole)


def _active(
    operator: GridOperator, target: FloatArray, contact: BoolArray, *, flat: bool
) -> tuple[BoolArray, FloatArray]:
    """Cells in contact and their pressure, for the displacement `target` in contact, from a first guess `contact`."""
    p: FloatArray | None = None
    scale = float(target.max())
    for _ in range(MOST_SETS):
        p = pressed(operator, contact, np.where(contact, target, 0.0), TOLERANCE, p)
        if flat:
            return contact, p
        penetrated = ~contact & (operator.displacement(p) < target - TOLERANCE * scale)
        pulled = contact & (p < 0.0)
        if not (penetrated.any() or pulled.any()):
            return contact, p
        contact = (contact & ~pulled) | penetrated
    raise NotConvergedError(f"the cells in contact were not found in {MOST_SETS} steps")

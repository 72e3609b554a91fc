"""A rectangle of 8-node quadrilaterals on the section of a layer, graded towards the edge of the contact."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from contact.records.validation import FloatArray

# Sizes of cells grow from the contact's edge by exp(GRADING) in all, to 1.3e-6 of the contact radius on 64 cells. With
# 8 and with 19 extrapolated stiffnesses converge more slowly than with 12, which leaves 6e-6.
GRADING = 12.0
# The mesh ends so many thicknesses beyond the contact. On bonded layers everything decays exponentially: 6 and 8 give
# the same seven digits at nu = 0.3. An unbonded layer slides on its base like a sheet, whose displacement falls like
# 1/r: a free edge at 8 thicknesses costs 1.7e-3 of the force at a/h = 1, and that falls with the square.
OUTER_DISTANCE = {"bonded": 8.0, "unbonded": 400.0}


@dataclass(frozen=True, kw_only=True)
class Section:
    """Nodes and elements; nodes count from one.

    Attributes:
        radius: of the columns of nodes, shape (n,).
        depth: z of the rows of nodes, upwards, the surface at zero, shape (m,).
        number: of the node in each column and row, zero where there is none (the middle of an element).
    """

    radius: FloatArray
    depth: FloatArray
    number: NDArray[np.int64]

    @property
    def surface(self) -> NDArray[np.int64]:
        """Numbers of the nodes at the surface."""
        return np.asarray(self.number[:, -1])

    @property
    def base(self) -> NDArray[np.int64]:
        """Numbers of the nodes at the base."""
        return np.asarray(self.number[:, 0])

    @property
    def axis(self) -> NDArray[np.int64]:
        """Numbers of the nodes at the axis."""
        return np.asarray(self.number[0])

    def nodes(self) -> Iterator[tuple[int, float, float]]:
        """Number, radius and height of every node."""
        for i, j in np.argwhere(self.number > 0):
            yield int(self.number[i, j]), float(self.radius[i]), float(self.depth[j])

    def elements(self) -> Iterator[tuple[int, ...]]:
        """Corners anticlockwise, then the middles of the sides."""
        n = self.number
        for i in range(0, n.shape[0] - 1, 2):
            for j in range(0, n.shape[1] - 1, 2):
                corners = n[i, j], n[i + 2, j], n[i + 2, j + 2], n[i, j + 2]
                middles = n[i + 1, j], n[i + 2, j + 1], n[i + 1, j + 2], n[i, j + 1]
                yield tuple(int(node) for node in (*corners, *middles))


def section(
    contact_radius: float, thickness: float, cells: int, kinks: tuple[float, ...] = (), support: str = "bonded"
) -> Section:
    """Return the mesh; twice the cells give a mesh that has all its nodes.

    Args:
        contact_radius: a [m], where cells are smallest.
        thickness: h [m].
        cells: on the contact and over the thickness; half as many again beyond it where the layer slides.
        kinks: radii inside the contact [m] where the profile has a corner: cells are small there, too.
        support: of the layer, which says how far the mesh must reach.
    """
    farther = OUTER_DISTANCE[support] / OUTER_DISTANCE["bonded"]
    beyond = cells if farther == 1.0 else cells * 3 // 2
    # The first cell is the same however far the mesh reaches.
    grading = GRADING + float(np.log(farther))
    outside = contact_radius + _graded(OUTER_DISTANCE[support] * thickness, beyond, grading)
    columns = _with_middles(np.concatenate([_inside((*kinks, contact_radius), cells), outside[1:]]))
    rows = _with_middles(-_graded(thickness, cells)[::-1])
    there = ~(_odd(columns.size)[:, None] & _odd(rows.size)[None, :])
    number = np.where(there, np.cumsum(there.ravel()).reshape(there.shape), 0)
    return Section(radius=columns, depth=rows, number=number)


def _graded(length: float, cells: int, grading: float = GRADING) -> FloatArray:
    """From zero to the length; cells grow like an exponential, and half of the nodes of twice as many are these."""
    grown: FloatArray = length * np.expm1(grading * np.linspace(0.0, 1.0, cells + 1)) / np.expm1(grading)
    return grown


def _inside(graded_at: tuple[float, ...], cells: int) -> FloatArray:
    """From the axis to the last of the radii, small cells on either side of each."""
    first = graded_at[0]
    parts = [first - _graded(first, cells)[::-1]]
    for start, end in pairwise(graded_at):
        half = _graded((end - start) / 2, cells)
        parts += [start + half[1:], end - half[-2::-1]]
    return np.concatenate(parts)


def _with_middles(corners: FloatArray) -> FloatArray:
    return np.sort(np.concatenate([corners, (corners[1:] + corners[:-1]) / 2]))


def _odd(count: int) -> NDArray[np.bool_]:
    return np.asarray(np.arange(count) % 2 == 1)

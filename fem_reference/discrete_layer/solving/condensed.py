"""Static condensation: what only one triangle knows is eliminated before there is a system.

With o for the unknowns that a triangle shares with others and i for those inside it, ``K_ii u_i + K_io u_o = f_i``
leaves ``S u_o = f_o - K_oi K_ii^-1 f_i`` with ``S = K_oo - K_oi K_ii^-1 K_io`` (E. L. Wilson, Int. J. Numer. Meth.
Engng 8 (1974) 198-203).  The pressure inside a triangle goes with the six displacements there, hence at every nu.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact.records.validation import FloatArray, IntArray
from fem_reference.discrete_layer.assembly import Space


@dataclass(frozen=True)
class CondensedElements:
    """The triangles without their inner unknowns.

    Attributes:
        matrices: S of each triangle, shape (triangle, o, o).
        unknowns: what they belong to, shape (triangle, o).
        inner: the unknowns inside, shape (triangle, i).
        inverse: K_ii^-1, shape (triangle, i, i).
        coupling: K_io, shape (triangle, i, o).
    """

    matrices: FloatArray
    unknowns: IntArray
    inner: IntArray
    inverse: FloatArray
    coupling: FloatArray

    def outer_loads(self, loads: FloatArray) -> FloatArray:
        """Loads (size, m) of all unknowns as loads of the shared ones; those inside are zero."""
        moved = loads.copy()
        if self.inner.size and loads[self.inner].any():
            inside = self.inverse @ loads[self.inner]
            moved -= summed(self.coupling.transpose(0, 2, 1) @ inside, self.unknowns, len(loads))
        moved[self.inner] = 0.0
        return moved

    def fill_in(self, solution: FloatArray, loads: FloatArray | None = None) -> None:
        """Set the inner unknowns of a solution (size, m) under loads of that shape from the shared ones."""
        if self.inner.size:
            missing = -(self.coupling @ solution[self.unknowns])
            solution[self.inner] = self.inverse @ (missing if loads is None else missing + loads[self.inner])


def condensed(elements: FloatArray, space: Space) -> CondensedElements:
    """Eliminates the inner unknowns of element matrices (triangle, n, n) in the order of `Space.element_unknowns`."""
    outer = elements.shape[1] - space.inner_count
    inverse = np.asarray(np.linalg.inv(elements[:, outer:, outer:]), dtype=np.float64)
    coupling = elements[:, outer:, :outer]
    shared = elements[:, :outer, :outer]
    if space.inner_count:
        matrices = coupling.transpose(0, 2, 1) @ (inverse @ coupling)
        np.subtract(shared, matrices, out=matrices)
    else:
        matrices = shared.copy()
    unknowns = space.element_unknowns
    return CondensedElements(matrices, unknowns[:, :outer], unknowns[:, outer:], inverse, coupling)


def summed(local: FloatArray, unknowns: IntArray, size: int) -> FloatArray:
    """Sum over triangles of columns (triangle, n, m) on unknowns (triangle, n), shape (size, m)."""
    columns = [np.bincount(unknowns.ravel(), column.ravel(), minlength=size) for column in np.moveaxis(local, -1, 0)]
    return np.stack(columns, axis=-1)


def forces(elements: FloatArray, unknowns: IntArray, solution: FloatArray) -> FloatArray:
    """Nodal forces of triangles under a solution (size, m), of that shape."""
    return summed(elements @ solution[unknowns], unknowns, len(solution))

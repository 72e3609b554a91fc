"""Solutions with prescribed unknowns, all from one factorisation of the condensed triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from contact.records.validation import BoolArray, FloatArray, IntArray
from fem_reference.discrete_layer.assembly import Space, scatter
from fem_reference.discrete_layer.solving.condensed import condensed, forces
from fem_reference.discrete_layer.solving.linear_solver import CheckedSolver


@dataclass(frozen=True)
class System:
    """Equations of a discrete layer before any unknown is prescribed.

    Attributes:
        space: the unknowns.
        elements: matrix of each triangle, shape (triangle, n, n).
        springs: what is added to the matrix of all unknowns, or nothing.
        order: all unknowns in their order of elimination.
    """

    space: Space
    elements: FloatArray
    springs: sparse.csc_array | None
    order: IntArray


class RestrictedSolver:
    """Solutions with prescribed unknowns.

    Args:
        system: the equations.
        held: what is prescribed; none of it lies inside a triangle.
        backend: a key of `linear_solver.BACKENDS`.
        least_share: see `CheckedSolver`.

    Attributes:
        held: the prescribed unknowns.
        checked: the factorised matrix of the others.
    """

    def __init__(self, system: System, held: IntArray, backend: str, least_share: float) -> None:
        self.held = held
        self._size, self._springs = system.space.size, system.springs
        self._condensed = condensed(system.elements, system.space)
        is_free = np.ones(self._size, dtype=bool)
        is_free[held] = False
        self._beside = self._cut_free(is_free)
        is_free[self._condensed.inner] = False
        self._free = system.order[is_free[system.order]]
        matrix = scatter(self._condensed.matrices, self._places(), len(self._free))
        if self._springs is not None:
            matrix = matrix + self._springs[self._free][:, self._free]
        self.checked = CheckedSolver(matrix, backend, least_share)

    def _cut_free(self, is_free: BoolArray) -> tuple[FloatArray, IntArray]:
        """Takes the prescribed unknowns out of the triangles; those that had any, as they were."""
        free = is_free[self._condensed.unknowns]
        beside = np.flatnonzero(~free.all(axis=1))
        whole = self._condensed.matrices[beside]
        self._condensed.matrices[beside] *= free[beside][:, :, None] & free[beside][:, None, :]
        return whole, self._condensed.unknowns[beside]

    def _places(self) -> IntArray:
        """Rows of the unknowns of each triangle; prescribed ones, zero by now, go where the last free one goes."""
        place = np.full(self._size, -1, dtype=np.int32)
        place[self._free] = np.arange(len(self._free))
        places = place[self._condensed.unknowns]
        last = np.maximum(places.max(axis=1, keepdims=True), 0)
        return np.where(places < 0, last, places)

    def _forces(self, solution: FloatArray) -> FloatArray:
        """Nodal forces of the triangles beside prescribed unknowns, and of the springs."""
        found = forces(*self._beside, solution)
        return found if self._springs is None else found + self._springs @ solution

    def solve_displaced(self, values: FloatArray) -> FloatArray:
        """All unknowns, shape (size, m), for prescribed values of shape (held, m)."""
        solution = np.zeros((self._size, values.shape[1]))
        solution[self.held] = values
        solution[self._free] = self.checked.solve(-self._forces(solution)[self._free])
        self._condensed.fill_in(solution)
        return solution

    def solve_loaded(self, loads: FloatArray) -> FloatArray:
        """All unknowns, shape (size, m), for loads of that shape, the prescribed unknowns at zero."""
        solution = np.zeros_like(loads)
        solution[self._free] = self.checked.solve(self._condensed.outer_loads(loads)[self._free])
        self._condensed.fill_in(solution, loads)
        return solution

    def response(self, unknowns: IntArray, loads: FloatArray) -> FloatArray:
        """What loads (n, m) of some unknowns move these by, shape (n, m); none is prescribed or inside a triangle."""
        place = np.full(self._size, -1)
        place[self._free] = np.arange(len(self._free))
        all_loads = np.zeros((len(self._free), loads.shape[1]))
        all_loads[place[unknowns]] = loads
        return np.asarray(self.checked.solve(all_loads)[place[unknowns]])

    def reactions(self, solution: FloatArray, unknowns: IntArray) -> FloatArray:
        """Nodal forces that act on the layer at prescribed unknowns, for a solution without loads inside triangles."""
        return self._forces(solution)[unknowns]

"""Adhesion on a grid whose cells detach at a stress that depends on their size (Pohrt and Popov 2015).

At the edge of an adhering contact the stress is singular, so no fixed strength can be a criterion. Let a square cell of
size s carry the uniform stress tau. Its relaxation releases the elastic energy of this stress in a half-space,

    U = (1/2) int tau u dA = kappa tau^2 s^3/E*,
    kappa = (1/2 pi) int int dA dA'/|r - r'| = (2/3 pi) [1 - sqrt 2 + (3/2) ln((sqrt 2 + 1)/(sqrt 2 - 1))] = 0.473201,

over a unit square. The cell detaches when U reaches the energy dgamma s^2 of the new surface, at the tension

    tau_c = sqrt(E* dgamma/(kappa s)).

Close to the edge a layer responds like the half-space, so the constant is valid for layers with cells much smaller than
the thickness. At each depth all edge cells whose tension exceeds tau_c are removed and the pressure is solved again,
until no tension exceeds it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import log, pi, sqrt
from typing import Any, Final, NamedTuple

import numpy as np

from bem.branch import DEPTH, FORCE
from bem.grid.adhering import NODES, AdheringIndenter, adhesive_length, largest_radius
from bem.grid.discs import disc_of, refuse_unresolved
from bem.grid.operators import GridOperator, grid_operator, pressed
from bem.grid.pressed import FIRST_CELLS, Pressing
from bem.kernels.moduli import contact_modulus
from contact import ContactPath, CriticalPoint, Detachment, DetachmentPath, FlatPunch, Scene, StageLog
from contact.records.validation import BoolArray, FloatArray
from contact.stated import stated_error

# kappa, derived above.
CELL_ENERGY: Final = 2.0 / (3.0 * pi) * (1.0 - sqrt(2.0) + 1.5 * log((sqrt(2.0) + 1.0) / (sqrt(2.0) - 1.0)))
# Radius at the start of a detachment over that at the least force; with 1.1 the fold is missed on 48 cells.
AHEAD: Final = 1.2
# Radius of the grid's disc over that of the largest contact, which may be slightly larger on cells.
MARGIN: Final = 1.05
# Depth steps per critical elongation, and tolerance of the depth at pull-off over it. Half as many steps change
# pull-off forces by 0.1 %.
STEPS: Final = 40
FOLD: Final = 2e-3
# Ratio of the radii after and before a depth step below which the contact is lost; with 0.5 pull-offs are the same.
COLLAPSE: Final = 0.7
# Largest relative error of the displacement under the contact; ten times of it changes pull-off forces by 0.3 %.
TOLERANCE: Final = 1e-3
# Error of the position of the edge in cells; over the contact radius it is the least error estimate.
LAG: Final = 2.0
NAMES: Final = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")


class CellState(NamedTuple):
    """State of the grid: cells in contact and p/E*, shape (m, m), and depth in cell sizes."""

    contact: BoolArray
    pressure: FloatArray
    depth: float


@dataclass(frozen=True)
class CellGrid:
    """An adhering indenter on one grid, whose disc is at least as large as the largest contact.

    Attributes:
        scene: Layer, indenter and adhesion.
        radius: Radius of the grid's disc [m].
        cells: Number of cells across the grid.
        threads: Number of threads of the transforms.
    """

    scene: Scene
    radius: float
    cells: int
    threads: int

    @property
    def size(self) -> float:
        """Side s of a cell [m]."""
        return self.radius / disc_of(self.cells).radius

    @property
    def strength(self) -> float:
        """Strength of a cell over E*, tau_c/E*."""
        return sqrt(adhesive_length(self.scene) / (CELL_ENERGY * self.size))

    @cached_property
    def _operator(self) -> GridOperator:
        return grid_operator(self.scene.layer, self.size, self.cells, threads=self.threads)

    def _solve(self, contact: BoolArray, target: FloatArray | float, start: FloatArray | None = None) -> FloatArray:
        return pressed(self._operator, contact, target, TOLERANCE, start)

    @cached_property
    def height(self) -> FloatArray:
        """f at the cell centres in cell sizes, shape (m, m)."""
        within = np.minimum(self.radius * disc_of(self.cells).centres, self.scene.indenter.max_radius)
        return np.asarray(self.scene.indenter.height(within) / self.size)

    @cached_property
    def _flat(self) -> FloatArray:
        return self._solve(disc_of(self.cells).contact, 1.0)

    @cached_property
    def first(self) -> CellState:
        """The whole disc at the depth at which its first cell detaches; on each cell p is linear in the depth."""
        contact = disc_of(self.cells).contact
        rim, risen = _rim(contact), self._solve(contact, self.height)
        depth = float(np.max((risen[rim] - self.strength) / self._flat[rim]))
        return CellState(contact, depth * self._flat - risen, depth)

    def settled(self, state: CellState, depth: float, least: float = COLLAPSE) -> CellState | None:
        """Equilibrium at a depth after cells detach; None if the contact shrinks below `least` times its radius."""
        contact, pressure = state.contact, state.pressure
        while np.count_nonzero(contact) > least**2 * np.count_nonzero(state.contact):
            pressure = self._solve(contact, depth - self.height, pressure)
            leaving = _rim(contact) & (pressure < -self.strength)
            if not leaving.any():
                return CellState(contact, pressure, depth)
            contact = contact & ~leaving
        return None

    def unloaded(self) -> FloatArray:
        """`row` of stable states at decreasing depth, to pull-off under displacement control, shape (3, n)."""
        elongation = self.strength / float(self._flat[_rim(self.first.contact)].max())
        states, step = [self.first], elongation / STEPS
        while step > FOLD * elongation:
            after = self.settled(states[-1], states[-1].depth - step)
            if after is None:
                step /= 4.0
            else:
                states.append(after)
        return np.array([self.row(state) for state in states]).T

    def followed(self, depths: FloatArray) -> FloatArray:
        """`row` at depths [m] in their order, from out of contact; zero without contact, shape (4, n)."""
        state: CellState | None = None
        rows = np.zeros((depths.size, 4))
        for i, depth in enumerate((depths / self.size).tolist()):
            before = state if state is not None and depth < state.depth else self.first
            state = self.settled(before, depth, 0.0) if state is not None or depth >= 0.0 else None
            if state is not None:
                rows[i] = *self.row(state), self.stiffness(state)
        return rows.T

    def row(self, state: CellState) -> tuple[float, float, float]:
        """Radius of the circle with the area of the contact [m], depth [m] and force [N]."""
        share = np.count_nonzero(state.contact) / np.count_nonzero(disc_of(self.cells).contact)
        force = 4.0 * contact_modulus(self.scene.layer) * self.size**2 * float(state.pressure.sum())
        return self.radius * sqrt(share), state.depth * self.size, force

    def stiffness(self, state: CellState) -> float:
        """Contact stiffness k_N [N/m] of the cells in contact."""
        return 4.0 * contact_modulus(self.scene.layer) * self.size * float(self._solve(state.contact, 1.0).sum())


def solve_cells(scene: Scene, points: int, threads: int, settings: dict[str, Any]) -> ContactPath | DetachmentPath:
    """Contacts at given depths, or a detachment up to pull-off, with error estimates from half as many cells."""
    log, is_detachment = StageLog(), isinstance(scene.loading, Detachment)
    radius = _largest(scene, Pressing(scene.layer, scene.indenter, FIRST_CELLS, threads=threads))
    refuse_unresolved(scene.layer, scene.indenter, radius, points)
    fine, coarse = (CellGrid(scene, radius, cells, threads) for cells in (points, points // 2))
    with log.stage("adhesion"):
        numbers = (_detachment if is_detachment else _path)(fine, coarse)
    numbers |= {"cost": log.cost(unknowns=points**2 // 4), "stages": log.records}
    return (DetachmentPath if is_detachment else ContactPath)(scene=scene, method="bem", settings=settings, **numbers)


def _path(fine: CellGrid, coarse: CellGrid) -> dict[str, Any]:
    """Arguments of `ContactPath` at the given depths, with errors from the coarse grid."""
    depths = fine.scene.loading.values  # type: ignore[attr-defined]
    values, others = (dict(zip(NAMES, grid.followed(depths), strict=True)) for grid in (fine, coarse))
    errors = {name: _errors(values[name], others[name], fine.size / fine.radius) for name in NAMES}
    values["indentation_depth"], errors["indentation_depth"] = depths, np.zeros(depths.size)
    return values | {"error_estimate": errors, "notes": ("depths are followed in their order, from out of contact",)}


def _detachment(fine: CellGrid, coarse: CellGrid) -> dict[str, Any]:
    """Arguments of `DetachmentPath`, with errors from the coarse grid."""
    columns, other = fine.unloaded(), coarse.unloaded()
    radius, lag, least = columns[0], fine.size / columns[0], int(columns[2].argmin())
    near = [np.interp(radius, other[0][::-1], row[::-1]) for row in other]
    errors = {name: _errors(row, two, lag) for name, row, two in zip(NAMES, columns, near, strict=False)}
    by_force = fine.scene.loading.controlled == "force"  # type: ignore[attr-defined]
    scalars, others = (_pull_off(rows, by_force=by_force) for rows in (columns, other))
    for name, value in scalars.items():
        # At a fold depth and force are stationary, so the error of the radius is the root of their error.
        flat = 0.0 if name == "pull_off_force" else 2.0 * sqrt(FOLD)
        errors[name] = _errors(np.array([value]), np.array([others[name]]), lag[:1] + flat / LAG)
    states = [dict(zip(NAMES, column, strict=False)) for column in columns.T.tolist()]
    points = {"force": states[least], "displacement": states[-1]}
    return scalars | {
        **dict(zip(NAMES, columns, strict=False)),
        "stable_displacement_control": np.ones(radius.size, dtype=np.bool_),
        "stable_force_control": np.arange(radius.size) <= least,
        "critical_points": tuple(CriticalPoint(control=c, kind="pull-off", **point) for c, point in points.items()),
        "error_estimate": errors,
        "notes": ("only the branch that is stable under displacement control is followed",),
    }


def _errors(value: FloatArray, coarse: FloatArray, lag: FloatArray | float) -> FloatArray:
    """Error estimates over the largest magnitude of the values; `lag` is the cell size over the contact radius."""
    return stated_error(value, coarse, scale=np.abs(value).max(), floor=LAG * np.asarray(lag))


def _largest(scene: Scene, pressing: Pressing) -> float:
    """Radius [m] of the largest contact, by discs: at the largest depth, or where a detachment starts."""
    loading, indenter = scene.loading, scene.indenter
    end = largest_radius(scene, pressing)
    if isinstance(indenter, FlatPunch) or getattr(loading, "initial_contact_radius", None):
        return end
    branch = AdheringIndenter.up_to(scene, pressing, end, NODES // 2).branch
    if isinstance(loading, Detachment):
        lost, _, _ = branch.state(branch.loss(FORCE, branch.end))
        return min(AHEAD * lost + 0.1 * indenter.flat_radius, indenter.max_radius)
    return min(MARGIN * branch.widest(DEPTH, max(float(loading.values.max()), 0.0)), end)  # type: ignore[attr-defined]


def _pull_off(columns: FloatArray, *, by_force: bool) -> dict[str, float]:
    """Radius [m], depth [m] and force [N] at pull-off by name, from those of a path, shape (3, n)."""
    names = ("pull_off_contact_radius", "pull_off_depth", "force_at_loss")
    lost = columns[:, int(columns[2].argmin()) if by_force else -1]
    return dict(zip(names, lost.tolist(), strict=True)) | {"pull_off_force": float(columns[2].min())}


def _rim(contact: BoolArray) -> BoolArray:
    """Cells of a quadrant's contact with a neighbour outside; its lower edges are mirrors, its upper ones are not."""
    padded = np.pad(np.pad(contact, ((1, 0), (1, 0)), mode="edge"), ((0, 1), (0, 1)))
    surrounded = padded[:-2, 1:-1] & padded[2:, 1:-1] & padded[1:-1, :-2] & padded[1:-1, 2:]
    return np.asarray(contact & ~surrounded)

"""Adhesion on a grid whose cells let go at a stress that depends on their size (Pohrt and Popov 2015).

At the edge of an adhering contact the stress is singular, so no fixed strength can be a criterion. Let a square cell of
size s carry the uniform stress tau. Relaxing it releases the elastic energy that this stress holds in a half-space,

    U = (1/2) int tau u dA = kappa tau^2 s^3/E*,
    kappa = (1/2 pi) int int dA dA'/|r - r'| = (2/3 pi) [1 - sqrt 2 + (3/2) ln((sqrt 2 + 1)/(sqrt 2 - 1))] = 0.473201,

over a unit square. The cell lets go when this pays for the new surface, U = dgamma s^2, at the tension

    tau_c = sqrt(E* dgamma/(kappa s)).

Close to its edge a layer responds like the half-space, so the constant serves layers whose cells are small against the
thickness. At each depth all cells of the rim beyond tau_c let go and the pressure is solved anew, until none is left.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import log, pi, sqrt
from typing import Final, NamedTuple

import numpy as np

from bem.branch import DEPTH, FORCE
from bem.grid.adhering import NODES, AdheringIndenter, adhesive_length, largest_radius
from bem.grid.discs import disc_of, refuse_unresolved
from bem.grid.operators import grid_operator, pressed
from bem.grid.pressed import FIRST_CELLS, Pressing
from bem.kernels.moduli import contact_modulus
from contact import (
    ContactPath,
    CriticalPoint,
    Detachment,
    DetachmentPath,
    FlatPunch,
    Scene,
    StageLog,
)
from contact.answer.solution import Setting
from contact.records.validation import BoolArray, FloatArray

# kappa, derived above.
CELL_ENERGY: Final = 2.0 / (3.0 * pi) * (1.0 - sqrt(2.0) + 1.5 * log((sqrt(2.0) + 1.0) / (sqrt(2.0) - 1.0)))
# Radius at the start of a detachment over that of the least force.
AHEAD: Final = 1.2
# Radius of the grid's disc over that of the largest contact, which may be a little wider on the cells.
ROOM: Final = 1.05
# Depth steps per critical elongation, and the part of it to which the depth of pull-off is found.
STEPS: Final = 40
FOLD: Final = 2e-3
# A contact that shrinks below this part of its radius at one depth is past the fold, below `LOST` it has let go.
COLLAPSE: Final = 0.7
LOST: Final = 0.1
# A path under force control ends when its tension has fallen to this part of its largest.
PAST_LEAST_FORCE: Final = 0.85
# Largest error of the displacement under the contact; ten times it moves pull-off forces by 0.3 %.
TOLERANCE: Final = 1e-3
# Times the difference to half as many cells, which is of about first order, and cells by which the rim may lag.
SAFETY: Final = 2.0
LAG: Final = 2.0


class CellState(NamedTuple):
    """Cells in contact, p/E* on them, and the depth in cell sizes."""

    contact: BoolArray
    pressure: FloatArray
    depth: float


@dataclass(frozen=True)
class CellGrid:
    """An adhering indenter above one grid, whose disc has the largest contact radius.

    Attributes:
        scene: Layer, indenter and adhesion.
        radius: Of the disc [m].
        cells: Across the grid.
        threads: Of the transforms.
    """

    scene: Scene
    radius: float
    cells: int
    threads: int

    @property
    def size(self) -> float:
        """s [m]."""
        return self.radius / disc_of(self.cells).radius

    @property
    def strength(self) -> float:
        """tau_c/E*."""
        return sqrt(adhesive_length(self.scene) / (CELL_ENERGY * self.size))

    @cached_property
    def _solve(self) -> Callable[[BoolArray, FloatArray | float, FloatArray | None], FloatArray]:
        operator = grid_operator(self.scene.layer, self.size, self.cells, threads=self.threads)
        return lambda contact, target, start: pressed(operator, contact, target, TOLERANCE, start)

    @cached_property
    def height(self) -> FloatArray:
        """f in cell sizes."""
        indenter = self.scene.indenter
        return np.asarray(
            indenter.height(np.minimum(self.radius * disc_of(self.cells).centres, indenter.max_radius)) / self.size
        )

    @cached_property
    def first(self) -> CellState:
        """The whole disc, at the depth at which its first cell lets go: p is linear in the depth, cell by cell."""
        contact = disc_of(self.cells).contact
        flat, risen = (self._solve(contact, target, None) for target in (1.0, self.height))
        rim = _rim(contact)
        depth = float(np.max((risen[rim] - self.strength) / flat[rim]))
        return CellState(contact, depth * flat - risen, depth)

    def settled(self, state: CellState, depth: float, least: float = COLLAPSE) -> CellState | None:
        """Equilibrium at a depth, by letting go; None if the contact shrinks below `least` times its radius."""
        contact, pressure = state.contact, state.pressure
        while np.count_nonzero(contact) > least**2 * np.count_nonzero(state.contact):
            pressure = self._solve(contact, depth - self.height, pressure)
            leaving = _rim(contact) & (pressure < -self.strength)
            if not leaving.any():
                return CellState(contact, pressure, depth)
            contact = contact & ~leaving
        return None

    def unloaded(self, *, to_least_force: bool) -> list[CellState]:
        """Stable states at decreasing depth, to pull-off or until the tension has passed its largest."""
        flat = self._solve(self.first.contact, 1.0, None)
        elongation = self.strength / float(flat[_rim(self.first.contact)].max())
        states, step = [self.first], elongation / STEPS
        while step > FOLD * elongation:
            forces = [self.force(state) for state in states]
            if to_least_force and forces[-1] > PAST_LEAST_FORCE * min(forces) > min(forces):
                break
            after = self.settled(states[-1], states[-1].depth - step)
            if after is None:
                step /= 4.0
                # A contact that jumps may come to rest at a smaller radius.
                after = (
                    self.settled(states[-1], states[-1].depth - 4.0 * step, LOST) if step <= FOLD * elongation else None
                )
                step = elongation / STEPS if after is not None else step
            states += [after] if after is not None else []
        return states

    def radius_of(self, state: CellState) -> float:
        """a [m] of a circle with the area of the contact, as the disc has its own."""
        return self.radius * sqrt(np.count_nonzero(state.contact) / np.count_nonzero(disc_of(self.cells).contact))

    def force(self, state: CellState) -> float:
        """F_N [N]."""
        return 4.0 * contact_modulus(self.scene.layer) * self.size**2 * float(state.pressure.sum())

    def columns(self, states: list[CellState]) -> FloatArray:
        """Radius, depth and force, shape (3, n)."""
        return np.array([[self.radius_of(one), one.depth * self.size, self.force(one)] for one in states]).T


@dataclass(frozen=True)
class AdheringCells:
    """A scene on a grid and on half as many cells.

    Attributes:
        scene: An adhesive scene.
        points: Cells of the fine grid.
        threads: Of the transforms.
        settings: Of the method, for the answer.
        log: Stage log.
    """

    scene: Scene
    points: int
    threads: int
    settings: dict[str, Setting]
    log: StageLog

    def solve(self) -> ContactPath | DetachmentPath:
        """Contacts at given depths, or a detachment from a contact radius to pull-off."""
        return self._detachment() if isinstance(self.scene.loading, Detachment) else self._path()

    def _grids(self, radius: float) -> tuple[CellGrid, CellGrid]:
        refuse_unresolved(self.scene.layer, self.scene.indenter, radius, self.points)
        fine, coarse = (CellGrid(self.scene, radius, cells, self.threads) for cells in (self.points, self.points // 2))
        return fine, coarse

    def _pressing(self) -> Pressing:
        return Pressing(self.scene.layer, self.scene.indenter, FIRST_CELLS, threads=self.threads)

    def _path(self) -> ContactPath:
        """From out of contact; at each depth the largest contact, or what is left of the one before."""
        depths = self.scene.loading.values  # type: ignore[attr-defined]
        most = max(float(depths.max()), 0.0)
        end = largest_radius(self.scene, self._pressing(), DEPTH, most)
        found = AdheringIndenter.up_to(self.scene, self._pressing(), end, NODES // 2).branch.solutions(DEPTH, most)
        grids = self._grids(min(ROOM * found[-1], end) if found else end)
        (radius, force), (other_radius, other_force) = (_followed(grid, depths) for grid in grids)
        lag = LAG * grids[0].size / max(float(radius.max()), grids[0].size)
        held = AdheringIndenter.up_to(self.scene, self._pressing(), grids[0].radius, NODES // 2)
        largest = max(float(np.abs(force).max()), np.finfo(float).tiny)
        moved = SAFETY * np.abs(radius - other_radius) / max(float(radius.max()), grids[0].size) + lag
        return ContactPath(
            scene=self.scene,
            method="bem",
            settings=self.settings,
            cost=self.log.cost(unknowns=self.points**2 // 4),
            notes=("depths are followed in their order, from out of contact",),
            contact_radius=radius,
            indentation_depth=depths,
            normal_force=force,
            contact_stiffness=np.array([held.stiffness(np.array([a]))[0] if a > 0.0 else 0.0 for a in radius]),
            error_estimate={
                "contact_radius": moved,
                "indentation_depth": np.zeros(radius.size),
                "contact_stiffness": 4.0 * moved,
                "normal_force": SAFETY * np.abs(force - other_force) / largest + lag,
            },
        )

    def _detachment(self) -> DetachmentPath:
        loading = self.scene.loading
        assert isinstance(loading, Detachment)
        by_force = loading.controlled == "force"
        grids = self._grids(loading.initial_contact_radius or self._start())
        columns, other = (grid.columns(grid.unloaded(to_least_force=by_force)) for grid in grids)
        (scalars, points), (others, _) = (_pull_off(values, by_force=by_force) for values in (columns, other))
        lag = LAG * grids[0].size / columns[0]
        errors = {"contact_radius": SAFETY * lag}
        for name, values, coarse in zip(("indentation_depth", "normal_force"), columns[1:], other[1:], strict=True):
            near = np.interp(columns[0], other[0][::-1], coarse[::-1])
            errors[name] = SAFETY * np.abs(near - values) / np.abs(values).max() + lag
        for name, value in scalars.items():
            # At a fold depth and force are stationary, so that the radius is known to the root of their error.
            flat = 0.0 if name == "pull_off_force" else 2.0 * sqrt(FOLD)
            errors[name] = np.array([SAFETY * abs(others[name] / value - 1.0) + 3.0 * lag[0] + flat])
        n, least = columns.shape[1], int(columns[2].argmin())
        return DetachmentPath(
            scene=self.scene,
            method="bem",
            settings=self.settings,
            cost=self.log.cost(unknowns=self.points**2 // 4),
            notes=("only the branch that is stable under displacement control is followed",),
            contact_radius=columns[0],
            indentation_depth=columns[1],
            normal_force=columns[2],
            stable_displacement_control=np.ones(n, dtype=np.bool_),
            stable_force_control=np.arange(n) <= least,
            critical_points=points,
            error_estimate=errors,
            pull_off_force=scalars["pull_off_force"],
            pull_off_depth=scalars["pull_off_depth"],
            pull_off_contact_radius=scalars["pull_off_contact_radius"],
            force_at_loss=scalars["force_at_loss"],
        )

    def _start(self) -> float:
        """Radius [m] of a punch, or ahead of the strongest tension by discs."""
        indenter = self.scene.indenter
        if isinstance(indenter, FlatPunch):
            return indenter.radius
        end = largest_radius(self.scene, self._pressing(), FORCE, None)
        branch = AdheringIndenter.up_to(self.scene, self._pressing(), end, NODES // 2).branch
        return min(AHEAD * branch.loss(FORCE, end) + 0.1 * indenter.flat_radius, indenter.max_radius)


def _followed(grid: CellGrid, depths: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Radius and force at depths in their order."""
    held: CellState | None = None
    found = np.zeros((2, depths.size))
    for i, depth in enumerate((depths / grid.size).tolist()):
        before = held if held is not None and depth < held.depth else grid.first
        held = grid.settled(before, depth, LOST) if held is not None or depth >= 0.0 else None
        if held is not None:
            found[:, i] = grid.radius_of(held), grid.force(held)
    return found[0], found[1]


def _pull_off(columns: FloatArray, *, by_force: bool) -> tuple[dict[str, float], tuple[CriticalPoint, ...]]:
    """Numbers of the pull-off, and its place under both controls."""
    least, last = int(columns[2].argmin()), columns.shape[1] - 1
    radius, depth, force = columns[:, least if by_force else last].tolist()
    names = ("contact_radius", "indentation_depth", "normal_force")
    points = tuple(
        CriticalPoint(control=control, kind="pull-off", **dict(zip(names, columns[:, i].tolist(), strict=True)))
        for control, i in (("force", least), ("displacement", last))
    )
    numbers = {"pull_off_force": float(columns[2].min()), "pull_off_depth": depth}
    return numbers | {"pull_off_contact_radius": radius, "force_at_loss": force}, points


def _rim(contact: BoolArray) -> BoolArray:
    """Cells of a quadrant's contact with a neighbour outside; its lower edges are mirrors, its upper ones are not."""
    padded = np.pad(np.pad(contact, ((1, 0), (1, 0)), mode="edge"), ((0, 1), (0, 1)))
    surrounded = padded[:-2, 1:-1] & padded[2:, 1:-1] & padded[1:-1, :-2] & padded[1:-1, 2:]
    return np.asarray(contact & ~surrounded)

"""Adhering contacts that let go cell by cell, as paths: where they start, their grid, stability and errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from bem.adhesion.branch import DiscBranch, long_enough
from bem.adhesion.cell_by_cell.indenter import FOLD, LOST, AdheringIndenter, AdheringState, strength
from bem.adhesion.equilibrium_branch import DEPTH, FORCE
from bem.grid.calibrated_disc import FILL, disc, measured_disc
from bem.grid.error_model import CELLS
from bem.grid.operators import FreeSpaceOperator
from bem.grid.quadrant import COARSE_CELLS, QuadrantGrid
from contact import Adhesion, CriticalPoint, Detachment, FlatPunch, Scene, StageLog
from contact.records.validation import BoolArray, FloatArray

# Radius at the start of a detachment over that of the least force. A smaller one would resolve that force better still.
AHEAD: Final = 1.2
# Radius of the grid's disc over that of the largest contact.
ROOM: Final = 1.05
PULL_OFF: Final = {"indentation_depth": "pull_off_depth", "contact_radius": "pull_off_contact_radius"}


@dataclass(frozen=True, eq=False)
class CellBranch:
    """Stable states at decreasing depth.

    Attributes:
        contact_radius: a [m], shape (n,).
        indentation_depth: delta [m], shape (n,).
        normal_force: F_N [N], shape (n,).
        cell_size: s [m].
    """

    contact_radius: FloatArray
    indentation_depth: FloatArray
    normal_force: FloatArray
    cell_size: float

    @property
    def least_force(self) -> int:
        """Index of the least force: where a force-controlled indenter pulls off."""
        return int(np.argmin(self.normal_force))

    def pull_off(self, control: str) -> int:
        """Index of the last state that is stable under this control."""
        return self.least_force if control == "force" else len(self.normal_force) - 1

    def critical_points(self) -> tuple[CriticalPoint, ...]:
        """Pull-off under either control, as far as the path goes."""
        return tuple(
            CriticalPoint(
                control=control,
                kind="pull-off",
                contact_radius=float(self.contact_radius[self.pull_off(control)]),
                indentation_depth=float(self.indentation_depth[self.pull_off(control)]),
                normal_force=float(self.normal_force[self.pull_off(control)]),
            )
            for control in ("force", "displacement")
        )


def detachment_branch(
    scene: Scene, start_radius: float, cells: int, threads: int, log: StageLog, *, to_least_force: bool = False
) -> CellBranch:
    """The stable branch from a contact radius to pull-off, or to just beyond the least force, on one grid."""
    indenter, first = _on_grid(scene, start_radius, cells, threads, log)
    settled = None if isinstance(scene.indenter, FlatPunch) else indenter.settle(first, first.indentation_depth)
    start = first if settled is None else settled
    enough = indenter.is_past_least_force if to_least_force else lambda _: False
    states = indenter.unload(start, enough)
    return CellBranch(
        contact_radius=np.array([indenter.contact_radius(state) for state in states]),
        indentation_depth=np.array([state.indentation_depth for state in states]),
        normal_force=np.array([indenter.normal_force(state) for state in states]),
        cell_size=indenter.grid.cell_size,
    )


@dataclass(frozen=True)
class CellHistory:
    """Given depths followed cell by cell on one grid, from out of contact.

    Attributes:
        contact_radius: a [m], zero where there is no contact, shape (n,).
        normal_force: F_N [N], shape (n,).
        cell_size: s [m].
    """

    contact_radius: FloatArray
    normal_force: FloatArray
    cell_size: float

    @classmethod
    def of_depths(cls, scene: Scene, depths: FloatArray, cells: int, threads: int, log: StageLog) -> CellHistory:
        """Snap-in at the first touch, the same contact as long as it holds, and nothing beyond pull-off."""
        indenter, first = _on_grid(scene, _radius_at(scene, depths, threads), cells, threads, log)
        held: AdheringState | None = None
        radius, force = np.zeros(depths.size), np.zeros(depths.size)
        for i, depth in enumerate(depths.tolist()):
            held = _next(indenter, first, held, depth)
            if held is not None:
                radius[i], force[i] = indenter.contact_radius(held), indenter.normal_force(held)
        return cls(radius, force, indenter.grid.cell_size)

    def errors(self, coarse: CellHistory) -> dict[str, FloatArray]:
        """Differences of two grids and the cell by which the rim may lag, relative to the largest magnitudes."""
        radius, force = self.contact_radius, self.normal_force
        lag = CELLS.lag * self.cell_size / np.maximum(np.max(radius), self.cell_size) * (radius > 0.0)
        shrunk = np.abs(radius - coarse.contact_radius) / max(float(np.max(radius)), self.cell_size) + lag
        largest = float(np.max(np.abs(force))) or 1.0
        return {
            "indentation_depth": np.zeros(radius.size),
            "contact_radius": shrunk,
            "contact_stiffness": CELLS.largest_exponent * shrunk,
            "normal_force": np.abs(force - coarse.normal_force) / largest + lag,
        }


def _next(
    indenter: AdheringIndenter, first: AdheringState, held: AdheringState | None, depth: float
) -> AdheringState | None:
    """The contact at the next depth; `first` covers all cells that may ever touch."""
    if held is None:
        return indenter.settle(first, depth, LOST) if depth >= 0.0 else None
    if depth < held.indentation_depth:
        return indenter.settle(held, depth, LOST)
    return indenter.load(held, np.array([depth]), first.contact)[-1]


def _radius_at(scene: Scene, depths: FloatArray, threads: int) -> float:
    """A contact radius [m] beyond that of the largest depth."""
    if isinstance(scene.indenter, FlatPunch):
        return scene.indenter.radius
    largest = max(float(depths.max()), 0.0)

    def enough(branch: DiscBranch) -> bool:
        return bool(branch.depth(np.array([branch.largest_radius]))[0] > largest)

    longest = long_enough(scene, threads, enough)
    found = DiscBranch.up_to(longest, scene, COARSE_CELLS, threads).crossing(
        DEPTH, largest, (scene.indenter.flat_radius, longest), inmost=False
    )
    return min(ROOM * found if found is not None else longest, scene.indenter.max_radius)


def start_radius(scene: Scene, threads: int) -> float:
    """Where cells begin to let go [m]: the punch's radius, the one prescribed, or ahead of the least force."""
    prescribed = _detachment(scene).initial_contact_radius
    if isinstance(scene.indenter, FlatPunch):
        return scene.indenter.radius
    if prescribed is not None:
        return prescribed
    radius = long_enough(scene, threads, lambda branch: least_force(branch) < branch.largest_radius / AHEAD)
    found = least_force(DiscBranch.up_to(radius, scene, COARSE_CELLS, threads))
    return min(max(AHEAD * found, found + scene.indenter.flat_radius / 10.0), scene.indenter.max_radius)


def least_force(branch: DiscBranch) -> float:
    """The radius [m] of the strongest tension."""
    route = branch.route(branch.largest_radius)
    return route.state(route.loss(FORCE))[0]


def branch_errors(fine: CellBranch, coarse: CellBranch, control: str) -> dict[str, FloatArray | float]:
    """Differences of two grids at equal contact radii, relative to the largest magnitude on the path."""
    cell = fine.cell_size / fine.contact_radius
    errors: dict[str, FloatArray | float] = {
        "contact_radius": (CELLS.area_scatter + 1.0)
        * fine.cell_size
        / fine.contact_radius[0]
        * np.ones(len(fine.contact_radius))
    }
    order = np.argsort(coarse.contact_radius)
    for name in ("indentation_depth", "normal_force"):
        values, other = getattr(fine, name), getattr(coarse, name)
        same_radius = np.interp(fine.contact_radius, coarse.contact_radius[order], other[order])
        errors[name] = np.abs(same_radius - values) / np.max(np.abs(values)) + CELLS.lag * cell
    i, j = fine.pull_off(control), coarse.pull_off(control)
    force, other_force = fine.normal_force[fine.least_force], coarse.normal_force[coarse.least_force]
    force_error = float(abs(other_force / force - 1.0) + CELLS.lag * cell[fine.least_force])
    errors["pull_off_force"] = force_error
    for name in ("indentation_depth", "contact_radius"):
        values, reached = getattr(fine, name), getattr(coarse, name)[j]
        spread = _spread(values, fine.normal_force, force_error) if control == "force" else FOLD
        errors[PULL_OFF[name]] = abs(reached / values[i] - 1.0) + CELLS.lag * cell[i] + spread
    lost, other_lost = fine.normal_force[i], coarse.normal_force[j]
    errors["force_at_loss"] = abs(other_lost / lost - 1.0) + CELLS.lag * cell[i] + (FOLD if control != "force" else 0.0)
    return errors


def _spread(values: FloatArray, force: FloatArray, force_error: float) -> float:
    """Relative range of a quantity over the states whose force is least within its error: the minimum is flat."""
    least = int(np.argmin(force))
    near = values[force <= force[least] * (1.0 - force_error)]
    return float(np.max(np.abs(near / values[least] - 1.0)))


def stable_under_force(branch: CellBranch) -> BoolArray:
    """Under force control the branch is stable up to its least force."""
    return np.arange(len(branch.normal_force)) <= branch.least_force


def _on_grid(
    scene: Scene, radius: float, cells: int, threads: int, log: StageLog
) -> tuple[AdheringIndenter, AdheringState]:
    """The indenter on a grid that a disc of this radius fills, and that contact as it begins to let go."""
    # A disc of cells acts as a punch of this radius, in cell sizes.
    measured = measured_disc(cells, False).radius
    grid = QuadrantGrid(cells, radius / measured)
    adhesion = scene.effect(Adhesion)
    work = adhesion.work_of_adhesion if adhesion is not None else 0.0
    operator = FreeSpaceOperator(scene.layer, cell_size=grid.cell_size, cells=cells, quarter=True, threads=threads)
    contact = disc(cells, FILL * cells / 2)
    height = np.zeros(contact.shape) if isinstance(scene.indenter, FlatPunch) else _finite_height(scene, grid)
    tension = strength(scene.layer.contact_modulus, work, grid.cell_size)
    indenter = AdheringIndenter(operator, grid, height, tension, log)
    return indenter, indenter.first_state(contact)


def _finite_height(scene: Scene, grid: QuadrantGrid) -> FloatArray:
    height = scene.indenter.height(grid.radius)
    return np.where(np.isfinite(height), height, np.max(height[np.isfinite(height)]))


def _detachment(scene: Scene) -> Detachment:
    if not isinstance(scene.loading, Detachment):
        raise TypeError(f"a detachment was expected, got {type(scene.loading).__name__}")
    return scene.loading

"""Boundary elements for shapes: the answer for the mean profile on discs, times a ratio on cells of any outline."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from bem.grid.discs import refuse_unresolved
from bem.grid.pressed import Prescribed, PressedState, Pressing, equilibrium
from bem.grid.shapes import CellContact, pressed_cells
from bem.kernels.moduli import contact_modulus
from contact import ContactPath, IndentationDepths, NotConvergedError, Profile, Scene, Shape, StageLog
from contact.records.validation import FloatArray
from contact.scene.shapes import LARGEST_ORDER, Flat, Raised
from contact.stated import SAFETY, stated_error

# Relative step of the depth for the derivative of the ratio, whose error falls with its square. Half of it shows cells.
STEP: Final = 0.1
# Tolerance of the relative change of the ratio under a prescribed force, and largest number of steps.
CLOSE, MOST_STEPS = 1e-9, 12
# Relative error of the ratio that two grids may share, times (cells across)^(3/2).
SHARED: Final = 0.5
# Relative error of the contact radius, from the number of cells in contact, that two grids may share, times (cells
# across)^(3/2). At half of it one scene of twenty is not covered.
COUNTED: Final = 2.0
# Number of angles, and radii over the outline, at which pressures of two grids are compared.
ANGLES, INSIDE = 64, np.array([0.1, 0.3, 0.5, 0.7, 0.9])


@dataclass(frozen=True, eq=False)
class ShapeState:
    """A contact of a shape.

    Attributes:
        cells: Contact on the grid, at this depth, or at unit depth of a flat punch.
        cell_size: Side s of a cell [m].
        depth: Indentation depth delta [m].
        load: Force over E*, F/E* [m^2].
        stiffness: Contact stiffness over E*, k_N/E* [m].
        square: Fourier coefficients of a(phi)^2 [m^2], of the orders 0, N, 2 N, ..
        shape: The indenter.
    """

    cells: CellContact
    cell_size: float
    depth: float
    load: float
    stiffness: float
    square: FloatArray
    shape: Shape

    def outline(self, angle: ArrayLike) -> FloatArray:
        """a(phi) [m], for a flat punch the outline of the punch."""
        if isinstance(self.shape, Flat):
            return self.shape.outline(angle)
        cosines = np.cos(np.multiply.outer(np.asarray(angle), _cosines(self.shape)))
        return np.asarray(np.sqrt(cosines @ self.square))

    @property
    def radius(self) -> float:
        """Mean radius of the outline [m]."""
        angle, weight = self.shape.sector()
        return float(weight @ self.outline(angle))

    def pressure(self, radius: FloatArray, angle: FloatArray) -> FloatArray:
        """p/E* at radii [m] and angles, interpolated between the centres of cells and scaled to the load."""
        scale, r = self.load / (self.cells.load * self.cell_size**2), radius / self.cell_size
        values = self.cells.pressure_at(r * np.cos(angle), r * np.sin(angle))
        return np.where(radius < self.outline(angle), scale * values, 0.0)


def _cosines(shape: Shape) -> range:
    """Orders of the outline: 0 and all that the symmetry of the shape allows."""
    return range(0, LARGEST_ORDER + 1, shape.symmetry)


@dataclass(frozen=True, eq=False)
class OutlinedFields:
    """Outline and pressure of every step of a path.

    Attributes:
        states: Contact of each step.
        modulus: Contact modulus E* [Pa].
    """

    states: Sequence[ShapeState]
    modulus: float

    def outline(self, angle: FloatArray, step: int) -> FloatArray:
        """Outline a(phi) of the contact at one step [m]."""
        return self.states[step].outline(angle)

    def pressure(self, radius: FloatArray, step: int, angle: FloatArray) -> FloatArray:
        """Pressure p(r, phi) at one step [Pa]."""
        return self.modulus * self.states[step].pressure(radius, angle)


@dataclass(frozen=True)
class ShapeSolver:
    """Solver of one scene on two grids; the coarser one gives error estimates.

    Attributes:
        scene: The scene.
        points: Cells across the mean contact.
        threads: Number of threads of the transforms.
        settings: Settings that the answer reports.
        log: Stage log.
    """

    scene: Scene
    points: int
    threads: int
    settings: dict[str, Any]
    log: StageLog

    def path(self) -> ContactPath:
        """Contacts at the prescribed depths or forces."""
        loading, modulus = self.scene.loading, contact_modulus(self.scene.layer)
        by_depth = isinstance(loading, IndentationDepths)
        values = (loading.values / (1.0 if by_depth else modulus)).tolist()  # type: ignore[attr-defined]
        with self.log.stage("contact"):
            fine, coarse = (
                self._states(values, points, by_depth=by_depth) for points in (self.points, self.points // 2)
            )
        units = np.array([1.0, 1.0, modulus, modulus])
        rows, others = (
            units[:, None] * np.array([(state.radius, state.depth, state.load, state.stiffness) for state in states]).T
            for states in (fine, coarse)
        )
        return ContactPath(
            scene=self.scene,
            method="bem",
            settings=self.settings,
            error_estimate=self._errors(rows, others, list(zip(fine, coarse, strict=True)), by_depth=by_depth),
            cost=self.log.cost(unknowns=fine[0].cells.radius.size),
            stages=self.log.records,
            fields=OutlinedFields(fine, modulus),
            **dict(zip(ContactPath.ARRAYS, rows, strict=True)),
        )

    def _states(self, values: Sequence[float], points: int, *, by_depth: bool) -> list[ShapeState]:
        """Contacts at depths [m] or forces over E* [m^2]."""
        shape = self.scene.indenter
        if isinstance(shape, Flat):
            stiffness, cells, s = self._flat(shape, points)
            stiffness = 2.0 * stiffness - self._flat(shape, points // 2)[0]  # cells miss the edge to first order
            depths = [value if by_depth else value / stiffness for value in values]
            return [ShapeState(cells, s, d, stiffness * d, stiffness, np.zeros(0), shape) for d in depths]
        assert isinstance(shape, Raised)
        return [self._raised(shape, points, value, by_depth=by_depth) for value in values]

    def _flat(self, shape: Flat, points: int) -> tuple[float, CellContact, float]:
        """k_N/E* [m] of a flat punch, its cells at unit depth in units of E*/s, and s [m].

        k_N is that of the circle of the mean radius times the ratio of both on the same cells, corrected for errors of
        their areas.
        """
        layer, circle = self.scene.layer, shape.mean
        a, (angle, weight) = circle.radius, shape.sector()
        side = float(shape.outline(0.0))
        s = side / round(side * points / (2.0 * a))  # straight sides lie between cells
        refuse_unresolved(layer, circle, a, points)
        punches = Pressing(layer, circle, points, threads=self.threads).punches(a)
        power = 0.5 * (1.0 + punches.growth_slope / punches.growth)  # d(ln k)/d(ln area)
        loads, cells = [], []
        for indenter, square in ((shape, float(weight @ shape.outline(angle) ** 2)), (circle, a * a)):
            cells.append(self._cells(indenter, s, s, a))
            loads.append(cells[-1].load * (pi * square / (cells[-1].moment(0) * s * s)) ** power)
        return 2.0 * a * punches.growth * loads[0] / loads[1], cells[0], s

    def _raised(self, shape: Raised, points: int, value: float, *, by_depth: bool) -> ShapeState:
        """Contact of a raised shape at a depth [m] or a force over E* [m^2]."""
        pressing = Pressing(self.scene.layer, shape.mean, points, threads=self.threads)
        prescribed: Prescribed = "indentation_depth" if by_depth else "normal_force"
        s, ratio, near = 0.0, 1.0, None
        for _ in range(MOST_STEPS):
            mean, _, near = equilibrium(pressing, prescribed, value if by_depth else value / ratio, near)
            s = s or 2.0 * mean.radius / points
            shaped, round_ = self._pair(shape, s, mean)
            before, ratio = ratio, shaped.load / round_.load
            if by_depth or abs(ratio / before - 1.0) < CLOSE:
                break
        else:
            raise NotConvergedError("the depth under a force was not found on cells")
        refuse_unresolved(pressing.layer, shape.mean, mean.radius, points)
        # The ratio varies so little with the depth that cells twice as wide suffice.
        low, high = (self._pair(shape, 2.0 * s, mean._replace(depth=mean.depth * (1.0 + e))) for e in (-STEP, STEP))
        change = (high[0].load / high[1].load - low[0].load / low[1].load) / (2.0 * STEP * mean.depth)
        moments = np.array([shaped.moment(n) - round_.moment(n) for n in _cosines(shape)]) * s * s / pi
        square = np.append(moments[0], 2.0 * moments[1:])
        square[0] += mean.radius**2
        load = mean.load * ratio if by_depth else value
        stiffness = mean.stiffness * ratio + mean.load * change
        return ShapeState(shaped, s, mean.depth, load, stiffness, square, shape)

    def _pair(self, shape: Raised, cell_size: float, mean: PressedState) -> tuple[CellContact, CellContact]:
        """Contacts of the shape and of its mean profile on the same cells."""
        shaped, round_ = (self._cells(indenter, mean.depth, cell_size, mean.radius) for indenter in (shape, shape.mean))
        return shaped, round_

    def _cells(self, indenter: Profile, depth: float, cell_size: float, radius: float) -> CellContact:
        """Contact of an indenter on cells at a depth [m]; `radius` [m] is a first guess."""
        shape = self.scene.indenter
        assert isinstance(shape, Shape)
        whole, flat = shape.symmetry % 2 == 1, isinstance(shape, Flat)
        return pressed_cells(
            self.scene.layer, indenter, depth, radius, cell_size, whole=whole, threads=self.threads, flat=flat
        )

    def _errors(
        self, rows: FloatArray, others: FloatArray, pairs: list[tuple[ShapeState, ShapeState]], *, by_depth: bool
    ) -> dict[str, FloatArray]:
        """Relative error estimates, zero of the prescribed quantity."""
        floors = self.points**-1.5 * np.array([COUNTED, SHARED, SHARED, SHARED])
        errors = {
            name: stated_error(row, other, scale=row, floor=floor, sequence=False)
            for name, row, other, floor in zip(ContactPath.ARRAYS, rows, others, floors, strict=True)
        }
        if isinstance(self.scene.indenter, Flat):
            errors["contact_radius"] = np.zeros(rows.shape[1])
        errors["indentation_depth" if by_depth else "normal_force"] = np.zeros(rows.shape[1])
        shared = errors["normal_force"] + errors["indentation_depth"]
        return errors | {"pressure": SAFETY * np.array([_pressure_change(*pair) for pair in pairs]) + shared}


def _pressure_change(fine: ShapeState, coarse: ShapeState) -> float:
    """Largest change of pressures over their mean between two grids."""
    angle = np.linspace(0.0, 2.0 * pi, ANGLES)[:, None]
    radius = INSIDE * fine.outline(angle)
    change = fine.pressure(radius, angle) - coarse.pressure(radius, angle)
    return float(np.abs(change).max()) * pi * fine.radius**2 / fine.load

"""A smooth indenter pressed into a layer on one grid, and the prescription of depth, force or radius."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import log
from typing import Final, Literal

import numpy as np

from bem.conjugate_gradients import Equilibrium, solve_contact
from bem.contact_edge import ContactRadius, area_radius, contact_radius
from bem.grid import Grid, first_radius, grid_sequence, prolonged
from bem.operators import FreeSpaceOperator, Operator, PeriodicOperator
from contact import InvalidInput, Layer, NotConvergedError, Profile, StageLog
from contact.validation import FloatArray

Boundary = Literal["free", "periodic"]
Prescribed = Literal["radius", "depth", "force"]

COARSE_CELLS: Final = 64
FIRST_BOX: Final = (
    1.0973  # over the radius where f equals the depth; no round number: no cell centre lies on that radius
)
FILL: Final = 0.88  # contact radius over half the box
IMAGE_GAP: Final = 16.0  # thicknesses between periodic images: exp(-0.739 * 16) = 7e-6
RADIUS_TOLERANCE: Final = 1e-6  # relative, of a prescribed contact radius, besides its scatter


@dataclass(frozen=True, eq=False)
class PressedState:
    """One equilibrium on one grid.

    Attributes:
        grid: Where it was computed.
        equilibrium: Pressure, displacement, depth.
        contact_radius: a [m], see `contact_edge`.
        radius_scatter: How far that may be off for want of cells [m].
        normal_force: F_N [N].
    """

    grid: Grid
    equilibrium: Equilibrium
    contact_radius: float
    radius_scatter: float
    normal_force: float

    @property
    def indentation_depth(self) -> float:
        """delta [m]."""
        return self.equilibrium.indentation_depth


@dataclass(frozen=True)
class Press:
    """What is pressed into what, how it is discretised, and the log of what was done.

    Attributes:
        layer: The layer.
        indenter: A profile that is no flat punch.
        boundary: "free" or "periodic".
        tolerance: Of the complementarity problem.
        threads: Of FFTW.
        log: Stage log.
    """

    layer: Layer
    indenter: Profile
    boundary: Boundary
    tolerance: float
    threads: int
    log: StageLog

    def reach(self, prescribed: Prescribed, value: float, points: int) -> tuple[PressedState, PressedState]:
        """The equilibria with the prescribed depth, force or radius on `points` cells and on half as many.

        Each grid starts from the answer of the one before; the first box is found on a coarse grid.
        """
        guess = self._locate(prescribed, value)
        radius = value if prescribed == "radius" else guess.contact_radius
        states: list[PressedState] = []
        start: FloatArray | None = None
        depth = guess.indentation_depth
        for cells in grid_sequence(points):
            grid = self._grid(radius, cells)
            with self.log.stage("operator"):
                operator = self._operator(grid, self.boundary)
            with self.log.stage("contact"):
                if prescribed == "depth":
                    state = self._solve(operator, grid, depth=value, start=start)
                elif prescribed == "force":
                    state = self._solve(operator, grid, force=value, start=start)
                else:
                    state = self._at_radius(operator, grid, value, depth, start)
            states.append(state)
            depth, start = state.indentation_depth, prolonged(state.equilibrium.pressure)
        return states[-1], states[-2]

    def _at_radius(
        self, operator: Operator, grid: Grid, radius: float, depth: float, start: FloatArray | None
    ) -> PressedState:
        """Secant iteration in ln(depth) over ln(a): delta grows like a power of a."""
        exponent = 1.5  # between 1 and 2 for all pointed profiles; corrected as soon as there are two points
        state = self._solve(operator, grid, depth=depth, start=start)
        for _ in range(8):
            miss = log(radius / state.contact_radius)
            if abs(miss) <= RADIUS_TOLERANCE + state.radius_scatter / radius:
                return state
            step = float(np.clip(exponent * miss, -0.3, 0.3))
            depth *= np.exp(step)
            after = self._solve(operator, grid, depth=depth, start=state.equilibrium.pressure)
            moved = log(after.contact_radius / state.contact_radius)
            if step * moved > 0.0:
                exponent = float(np.clip(step / moved, 0.2, 20.0))
            state = after
        raise NotConvergedError("the prescribed contact radius was not met; use more points", {"radius": abs(miss)})

    def _locate(self, prescribed: Prescribed, value: float) -> PressedState:
        """A coarse equilibrium near the one wanted: bisection in the radius where f equals the depth."""
        measure: dict[Prescribed, Callable[[PressedState], float]] = {
            "depth": lambda state: state.indentation_depth,
            "force": lambda state: state.normal_force,
            "radius": lambda state: state.contact_radius,
        }
        with self.log.stage("first_guess"):
            if prescribed == "depth":
                return self._coarse(value)
            depth = self._depth_scale(value) if prescribed == "radius" else self._depth_of_force(value)
            return self._coarse_root(measure[prescribed], value, depth)

    def _coarse_root(self, measure: Callable[[PressedState], float], value: float, depth: float) -> PressedState:
        """Secant in logarithms on the coarse grid, within 1 %."""
        exponent, state = 1.0, self._coarse(depth)
        for _ in range(40):
            miss = log(value / measure(state))
            if abs(miss) < 0.01:
                return state
            step = float(np.clip(exponent * miss, -2.0, 2.0))
            depth *= float(np.exp(step))
            after = self._coarse(depth)
            moved = log(measure(after) / measure(state))
            if step * moved > 0.0:
                exponent = float(np.clip(step / moved, 0.1, 10.0))
            state = after
        raise NotConvergedError("no first guess of the contact was found", {"miss": miss})

    def _coarse(self, depth: float) -> PressedState:
        """Equilibrium on a coarse grid whose box grows until the contact lies inside."""
        radius = FIRST_BOX * self._geometric_radius(depth)
        for _ in range(40):
            grid = self._grid(radius, COARSE_CELLS, "free")
            thin = self.layer.thickness < 2.0 * grid.cell_size
            operator = self._operator(grid, "periodic" if thin else "free")
            try:
                equilibrium = solve_contact(operator, self._height(grid), depth=depth, tolerance=1e-4)
            except NotConvergedError:  # a box that is all contact may have no equilibrium (bonded, nu = 1/2)
                radius *= 1.3
                continue
            reached = area_radius(equilibrium.pressure, grid.cell_size)
            if reached < 0.97 * grid.cell_size * COARSE_CELLS / 2:
                return self._state(grid, equilibrium, ContactRadius(reached, grid.cell_size))
            radius *= 1.3
        raise NotConvergedError(f"the contact at a depth of {depth:g} m outgrew every box")

    def _solve(
        self,
        operator: Operator,
        grid: Grid,
        *,
        depth: float | None = None,
        force: float | None = None,
        start: FloatArray | None = None,
    ) -> PressedState:
        load = None if force is None else force / (4.0 * grid.cell_size**2)
        answer = solve_contact(
            operator, self._height(grid), depth=depth, load=load, start=start, tolerance=self.tolerance
        )
        self.log.count("iterations", answer.iterations)
        a = contact_radius(
            answer.pressure,
            grid.radius,
            grid.cell_size,
            smooth_beyond=self._last_kink(answer, grid),
            thickness=self.layer.thickness,
        )
        self._check_inside(answer, grid, a.value)
        return self._state(grid, answer, a)

    def _state(self, grid: Grid, answer: Equilibrium, radius: ContactRadius) -> PressedState:
        force = 4.0 * grid.cell_size**2 * float(answer.pressure.sum())
        return PressedState(grid, answer, radius.value, radius.scatter, force)

    def _check_inside(self, answer: Equilibrium, grid: Grid, radius: float) -> None:
        """The contact is one circle that ends within the indenter and the box."""
        if radius > self.indenter.max_radius - grid.cell_size:
            raise InvalidInput(f"the contact reaches the end of the indenter at {self.indenter.max_radius:g} m")
        outermost = float(np.max(grid.radius[answer.pressure > 0.0]))
        if abs(outermost - radius) > 4.0 * grid.cell_size:
            raise NotConvergedError(
                f"the contact is not one circle: cells to {outermost:g} m, area of a radius of {radius:g} m"
            )

    def _last_kink(self, answer: Equilibrium, grid: Grid) -> float:
        reached = area_radius(answer.pressure, grid.cell_size)
        inside = [kink for kink in self.indenter.kinks if kink < reached - 3.0 * grid.cell_size]
        return max([0.0, *inside])

    def _height(self, grid: Grid) -> FloatArray:
        """f at the cell centres [m]; beyond the indenter's end far above the layer."""
        height = self.indenter.height(grid.radius)
        finite = np.isfinite(height)
        return np.where(finite, height, 1e3 * np.max(height[finite]))

    def _grid(self, radius: float, cells: int, boundary: Boundary | None = None) -> Grid:
        gap = IMAGE_GAP * self.layer.thickness if (boundary or self.boundary) == "periodic" else 0.0
        return Grid(cells, max(2.0 * radius / FILL, 2.0 * radius + gap) / cells)

    def _operator(self, grid: Grid, boundary: Boundary) -> Operator:
        kind = PeriodicOperator if boundary == "periodic" else FreeSpaceOperator
        return kind(self.layer, cell_size=grid.cell_size, cells=grid.cells, quarter=True, threads=self.threads)

    def _geometric_radius(self, depth: float) -> float:
        """Where f equals the depth [m]."""
        reached = first_radius(lambda r: self._depth_scale(r) >= depth, self.indenter.max_radius)
        return max(reached, self.indenter.flat_radius)

    def _depth_scale(self, radius: float) -> float:
        """f at the contact radius: the depth of a thin layer, and of the right size for any."""
        return float(self.indenter.height(np.array([radius]))[0])

    def _depth_of_force(self, force: float) -> float:
        """The depth at which 2 E* r f(r) equals the force, r the radius where f equals the depth."""
        stiffness = 2.0 * self.layer.contact_modulus
        radius = first_radius(lambda r: stiffness * r * self._depth_scale(r) >= force, self.indenter.max_radius)
        return self._depth_scale(radius * (1.0 - 1e-12))

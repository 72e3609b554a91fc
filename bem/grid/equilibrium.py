"""A smooth indenter pressed into a layer on one grid, and the prescription of depth, force or radius."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import ceil, copysign, exp, log, log2
from typing import Final, Literal, NamedTuple

import numpy as np

from bem.grid.calibrated_disc import FILL as DISC_FILL
from bem.grid.conjugate_gradients import GridSolution, solve_contact
from bem.grid.contact_edge import STEP, WIDER, StepExcess, area_radius, excess_on_half_space, slope, told_excess
from bem.grid.error_model import DIRECT
from bem.grid.flat_punch import StiffnessNearby, contact_stiffness, radius_of_stiffness, stiffness_exponent
from bem.grid.operators import FreeSpaceOperator, Operator, PeriodicOperator
from bem.grid.quadrant import COARSE_CELLS, QuadrantGrid, grid_sequence, prolonged, refuse_thin_layer
from bem.kernels.moduli import contact_modulus
from contact import ElasticLayer, InvalidInput, NotConvergedError, Profile, StageLog, UnsupportedSceneError
from contact.records.validation import FloatArray
from contact.scene.extent import radius_of_depth, radius_of_load

Boundary = Literal["free", "periodic"]
Prescribed = Literal["radius", "depth", "force"]

# Tolerance of the complementarity problem on the coarse grids of first guesses.
COARSE_TOLERANCE: Final = 1e-5
# The first coarse box holds a contact of this times the radius where f equals the depth. Not round on purpose: a cell
# centre exactly on that radius would let rounding decide whether it touches.
FIRST_BOX: Final = 1.0973
# Tolerance of the states beside a contact over the scatter that is stated for their slope: the radius then lost less
# than a tenth of that scatter (12 contacts on 128 and 256 cells, 2026-11-22).
BESIDE_SHARE: Final = 0.05
# Contact radius over half the box, and its largest value in a coarse box, which leaves room for a deeper contact.
FILL: Final = 0.88
LARGEST_FILL: Final = 0.92
# Thicknesses between periodic images, which act on each other by exp(-0.739 * 16) = 7e-6.
IMAGE_GAP: Final = 16.0
# Least number of cells across the flat punch behind k_N: its own error is then below 1e-5 for a < 5 h.
STIFFNESS_CELLS: Final = 256
# Cells that the layer under that punch is thick, if the grid has as many.
STIFFNESS_LAYER: Final = 2.0
# A layer thinner than so many cells is refused: every wavenumber of the grid then sees the same limit of thin layers.
LEAST_LAYER: Final = 1.0
# Secant iterations take one last step when ln(k_N) is missed by less than this, since they converge faster than
# linearly.
CLOSE: Final = 1e-3
# First guesses are good enough when the logarithm of stiffness or force is missed by less than this.
NEAR: Final = 3e-2
# Changes of that logarithm below this are the grid's noise and do not update the secant's exponent.
NOISE: Final = 5e-3
# A contact that spans fewer cells in its radius is refused.
LEAST_RADIUS: Final = 3.0
# From so many cells inside the edge on, every cell of one full circle is pressed.
RAGGED: Final = 2.0
# Least d ln(k_N)/d ln(depth) that the bend of force over depth may tell: that of a truncated cone whose edge lies half
# a percent outside its rim, where a - b goes with the square of the depth.
LEAST_GROWTH: Final = 0.01
# The indenter is continued beyond its end by its slope over this last part of its radius.
END_SHARE: Final = 0.02


@dataclass(frozen=True, eq=False)
class Beside:
    """Pressures [Pa] a little less deep and a little deeper, between which the slope of force over depth is taken."""

    less: FloatArray
    more: FloatArray

    def prolonged(self) -> Beside:
        """On a grid of half the cell size."""
        return Beside(prolonged(self.less), prolonged(self.more))


class SlopeExcess(NamedTuple):
    """What the step of a slope makes of it, and what the wider step tells besides.

    Attributes:
        taken: Relative error of the slope that is taken off it.
        left: How much of it may be left.
        depth_growth: d ln(depth)/d ln(k_N).
    """

    taken: float = 0.0
    left: float = 0.0
    depth_growth: float = 1.0


@dataclass(frozen=True, eq=False)
class IndenterOnGrid:
    """An indenter above a layer on one grid.

    Attributes:
        operator: K.
        grid: The quadrant.
        height: f at the cell centres [m].
        tolerance: Of the complementarity problem.
        log: Stage log; counts the iterations.
    """

    operator: Operator
    grid: QuadrantGrid
    height: FloatArray
    tolerance: float
    log: StageLog

    def at_depth(self, depth: float, start: FloatArray | None) -> GridSolution:
        """Under a depth [m]."""
        return self._counted(
            solve_contact(self.operator, self.height, depth=depth, start=start, tolerance=self.tolerance)
        )

    def under_force(self, force: float, start: FloatArray | None) -> GridSolution:
        """Under a force [N]."""
        load = force / (4.0 * self.grid.cell_size**2)
        return self._counted(
            solve_contact(self.operator, self.height, load=load, start=start, tolerance=self.tolerance)
        )

    def force(self, state: GridSolution) -> float:
        """F_N [N]; the quadrant stands for four."""
        return 4.0 * self.grid.cell_size**2 * float(state.pressure.sum())

    def beside(self, state: GridSolution, start: Beside | None = None, step: float = STEP) -> Beside:
        """A little less deep and a little deeper than this state, from other such states or from this one."""
        depth, p = state.indentation_depth, state.pressure
        scatter = DIRECT.scatter(self.grid.cell_size / area_radius(state.pressure, self.grid.cell_size))
        on_grid = replace(self, tolerance=max(self.tolerance, BESIDE_SHARE * scatter))
        less = on_grid.at_depth(depth * exp(-step), start.less if start else p).pressure
        more = on_grid.at_depth(depth * exp(step), start.more if start else np.maximum(2.0 * p - less, 0.0))
        return Beside(less, more.pressure)

    def stiffness(self, state: GridSolution, beside: Beside, step: float = STEP) -> float:
        """dF/d(delta) [N/m] about this state."""
        cells = 4.0 * self.grid.cell_size**2
        less, more = cells * float(beside.less.sum()), cells * float(beside.more.sum())
        return slope(state.indentation_depth, self.force(state), less, more, step)

    def slope_excess(self, state: GridSolution, near: Beside, alike: StepExcess, ratio: float) -> SlopeExcess:
        """Of the slope by its step: that of the half-space, and what a wider step tells of the layer's difference.

        Args:
            state: The equilibrium.
            near: The states beside it.
            alike: Of the same profile on the half-space.
            ratio: a/h.
        """
        p = state.pressure
        start = Beside(*(np.maximum(p + WIDER * (other - p), 0.0) for other in (near.less, near.more)))
        far = self.beside(state, start, WIDER * STEP)
        told = told_excess(self.stiffness(state, near), self.stiffness(state, far, WIDER * STEP)) - alike.told
        noise = DIRECT.excess_noise * (self.grid.cell_size / area_radius(p, self.grid.cell_size)) ** 3
        # What the cells may have made of it is left in, and counts as an error.
        layer = copysign(max(abs(told) - noise / (WIDER**2 - 1.0), 0.0), told)
        left = DIRECT.excess_share * abs(layer) + abs(told - layer)
        left += DIRECT.excess_rest * min(ratio, 0.5) * abs(alike.own - alike.told)
        return SlopeExcess(alike.own + layer, left, self.depth_growth(state, far, WIDER * STEP))

    def depth_growth(self, state: GridSolution, beside: Beside, step: float) -> float:
        """d ln(depth)/d ln(k_N) from the curvature of ln(force) over ln(depth)."""
        less, here, more = (log(float(p.sum())) for p in (beside.less, state.pressure, beside.more))
        rise, bend = (more - less) / (2.0 * step), (more - 2.0 * here + less) / step**2
        return 1.0 / max(rise - 1.0 + bend / rise, LEAST_GROWTH)

    def _counted(self, answer: GridSolution) -> GridSolution:
        self.log.count("iterations", answer.iterations)
        return answer


@dataclass(frozen=True, eq=False)
class CircularContact:
    """One equilibrium on one grid.

    Attributes:
        grid: Where it was computed.
        equilibrium: Pressure, displacement, depth.
        contact_radius: a [m], see `contact_edge`.
        radius_scatter: How far that may be off for want of cells [m].
        normal_force: F_N [N].
        contact_stiffness: dF/d(delta) [N/m].
        stiffness_exponent: Bound of d ln(k_N)/d ln(a).
        depth_exponent: Bound of d ln(delta)/d ln(a).
    """

    grid: QuadrantGrid
    equilibrium: GridSolution
    contact_radius: float
    radius_scatter: float
    normal_force: float
    contact_stiffness: float
    stiffness_exponent: float
    depth_exponent: float

    @property
    def indentation_depth(self) -> float:
        """delta [m]."""
        return self.equilibrium.indentation_depth

    @property
    def force_exponent(self) -> float:
        """Bound of d ln(F_N)/d ln(a), since dF_N = k_N d(delta)."""
        return self.depth_exponent * self.contact_stiffness * self.indentation_depth / self.normal_force


@dataclass(frozen=True)
class GridContactSearch:
    """What is pressed into what, how it is discretised, and the log of what was done.

    Attributes:
        layer: The layer.
        indenter: A profile that is no flat punch.
        boundary: "free" or "periodic".
        tolerance: Of the complementarity problem.
        threads: Of the transforms.
        log: Stage log.
    """

    layer: ElasticLayer
    indenter: Profile
    boundary: Boundary
    tolerance: float
    threads: int
    log: StageLog

    def reach(self, prescribed: Prescribed, value: float, points: int) -> tuple[CircularContact, CircularContact]:
        """The equilibria with the prescribed depth, force or radius on `points` cells and on half as many.

        Raises:
            Unresolved: If the layer is thinner than a cell.
        """
        reach = self._reach_radius if prescribed == "radius" else self._reach_depth_or_force
        fine, coarse = reach(prescribed, value, points)
        cell = max(fine.grid.cell_size, self._punch_cell(points, fine.contact_radius))
        refuse_thin_layer(self.layer, cell, LEAST_LAYER)
        return fine, coarse

    def _reach_depth_or_force(
        self, prescribed: Prescribed, value: float, points: int
    ) -> tuple[CircularContact, CircularContact]:
        """Each grid starts from the answer of the one before; the first box is found on a coarse grid."""
        with self.log.stage("first_guess"):
            guess = self._near_force(value) if prescribed == "force" else self._coarse(value)
        radius = area_radius(guess.answer.pressure, guess.on_grid.grid.cell_size)
        start: FloatArray | None = None
        beside: Beside | None = None
        known: StiffnessNearby | None = None
        states: list[CircularContact] = []
        box, excess = radius, SlopeExcess()
        for cells in grid_sequence(points):
            on_grid = self._on_grid(box, cells)
            with self.log.stage("contact"):
                solve = on_grid.at_depth if prescribed == "depth" else on_grid.under_force
                answer = solve(value, start)
            start = prolonged(answer.pressure)
            if cells < points // 2:
                continue
            with self.log.stage("contact_stiffness"):
                beside = on_grid.beside(answer, beside)
                if cells == points // 2:
                    excess = self._slope_excess(on_grid, answer, beside)
                stiffness = on_grid.stiffness(answer, beside) / (1.0 + excess.taken)
                beside = beside.prolonged()
                radius, known = self._radius(stiffness, radius, cells, known)
            states.append(self._state(on_grid, answer, radius, stiffness, excess))
        return states[1], states[0]

    def _reach_radius(self, _: Prescribed, radius: float, points: int) -> tuple[CircularContact, CircularContact]:
        """The depth at which the contact is as stiff as the flat punch of this radius, Eq. (5)."""
        with self.log.stage("contact_stiffness"):
            stiffness = contact_stiffness(self.layer, radius, self._punch_cells(points, radius))
        with self.log.stage("first_guess"):
            guess, exponent = self._coarse_root(FirstGuess.stiffness, stiffness, self._depth_scale(radius))
        depth, start, beside, excess = guess.answer.indentation_depth, None, None, SlopeExcess()
        states: list[CircularContact] = []
        for cells in grid_sequence(points):
            on_grid = self._on_grid(radius, cells)
            with self.log.stage("contact"):
                answer, beside, exponent = self._as_stiff(
                    on_grid, stiffness * (1.0 + excess.taken), on_grid.at_depth(depth, start), beside, exponent
                )
                if cells == points // 2:
                    excess = self._slope_excess(on_grid, answer, on_grid.beside(answer, beside))
                    deeper = answer.indentation_depth * (1.0 + excess.taken) ** exponent
                    answer = on_grid.at_depth(deeper, answer.pressure)
            depth, start, beside = answer.indentation_depth, prolonged(answer.pressure), beside.prolonged()
            states.append(self._state(on_grid, answer, radius, stiffness, excess))
        with self.log.stage("contact_stiffness"):
            coarse = contact_stiffness(self.layer, radius, self._punch_cells(points, radius) // 2)
        return states[-1], replace(states[-2], contact_stiffness=coarse)

    def _as_stiff(
        self, on_grid: IndenterOnGrid, stiffness: float, answer: GridSolution, start: Beside | None, exponent: float
    ) -> tuple[GridSolution, Beside, float]:
        """Secant method in ln(depth) over ln(k_N), which grows like a power of the depth; and that power's inverse."""
        beside = on_grid.beside(answer, start)
        miss = log(stiffness / on_grid.stiffness(answer, beside))
        for _ in range(12):
            step = float(np.clip(exponent * miss, -0.5, 0.5))
            answer = on_grid.at_depth(answer.indentation_depth * exp(step), answer.pressure)
            if abs(miss) < CLOSE:
                return answer, beside, exponent
            beside = on_grid.beside(answer, beside)
            before, miss = miss, log(stiffness / on_grid.stiffness(answer, beside))
            exponent = _updated(exponent, step, before - miss)
        raise NotConvergedError(
            "the prescribed contact radius was not met; use more points or prescribe depths", {"stiffness": abs(miss)}
        )

    def _near_force(self, force: float) -> FirstGuess:
        """A coarse equilibrium near the force wanted."""
        return self._coarse_root(FirstGuess.force, force, self._depth_of_force(force))[0]

    def _coarse_root(
        self, measure: Callable[[FirstGuess], float], value: float, depth: float
    ) -> tuple[FirstGuess, float]:
        """Secant in logarithms on coarse grids, within 3 %; and the exponent of the depth over what is measured."""
        exponent, state = 1.0, self._coarse(depth)
        miss = log(value / measure(state))
        for _ in range(40):
            if abs(miss) < NEAR:
                return state, exponent
            step = float(np.clip(exponent * miss, -2.0, 2.0))
            depth *= exp(step)
            state = self._coarse(depth)
            before, miss = miss, log(value / measure(state))
            exponent = _updated(exponent, step, before - miss)
        raise NotConvergedError("no first guess of the contact was found", {"miss": miss})

    def _coarse(self, depth: float) -> FirstGuess:
        """Equilibrium on a coarse grid whose box grows until the contact lies well inside."""
        radius = FIRST_BOX * self._geometric_radius(depth)
        for _ in range(40):
            thin = self.layer.is_uniform and self.layer.thickness < 4.0 * radius / COARSE_CELLS
            on_grid = self._on_grid(radius, COARSE_CELLS, "periodic" if thin else "free", COARSE_TOLERANCE)
            try:
                answer = on_grid.at_depth(depth, None)
            except NotConvergedError:
                # A box that is all contact may have no equilibrium (bonded, nu = 1/2).
                radius *= 1.3
                continue
            if (
                area_radius(answer.pressure, on_grid.grid.cell_size)
                < LARGEST_FILL * on_grid.grid.cell_size * COARSE_CELLS / 2
            ):
                return FirstGuess(on_grid, answer)
            radius *= 1.3
        raise NotConvergedError(f"the contact at a depth of {depth:g} m outgrew every box")

    def _radius(
        self, stiffness: float, near: float, cells: int, known: StiffnessNearby | None
    ) -> tuple[float, StiffnessNearby]:
        """That of the flat punch that is as stiff."""
        return radius_of_stiffness(self.layer, stiffness, near, self._punch_cells(cells, near), known)

    def _state(
        self, on_grid: IndenterOnGrid, answer: GridSolution, radius: float, stiffness: float, excess: SlopeExcess
    ) -> CircularContact:
        self._check_inside(answer, on_grid.grid, radius)
        if radius < LEAST_RADIUS * on_grid.grid.cell_size:
            raise InvalidInput(
                f"a contact of radius {radius:g} m spans too few of the {on_grid.grid.cells} cells of its box; "
                'take more points, or boundary="free"'
            )
        punch_cell = self._punch_cell(on_grid.grid.cells, radius)
        scatter = (
            DIRECT.scatter(on_grid.grid.cell_size / radius) * radius
            + DIRECT.thin_scatter * punch_cell * (punch_cell / self.layer.surface.thickness) ** 2
            + excess.left * radius
        )
        exponent = stiffness_exponent(radius / self.layer.thickness)
        return CircularContact(
            grid=on_grid.grid,
            equilibrium=answer,
            contact_radius=radius,
            radius_scatter=scatter,
            normal_force=on_grid.force(answer),
            contact_stiffness=stiffness,
            stiffness_exponent=exponent,
            depth_exponent=exponent * excess.depth_growth,
        )

    def _slope_excess(self, on_grid: IndenterOnGrid, answer: GridSolution, beside: Beside) -> SlopeExcess:
        """Of the slope by its step."""
        radius = area_radius(answer.pressure, on_grid.grid.cell_size)
        alike = excess_on_half_space(self.indenter, radius)
        return on_grid.slope_excess(answer, beside, alike, radius / self.layer.thickness)

    def _punch_cells(self, cells: int, radius: float) -> int:
        """Cells of the flat punch behind k_N."""
        thin = 2.0 * STIFFNESS_LAYER / DISC_FILL * radius / self.layer.surface.thickness
        return min(cells, 1 << ceil(log2(max(STIFFNESS_CELLS, thin))))

    def _punch_cell(self, cells: int, radius: float) -> float:
        """Their size [m]."""
        return 2.0 * radius / (DISC_FILL * self._punch_cells(cells, radius))

    def _check_inside(self, answer: GridSolution, grid: QuadrantGrid, radius: float) -> None:
        """The contact is one full circle that ends within the indenter and the box."""
        if radius > self.indenter.max_radius:
            raise InvalidInput(f"the contact reaches the end of the indenter at {self.indenter.max_radius:g} m")
        by_area = area_radius(answer.pressure, grid.cell_size)
        pressed = answer.pressure > 0.0
        hollow = grid.radius[~pressed & (grid.radius < by_area - RAGGED * grid.cell_size)]
        if hollow.size:
            raise UnsupportedSceneError(
                f"nothing presses at r = {hollow.max():g} m within a contact of radius {radius:g} m: it is no single "
                "circle; smooth the profile or press less"
            )
        outermost = float(np.max(grid.radius[pressed]))
        if abs(outermost - by_area) > 4.0 * grid.cell_size:
            raise NotConvergedError(
                f"the contact is not one circle: cells to {outermost:g} m, area of a radius of {by_area:g} m"
            )

    def _on_grid(
        self, radius: float, cells: int, boundary: Boundary | None = None, tolerance: float | None = None
    ) -> IndenterOnGrid:
        """A grid that a contact of this radius fills well."""
        kind = boundary or self.boundary
        gap = IMAGE_GAP * self.layer.thickness if kind == "periodic" else 0.0
        grid = QuadrantGrid(cells, max(2.0 * radius / FILL, 2.0 * radius + gap) / cells)
        make = PeriodicOperator if kind == "periodic" else FreeSpaceOperator
        with self.log.stage("operator"):
            operator = make(self.layer, cell_size=grid.cell_size, cells=cells, quarter=True, threads=self.threads)
        return IndenterOnGrid(operator, grid, self._height(grid), tolerance or self.tolerance, self.log)

    def _height(self, grid: QuadrantGrid) -> FloatArray:
        """f at the cell centres [m], continued beyond the indenter's end by its last slope.

        So the stiffness of a contact that ends within the indenter is not disturbed.
        """
        end = self.indenter.max_radius
        if end >= np.max(grid.radius):
            return self.indenter.height(grid.radius)
        inner, outer = self.indenter.height(end * np.array([1.0 - END_SHARE, 1.0]))
        last_slope = (outer - inner) / (END_SHARE * end)
        beyond = np.maximum(grid.radius - end, 0.0)
        return np.asarray(self.indenter.height(np.minimum(grid.radius, end)) + last_slope * beyond)

    def _geometric_radius(self, depth: float) -> float:
        """Where f equals the depth [m]."""
        return max(radius_of_depth(self.indenter, depth), self.indenter.flat_radius)

    def _depth_scale(self, radius: float) -> float:
        """f at the contact radius: the depth of a thin layer, and of the right size for any."""
        return float(self.indenter.height(np.array([radius]))[0])

    def _depth_of_force(self, force: float) -> float:
        """The depth at which 2 E* r f(r) equals the force, r the radius where f equals the depth."""
        radius = radius_of_load(self.indenter, force / (2.0 * contact_modulus(self.layer)))
        return self._depth_scale(radius * (1.0 - 1e-12))


@dataclass(frozen=True)
class FirstGuess:
    """A first guess."""

    on_grid: IndenterOnGrid
    answer: GridSolution

    def force(self) -> float:
        """F_N [N]."""
        return self.on_grid.force(self.answer)

    def stiffness(self) -> float:
        """dF/d(delta) [N/m]."""
        return self.on_grid.stiffness(self.answer, self.on_grid.beside(self.answer))


def _updated(exponent: float, step: float, moved: float) -> float:
    """d ln(depth)/d ln(measure) from the last step, unless it is as small as the measure's noise."""
    return float(np.clip(step / moved, 0.1, 10.0)) if step * moved > 0.0 and abs(moved) > NOISE else exponent

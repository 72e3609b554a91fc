"""Discs of square cells pressed into a layer, and calibrated on the half-space.

A disc of cells is no circle, and cells do not resolve the pressure at its edge. Both errors arise within a cell or two
of the edge, where every layer responds like the half-space. So the *same cells* are pressed flat into the half-space.
The stiffness k = 2 E* a defines the effective radius a, and the pressure is the discrete counterpart of
E*/(pi sqrt(a^2 - r^2)) per unit depth. The quotient Q of the pressures on layer and half-space is smooth in r^2.

Lengths of cell fields in cell sizes, pressures in units of E*.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import ceil, sqrt
from typing import Final

import numpy as np
from numpy.polynomial import chebyshev

from bem.grid.operators import HALF_SPACE, Boundary, GridOperator, grid_operator, pressed
from bem.grid.transforms import fast_period
from contact import ElasticLayer, Profile, UnsupportedSceneError
from contact.records.validation import BoolArray, FloatArray

# Radius of the circle that contains the cells of the disc, over half the grid: its edge is a few cells inside.
FILL: Final = 0.97
# Largest error of the displacement under the disc. The error of stiffnesses is its square, that of Q ten times of it.
TOLERANCE: Final = 1e-8
# Largest degree of Q in 2 r^2/a^2 - 1; half of it misses the edge of thin layers, twice of it fits single cells.
LARGEST_DEGREE: Final = 20
# Distance from the edge, in cells, beyond which the quotient of two pressures is smooth: with 1 or 5 pressure errors
# double.
EDGE_CELLS: Final = 2.5
# Gap between periodic images over the thickness: their interaction is exp(-0.739 * 28) = 1e-9; at half of it 3e-5.
IMAGE_GAP: Final = 28.0
# Largest periodic lattice over the cells across the disc; a thicker layer needs a wider gap.
LARGEST_LATTICE: Final = 4.0
# Relative error of depth and force that two grids share, over (s/a)^2 min(a/h, 1) with the cell size s. At half of it
# one table of ten is not covered where two grids agree by accident.
SHARED: Final = 0.2
# Least thickness of a layer in cells: at half of it all wavenumbers of the grid are in the limit of thin layers.
LEAST_LAYER: Final = 1.0
# Least number of cells between the edge of the contact and an upright end, towards which the depth diverges.
END_CELLS: Final = 4.0


class Unresolved(UnsupportedSceneError):
    """Cells are too large to resolve the contact; two grids may agree nevertheless."""


@dataclass(frozen=True, eq=False)
class Disc:
    """The cells of a quadrant within a circle, pressed flat into the half-space.

    Attributes:
        cells: Cells across the grid.
        boundary: Boundary condition of operators of layers, "free" or "periodic".
        contact: Cells of the disc, shape (m, m), m = cells/2.
        pressure: p/E* under a unit depth of the half-space, same shape.
        operator: Operator of the half-space.
    """

    cells: int
    boundary: Boundary
    contact: BoolArray
    pressure: FloatArray
    operator: GridOperator

    @cached_property
    def radius(self) -> float:
        """Effective radius a in cells: k = 2 E* a on the half-space."""
        return 2.0 * float(self.pressure.sum())

    @cached_property
    def centres(self) -> FloatArray:
        """r/a of the cell centres, shape (m, m)."""
        centre = (np.arange(self.cells // 2) + 0.5) / self.radius
        return np.asarray(np.hypot(centre[:, None], centre))

    @cached_property
    def _basis(self) -> tuple[FloatArray, FloatArray]:
        """QR factors of the Chebyshev polynomials at the cells; leading sections are those of lower degrees."""
        x = np.minimum(2.0 * self.centres[self.contact] ** 2 - 1.0, 1.0)
        orthogonal, triangle = np.linalg.qr(chebyshev.chebvander(x, LARGEST_DEGREE))
        return orthogonal, triangle

    def quotient(self, pressure: FloatArray) -> FloatArray:
        """Pressure over that of the half-space under a unit depth, on the cells of the disc, shape (n,)."""
        return np.asarray(pressure[self.contact] / self.pressure[self.contact])

    def series(self, pressure: FloatArray, degree: int, edge: float | None = None) -> FloatArray:
        """Chebyshev coefficients of the quotient Q in 2 r^2/a^2 - 1, shape (degree + 1,).

        They are a least-squares fit under the constraint that the integral equals the sum of the pressure.

        Args:
            pressure: p/E* on the cells, shape (m, m).
            degree: Degree of the polynomial.
            edge: Q at the edge, as a second constraint where it is known.
        """
        orthogonal, triangle = self._basis
        n, j = degree + 1, np.arange(degree + 1)
        inverse = np.linalg.inv(triangle[:n, :n])
        fitted = inverse @ (orthogonal[:, :n].T @ self.quotient(pressure))
        # int_0^1 T_j(2 rho^2 - 1) rho/sqrt(1 - rho^2) drho, and T_j(1).
        constraints = [((-1.0) ** j / (1.0 - 4.0 * j**2), 2.0 * float(pressure.sum()) / self.radius)]
        constraints += [] if edge is None else [(np.ones(n), edge)]
        rows, values = np.array([row for row, _ in constraints]), np.array([value for _, value in constraints])
        change = inverse @ inverse.T @ rows.T
        return np.asarray(fitted + change @ np.linalg.solve(rows @ change, values - rows @ fitted))


@lru_cache(maxsize=16)
def disc_of(cells: int, boundary: Boundary = "free", threads: int = 1) -> Disc:
    """The disc of a grid of `cells` x `cells`, cached."""
    centre = np.arange(cells // 2) + 0.5
    contact = np.hypot(centre[:, None], centre) < FILL * cells / 2
    operator = grid_operator(HALF_SPACE, 1.0, cells, boundary, threads)
    return Disc(cells, boundary, contact, pressed(operator, contact, 1.0, 0.1 * TOLERANCE), operator)


def shared_error(cells: int, ratio: FloatArray, *, is_stationary: bool = False) -> FloatArray:
    """Relative error of depth and force at ratios a/h that two grids share, shape (n,).

    It falls with the square of a/h where depth and force are stationary in the radius: where one of them is prescribed,
    and at pull-off.
    """
    return np.asarray(SHARED / disc_of(cells).radius ** 2 * np.minimum(ratio, 1.0) ** (1 + is_stationary))


@dataclass(frozen=True, eq=False)
class Punch:
    """A flat punch on one disc of cells.

    Attributes:
        disc: Disc of cells.
        layer: The layer.
        threads: Number of threads of the transforms.
        radius: Contact radius a [m].
        pressure: p_1/E* under a unit depth, shape (m, m).
        growth: kappa = k_N/(2 E* a), k_bar of Eq. (10).
        degree: Degree of Q, the quotient of p_1 and the half-space's pressure; zero on the half-space.
    """

    disc: Disc
    layer: ElasticLayer
    threads: int
    radius: float
    pressure: FloatArray
    growth: float
    degree: int

    @property
    def cell_size(self) -> float:
        """Side s of a cell [m]."""
        return self.radius / self.disc.radius

    def series(self, degree: int, edge: float | None = None) -> FloatArray:
        """Chebyshev coefficients of Q in 2 r^2/a^2 - 1; `edge` prescribes phi_1 = Q(1), see `Disc.series`."""
        return self.disc.series(self.pressure, degree, edge) if self.degree else np.ones(1)

    def quotient(self, share: FloatArray) -> FloatArray:
        """Q at share = r/a."""
        return np.asarray(chebyshev.chebval(2.0 * share**2 - 1.0, self.series(self.degree)))

    def risen(self, indenter: Profile) -> FloatArray:
        """p_f/E* on the cells: pressed by the displacement f of a profile, heights in cell sizes."""
        height = indenter.height(np.minimum(self.radius * self.disc.centres, indenter.max_radius)) / self.cell_size
        operator = _operator(self.layer, self.radius, self.disc, self.threads)
        return _on_disc(self.disc, operator, np.where(self.disc.contact, height, 0.0))


@lru_cache(maxsize=16)
def punch(layer: ElasticLayer, radius: float, cells: int, boundary: Boundary = "free", threads: int = 1) -> Punch:
    """Press the disc of radius a [m] on `cells` x `cells` cells by a unit depth.

    Raises:
        Unresolved: If the periodic lattice were too large.
    """
    disc = disc_of(cells, boundary, threads)
    if layer.is_half_space:
        return Punch(disc, layer, threads, radius, disc.pressure, 1.0, 0)
    operator = _operator(layer, radius, disc, threads)
    pressure = _on_disc(disc, operator, 1.0)
    # The total is stationary at the solution in this form.
    more = operator.inverse.cells - cells // 2
    displacement = operator.displacement(np.pad(pressure, (0, more)))[: cells // 2, : cells // 2]
    growth = 2.0 * float(np.vdot(pressure, 2.0 - displacement)) / disc.radius
    # The edge layer of a thin layer is about sqrt(h/a) wide in sqrt(1 - r/a).
    degree = min(6 + ceil(1.5 * sqrt(radius / layer.thickness)), LARGEST_DEGREE)
    return Punch(disc, layer, threads, radius, pressure, growth, degree)


def _on_disc(disc: Disc, operator: GridOperator, displacement: FloatArray | float) -> FloatArray:
    """p/E* on the quadrant of the disc for a displacement in cell sizes; the operator's lattice may be larger."""
    m, more = disc.cells // 2, operator.inverse.cells - disc.cells // 2
    target = displacement if isinstance(displacement, float) else np.pad(displacement, (0, more))
    return pressed(operator, np.pad(disc.contact, (0, more)), target, TOLERANCE)[:m, :m]


@lru_cache(maxsize=2)
def _operator(layer: ElasticLayer, radius: float, disc: Disc, threads: int) -> GridOperator:
    """Operator from p/E* to the surface displacement, in cell sizes, on the cells of a disc of radius a [m] on a layer.

    In free space, or on a periodic lattice with a gap of `IMAGE_GAP` thicknesses between the images of the disc.
    """
    if layer.is_half_space:
        return disc.operator
    s = radius / disc.radius
    lattice = _lattice(layer, disc, s) if disc.boundary == "periodic" else disc.cells
    return grid_operator(layer, s, lattice, disc.boundary, threads)


def _lattice(layer: ElasticLayer, disc: Disc, cell_size: float) -> int:
    """Cells across the periodic lattice of a disc."""
    lattice = fast_period(ceil(2.0 * disc.radius + IMAGE_GAP * layer.thickness / cell_size))
    if lattice > LARGEST_LATTICE * disc.cells:
        raise Unresolved(
            f"{IMAGE_GAP:g} thicknesses between periodic images need {lattice} cells across the box, more than "
            f'{LARGEST_LATTICE:g} times points = {disc.cells}: the layer is too thick; use boundary="free"'
        )
    return lattice


def refuse_unresolved(layer: ElasticLayer, indenter: Profile, radius: float, cells: int) -> None:
    """Refuse layers thinner than `LEAST_LAYER` cells, and fewer than `END_CELLS` between the edge and an upright end.

    Raises:
        Unresolved: With the number of cells that is needed.
    """
    cell_size = radius / disc_of(cells).radius
    thick = layer.surface.thickness / cell_size
    if thick < LEAST_LAYER:
        raise Unresolved(
            f"the layer of thickness {layer.surface.thickness:g} m is {thick:.2g} cells thick and needs "
            f"{LEAST_LAYER:g}; take {LEAST_LAYER / thick:.1f} times as many points, or ask mdr or fem"
        )
    gap = (indenter.max_radius - radius) / cell_size
    if indenter.ends_upright and gap < END_CELLS:
        raise Unresolved(
            f"between the contact radius {radius:g} m and the upright end of the indenter at {indenter.max_radius:g} m "
            f"lie {gap:.2g} cells of {END_CELLS:g} that are needed; take more points, or ask mdr"
        )

"""Flat punches on square cells without the staircase error: every grid disc is measured by the half-space.

A disc of cells is not a circle, and its edge singularity is not resolved. Both act within a cell or two of the edge,
where any layer answers like the half-space. So the *same cells* are pressed into the half-space first: its exact
stiffness `k = 2 E* a` gives the disc's effective radius a, and its exact pressure `p = E* delta / (pi sqrt(a^2 - r^2))`
gives, cell by cell, what the discretisation makes of the edge singularity. A layer's stiffness is then read at a/h
with the effective radius, and its pressure from the ratio of the two computed pressures, which is a smooth function
of (r/a)^2. What is left is of second order in cell size over thickness, in place of first order.

Thick layers use the free-space operator; layers thinner than a/`THIN` the periodic one with a gap of `GAP`
thicknesses between images, whose trigonometric pressures stay accurate when cells outgrow an incompressible layer.
Either is measured by the half-space of its own discretisation.

Lengths are in cell sizes, pressures in units of E*.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from math import ceil, sqrt
from typing import Final, Self, TypeVar

import numpy as np
import numpy.typing as npt

from bem.grid.conjugate_gradients import GridSolution, solve_on_contact
from bem.grid.operators import BandLimitedHalfSpace, FreeSpaceOperator, PeriodicOperator
from bem.grid.transforms import fast_period
from contact import ElasticLayer, Layer
from contact.records.validation import BoolArray, FloatArray
from contact.scene.layer import Support

Scalar = TypeVar("Scalar", bound=np.generic)

# Ratio a/h above which the periodic operator with a gap between images is cheaper than padding by zeros.
THIN: Final = 8.0
# Thicknesses between those images. The slowest decay, bonded with nu = 1/2, makes them count by exp(-0.739 GAP) = 1e-9.
GAP: Final = 28.0
# Radius of the disc over half the grid, so that its edge stays a few cells inside.
FILL: Final = 0.97
# Largest error of the displacement under the disc; q may be off by three times that, the stiffness by its square, and
# the edge value of an adhering disc by some ten times that.
TOLERANCE: Final = 1e-10
# Largest degree of q in 2 rho^2 - 1 (`shape_degree`).
LARGEST_DEGREE: Final = 20


@dataclass(frozen=True)
class PunchSolution:
    """One flat punch in the normalisation of Eq. (10).

    Attributes:
        stiffness: k_bar.
        shape: Coefficients c_j of q(rho) = p_bar sqrt(1 - rho^2) = sum c_j T_j(2 rho^2 - 1).
        pressure: On the quadrant's cells, a start for the next solution.
        iterations: Conjugate gradient steps.
    """

    stiffness: float
    shape: FloatArray
    pressure: FloatArray
    iterations: int


@dataclass(frozen=True)
class PixelDisc:
    """The cells of a quadrant that a circular punch covers, measured by one discretisation of the half-space."""

    cells: int
    periodic: bool
    half_space: GridSolution

    @classmethod
    def measured(cls, cells: int, *, periodic: bool) -> Self:
        """Press the disc of a grid of `cells` x `cells` into the half-space."""
        contact = disc(cells, FILL * cells / 2)
        half_space = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.0)
        kind = BandLimitedHalfSpace if periodic else FreeSpaceOperator
        operator = kind(half_space, cell_size=1.0, cells=cells, quarter=True)
        return cls(cells, periodic, solve_on_contact(operator, contact, 1.0, tolerance=TOLERANCE))

    @cached_property
    def radius(self) -> float:
        """Effective radius a: the half-space's k = 2 E* a, Eq. (10) with k_bar = 1."""
        return _stiffness(self.half_space) / 2.0

    @cached_property
    def moment_error(self) -> float:
        """How far the mean square distance of two points of the pressure is off, relative to the circle's (4/3) a^2.

        A layer many cells thick answers to that distance alone, so its k_bar is off in proportion. Uniform pressures on
        the cells add the square of a cell over six; displacements are those of the cells' centres.
        """
        centre = np.arange(self.cells // 2) + 0.5
        square = np.average(centre[:, None] ** 2 + centre**2, weights=self.half_space.pressure)
        return float((2.0 * square + 1.0 / 6.0) / (4.0 / 3.0 * self.radius**2) - 1.0)

    @cached_property
    def contact(self) -> BoolArray:
        """Covered cells of the quadrant."""
        return disc(self.cells, FILL * self.cells / 2)

    def solve(
        self,
        ratio: float,
        support: Support,
        poissons_ratio: float,
        start: FloatArray | None,
        tolerance: float = TOLERANCE,
    ) -> PunchSolution:
        """Flat punch on a layer with a/h = `ratio`."""
        layer = Layer(
            thickness=self.radius / ratio,
            youngs_modulus=1.0 - poissons_ratio**2,
            poissons_ratio=poissons_ratio,
            support=support,
        )
        return self.on_layer(layer, ratio, start, tolerance)

    def on_layer(
        self, layer: ElasticLayer, ratio: float, start: FloatArray | None, tolerance: float = TOLERANCE
    ) -> PunchSolution:
        """Flat punch on a layer in this disc's units, as thick as its radius over `ratio`, with E* = 1."""
        cells = fast_period(ceil(2 * self.radius + GAP * layer.thickness)) if self.periodic else self.cells
        kind = PeriodicOperator if self.periodic else FreeSpaceOperator
        operator = kind(layer, cell_size=1.0, cells=cells, quarter=True)
        contact = _resized(self.contact, cells // 2)
        first = None if start is None else _resized(start, cells // 2)
        answer = solve_on_contact(operator, contact, 1.0, start=first, tolerance=tolerance)
        return PunchSolution(
            stiffness=_stiffness(answer) / (2.0 * self.radius),
            shape=self._shape(answer.pressure[contact], ratio),
            pressure=answer.pressure,
            iterations=answer.iterations,
        )

    def _shape(self, pressure: FloatArray, ratio: float) -> FloatArray:
        """Fit of q = (1/2) p / p_half-space, normalised to int_0^1 q rho/sqrt(1 - rho^2) d(rho) = 1/2."""
        count = shape_degree(ratio) + 1
        orthogonal, triangle = self._basis
        quotient = pressure / self.half_space.pressure[self.contact]
        shape = np.linalg.solve(triangle[:count, :count], orthogonal[:, :count].T @ quotient)
        return np.asarray(0.5 * shape / (shape @ _moments(count)))

    @cached_property
    def _basis(self) -> tuple[FloatArray, FloatArray]:
        """QR factors of the Chebyshev polynomials on the covered cells; each lower degree is a leading section."""
        centre = np.arange(self.cells // 2) + 0.5
        radius = np.hypot(centre[:, None], centre)[self.contact]
        argument = np.minimum(2.0 * (radius / self.radius) ** 2 - 1.0, 1.0)
        orthogonal, triangle = np.linalg.qr(np.polynomial.chebyshev.chebvander(argument, LARGEST_DEGREE))
        return orthogonal, triangle


@lru_cache(maxsize=8)
def measured_disc(cells: int, periodic: bool) -> PixelDisc:
    """`PixelDisc.measured`, remembered: it depends on nothing else."""
    return PixelDisc.measured(cells, periodic=periodic)


def shape_degree(ratio: float) -> int:
    """Degree of q in 2 rho^2 - 1.

    High enough for the edge layer of q, whose width in sqrt(1 - rho) is about sqrt(h/a), and low enough not to follow
    the noise of the outermost cells: measured, the error of q grows either way.
    """
    return min(6 + ceil(1.5 * sqrt(ratio)), LARGEST_DEGREE)


def disc(cells: int, radius: float) -> BoolArray:
    """Cells of the quadrant of a `cells` x `cells` grid whose centres lie within `radius` cell sizes of the axis."""
    centre = np.arange(cells // 2) + 0.5
    return np.asarray(np.hypot(centre[:, None], centre) < radius)


def _stiffness(answer: GridSolution) -> float:
    """Force over depth for unit depth: `p (2 - K p)`, stationary at the solution; four quadrants."""
    return 4.0 * float(np.vdot(answer.pressure, 2.0 - answer.displacement))


def _moments(count: int) -> FloatArray:
    """int_0^1 T_j(2 rho^2 - 1) rho/sqrt(1 - rho^2) d(rho); rho = sin(theta) makes T_j (-1)^j cos(2 j theta)."""
    j = np.arange(count)
    return (-1.0) ** j / (1.0 - 4.0 * j**2)


def _resized(field: npt.NDArray[Scalar], cells: int) -> npt.NDArray[Scalar]:
    """The quadrant cut or extended by zeros to `cells` x `cells`."""
    resized = np.zeros((cells, cells), dtype=field.dtype)
    kept = min(cells, field.shape[0])
    resized[:kept, :kept] = field[:kept, :kept]
    return resized

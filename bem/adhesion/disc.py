"""A circular adhering contact on square cells, its edge measured by the half-space.

Near the edge of an adhering contact the pressure is singular, p = (E*/pi) phi / sqrt(a^2 - r^2), and the energy that a
retreating edge sets free for each unit of area is G = E* phi^2 / (2 pi a). A grid resolves no singularity, but every
layer has the same one: so the *same cells* are pressed flat into the half-space, where phi is the depth. The quotient
of the two computed pressures is a smooth function of r^2, and its value at the edge is phi (compare
`bem.grid.calibrated_disc`).

By Griffith the edge rests where G equals the work of adhesion: phi = -sqrt(2 pi dgamma a/E*). Kendall's flat punch on
the half-space is the measure here and hence exact; other contacts are of second order in the cell size.

The quotient is needed for profiles with breakpoints only. Elsewhere, and under a graded surface, where it has
logarithms at the edge, stiffness and moment tell the edge values (`bem.adhesion.branch`): sums over all cells, which
one ring of cells is not.

The displacement f of a profile leaves in the quotient what the grid makes of its tip, its kinks and the root-like part
of the pressure. The half-space suffers the same, and its phi = g_hs(a) is an integral of the profile's slope; so on a
layer the quotient takes the difference of the two. The half-space itself is left to the grid, except for a profile with
breakpoints, which no polynomial follows: there its phi is exact by construction. Its moment, an integral of the
profile, stands in for that of the grid likewise, and what the layer adds to both is corrected by the quotient of these
two moments: a ring of few cells beyond a rim has a wrong one on the grid.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.polynomial import legendre

from bem.grid.calibrated_disc import TOLERANCE, PixelDisc, measured_disc
from bem.grid.conjugate_gradients import solve_on_contact
from bem.grid.operators import FreeSpaceOperator
from bem.grid.quadrant import EDGE_CELLS, QuadrantGrid
from bem.layer_equation.one_radius import half_space_load
from bem.layer_equation.profiles.half_space_moment import half_space_moment
from contact import ElasticLayer, Layer, Profile
from contact.records.validation import FloatArray

# The quotient is fitted up to so many cells inside the edge, but no farther than this part of the radius.
FARTHEST: Final = 20.0
LARGEST_SHARE: Final = 0.3
# Width of the ring, in cells, from which on the fitted polynomial has a third degree.
CUBIC_FROM: Final = 16.0


@dataclass(frozen=True, eq=False)
class AdheringDisc:
    """Two linear solutions on one disc: pressed flat by a unit depth, and raised to the profile.

    Attributes:
        layer: The layer.
        disc: The cells.
        grid: Their place.
        flat: p/E* [1/m] of the unit depth, on the quadrant.
        risen: p/E* [-] of the displacement f.
        measured: The same on the half-space, or zero where it is not used.
        known: phi [m] that goes with it.
        known_moment: -F_N/E* at no depth [m^2] that goes with it.
    """

    layer: ElasticLayer
    disc: PixelDisc
    grid: QuadrantGrid
    flat: FloatArray
    risen: FloatArray
    measured: FloatArray
    known: float
    known_moment: float

    @classmethod
    def solved(cls, layer: ElasticLayer, indenter: Profile, radius: float, cells: int, threads: int) -> AdheringDisc:
        """Solve both on the disc of this radius [m]."""
        disc = measured_disc(cells, False)
        grid = QuadrantGrid(cells, radius / disc.radius)
        operator = FreeSpaceOperator(layer, cell_size=grid.cell_size, cells=cells, quarter=True, threads=threads)
        height = np.where(disc.contact, indenter.height(np.minimum(grid.radius, indenter.max_radius)), 0.0)
        flat, risen = (
            solve_on_contact(operator, disc.contact, target, tolerance=TOLERANCE).pressure / layer.contact_modulus
            for target in (1.0, height)
        )
        if radius <= indenter.flat_radius or not is_measured(layer, indenter):
            return cls(layer, disc, grid, flat, risen, np.zeros(flat.shape), 0.0, 0.0)
        half_space = half_space_operator(cells)
        measured = solve_on_contact(half_space, disc.contact, height / grid.cell_size, tolerance=TOLERANCE).pressure
        load = float(half_space_load(indenter, np.array([radius - indenter.flat_radius]))[0])
        return cls(layer, disc, grid, flat, risen, measured, load, half_space_moment(indenter, radius))

    @property
    def contact_radius(self) -> float:
        """a [m]."""
        return self.disc.radius * self.grid.cell_size

    @property
    def stiffness(self) -> float:
        """k_N/E* [m]."""
        return self._total(self.flat)

    @property
    def moment(self) -> float:
        """-F_N/E* at no depth [m^2], so that F_N = E* (stiffness depth - moment).

        Of a profile that rises beyond the last cell it is that of a load at the edge.
        """
        if self.known_moment > 0.0 and not self.measured.any():
            return self.known_moment * self.edge_flat
        return self.known_moment + self._layer_share * self._total(self.risen - self.measured)

    @property
    def edge_flat(self) -> float:
        """phi under a unit depth [-]."""
        return self._edge_value(self.flat)

    @property
    def edge_risen(self) -> float:
        """phi of the displacement f [m]."""
        return self.known + self._layer_share * self._edge_value(self.risen - self.measured)

    @property
    def _layer_share(self) -> float:
        """The half-space's moment over that of the grid: what the layer adds is an integral of the same pressures."""
        measured = self._total(self.measured)
        return self.known_moment / measured if measured > 0.0 else 1.0

    def density(self, degree: int) -> FloatArray:
        """Coefficients of phi(t; a) = sum_n c_n P_2n(t/a) under a unit depth, shape (degree + 1,).

        P_2n(sqrt(1 - rho^2)) in the quotient of the pressures is P_2n(0) P_2n(t/a) in the density.
        """
        rho = self.grid.radius[self.disc.contact] / self.contact_radius
        inside = (1.0 - rho) * self.disc.radius > EDGE_CELLS
        even = np.arange(0, 2 * degree + 1, 2)
        columns = legendre.legvander(np.sqrt(1.0 - rho[inside] ** 2), even[-1])[:, even]
        fitted = np.linalg.lstsq(columns, self.quotient(self.flat)[inside], rcond=None)[0]
        return np.asarray(fitted * legendre.legvander(np.zeros(1), even[-1])[0, even])

    def quotient(self, pressure: FloatArray) -> FloatArray:
        """Pressure over that of the half-space under a unit depth, on the cells of the disc."""
        contact = self.disc.contact
        return np.asarray(pressure[contact] / self.disc.half_space.pressure[contact] * self.grid.cell_size)

    def _total(self, pressure: FloatArray) -> float:
        return 4.0 * self.grid.cell_size**2 * float(pressure.sum())

    def _edge_value(self, pressure: FloatArray) -> float:
        """The quotient as a polynomial of x = (a^2 - r^2)/a^2 near the edge, at the edge."""
        rho = self.grid.radius[self.disc.contact] / self.contact_radius
        inside = (1.0 - rho) * self.disc.radius
        reach = min(FARTHEST, max(LARGEST_SHARE * self.disc.radius, 3.0 * EDGE_CELLS))
        ring = (inside > EDGE_CELLS) & (inside < reach)
        degree = 3 if reach >= CUBIC_FROM else 2
        x, quotient = 1.0 - rho[ring] ** 2, self.quotient(pressure)[ring]
        return float(np.polynomial.polynomial.polyfit(x, quotient, degree)[0])


def is_measured(layer: ElasticLayer, indenter: Profile) -> bool:
    """Whether the profile's own edge value is measured by the half-space."""
    return not layer.is_half_space or bool(indenter.breakpoints)


@lru_cache(maxsize=4)
def half_space_operator(cells: int) -> FreeSpaceOperator:
    """Of cells of size 1 on a half-space with E* = 1."""
    half_space = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.0)
    return FreeSpaceOperator(half_space, cell_size=1.0, cells=cells, quarter=True)

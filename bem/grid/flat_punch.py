"""Flat punches of any radius on a layer, from discs of cells, and the radius that has a given stiffness."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import exp, log
from typing import Final, Self

import numpy as np

from bem.grid.calibrated_disc import THIN, TOLERANCE, PixelDisc, PunchSolution, measured_disc
from bem.grid.error_model import DIRECT
from bem.kernels.moduli import contact_modulus
from contact import ElasticLayer, Layer, NotConvergedError
from contact.records.validation import FloatArray

# Tolerance of punches whose stiffness alone counts: it is stationary, so that 1e-12 of it is lost at most (64 and
# 256 cells, bonded and unbonded, nu = 0.3 to 0.5, a/h = 0.1 to 20, 2026-11-22).
STIFFNESS_TOLERANCE: Final = 1e-6
# How wrong d ln(k_N)/d ln(a) may be as the edge of a disc of cells tells it: 0.043 at most (64 to 256 cells, bonded and
# unbonded, nu = 0.3 to 0.5, a/h = 0.1 to 10, 2026-11-22).
EDGE_DOUBT: Final = 0.05
# To which ln(k_N) of the contact radius is met.
RADIUS_TOLERANCE: Final = 1e-7


def grid_punch(
    layer: ElasticLayer,
    radius: float,
    cells: int,
    tolerance: float = TOLERANCE,
    start: FloatArray | None = None,
) -> tuple[PunchSolution, PixelDisc]:
    """The flat punch of this radius [m], and the grid disc it was computed with; from the pressure of one nearby."""
    # The ratio is zero on a half-space.
    ratio = radius / layer.thickness
    if not isinstance(layer, Layer):
        disc = measured_disc(cells, False)
        return disc.on_layer(layer.in_own_units().stretched(disc.radius / ratio), ratio, start, tolerance), disc
    disc = measured_disc(cells, bool(ratio > THIN))
    if layer.is_half_space:
        return PunchSolution(1.0, np.array([0.5]), disc.half_space.pressure, 0), disc  # Eq. (14)
    return disc.solve(ratio, layer.support, layer.poissons_ratio, start, tolerance), disc


def stiffness_exponent(ratio: float) -> float:
    """Bound of d ln(k_N)/d ln(a) at a/h: 1 on the half-space, 4 on thin incompressible layers."""
    return min(1.0 + DIRECT.exponent_growth * ratio, DIRECT.largest_exponent)


def contact_stiffness(layer: ElasticLayer, radius: float, cells: int) -> float:
    """k_N(a) [N/m], Eq. (10)."""
    punch, _ = grid_punch(layer, radius, cells, STIFFNESS_TOLERANCE)
    return punch_stiffness(layer, radius, punch)


def punch_stiffness(layer: ElasticLayer, radius: float, punch: PunchSolution) -> float:
    """k_N [N/m] of a punch of this radius [m], Eq. (10)."""
    return 2.0 * contact_modulus(layer) * radius * punch.stiffness


def cell_pressure(layer: ElasticLayer, depth: float, cell_size: float, punch: PunchSolution) -> FloatArray:
    """p [Pa] on the cells of the quadrant under a depth [m]."""
    return np.asarray(punch.pressure * (contact_modulus(layer) * depth / cell_size))


@dataclass(frozen=True)
class StiffnessNearby:
    """k_N about one radius as a power of the radius.

    Attributes:
        radius: a [m].
        stiffness: k_N(a) [N/m], of discs of so many `cells`.
        cells: Cells across the grid.
        exponent: d ln(k_N)/d ln(a).
        doubt: How wrong the exponent may be.
        pressure: Of that punch, as `PunchSolution` has it.
    """

    radius: float
    stiffness: float
    cells: int
    exponent: float
    doubt: float
    pressure: FloatArray

    @classmethod
    def at(cls, layer: ElasticLayer, radius: float, cells: int, start: FloatArray | None = None) -> Self:
        """With the exponent that the pressure at the edge tells, a/k_N dk_N/da = 4 k_bar q(1)^2."""
        punch, _ = grid_punch(layer, radius, cells, STIFFNESS_TOLERANCE, start)
        exponent = 4.0 * punch.stiffness * float(punch.shape.sum()) ** 2
        return cls(
            radius, punch_stiffness(layer, radius, punch), cells, exponent, EDGE_DOUBT * exponent, punch.pressure
        )

    def moved(self, layer: ElasticLayer, step: float) -> Self:
        """About the radius exp(step) times as large, with the exponent between the two."""
        there = type(self).at(layer, self.radius * exp(step), self.cells, self.pressure)
        between = log(there.stiffness / self.stiffness) / step
        return replace(there, exponent=between, doubt=abs(between - self.exponent))

    def step(self, stiffness: float) -> float:
        """ln of the radius with this stiffness [N/m] over the one here."""
        return log(stiffness / self.stiffness) / self.exponent

    def leaves(self, stiffness: float) -> float:
        """What that step misses of ln(stiffness) [N/m], since the exponent is in doubt."""
        return abs(self.step(stiffness)) * self.doubt


def radius_of_stiffness(
    layer: ElasticLayer, stiffness: float, near: float, cells: int, known: StiffnessNearby | None
) -> tuple[float, StiffnessNearby]:
    """The radius a [m] with k_N(a) = stiffness to 1e-7, by the secant method in logarithms; and what is known there.

    Args:
        layer: The layer.
        stiffness: k_N [N/m].
        near: A radius near it [m].
        cells: Cells across the grid of the flat punch.
        known: The answer for a stiffness nearby.

    Raises:
        NotConvergedError: If it was not met.
    """
    here = known if known is not None and known.cells == cells else StiffnessNearby.at(layer, near, cells)
    for _ in range(20):
        if here.leaves(stiffness) < RADIUS_TOLERANCE:
            return here.radius * exp(here.step(stiffness)), here
        here = here.moved(layer, here.step(stiffness))
    raise NotConvergedError(f"no radius has the stiffness {stiffness:g} N/m", {"stiffness": here.leaves(stiffness)})

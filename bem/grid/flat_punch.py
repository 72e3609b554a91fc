"""Flat punches of any radius on a layer, from discs of cells, and the radius that has a given stiffness."""

from __future__ import annotations

from math import log
from typing import Final

import numpy as np

from bem.grid.calibrated_disc import THIN, PixelDisc, PunchSolution, measured_disc
from bem.kernels.moduli import contact_modulus
from contact import Layer, NotConvergedError
from contact.records.validation import FloatArray

RADIUS_TOLERANCE: Final = 1e-7  # relative, of the stiffness
LARGEST_EXPONENT: Final = 4.0  # of k_N over a, on a thin incompressible layer
# How fast that exponent leaves 1 with a/h: 1.4 on an incompressible layer at a/h = 0.3, where it is fastest (integral
# equation, 2026-11-22), and less with any other kernel.
EXPONENT_GROWTH: Final = 1.5


def grid_punch(layer: Layer, radius: float, cells: int) -> tuple[PunchSolution, PixelDisc]:
    """The flat punch of this radius [m], and the grid disc it was computed with."""
    ratio = radius / layer.thickness  # zero on a half-space
    disc = measured_disc(cells, bool(ratio > THIN))
    if layer.is_half_space:
        return PunchSolution(1.0, np.array([0.5]), disc.half_space.pressure, 0), disc  # Eq. (14)
    return disc.solve(ratio, layer.support, layer.poissons_ratio, None), disc


def stiffness_exponent(ratio: float) -> float:
    """Bound of d ln(k_N)/d ln(a) at a/h: 1 on the half-space, `LARGEST_EXPONENT` on thin incompressible layers."""
    return min(1.0 + EXPONENT_GROWTH * ratio, LARGEST_EXPONENT)


def contact_stiffness(layer: Layer, radius: float, cells: int) -> float:
    """k_N(a) [N/m], Eq. (10)."""
    punch, _ = grid_punch(layer, radius, cells)
    return punch_stiffness(layer, radius, punch)


def punch_stiffness(layer: Layer, radius: float, punch: PunchSolution) -> float:
    """k_N [N/m] of a punch of this radius [m], Eq. (10)."""
    return 2.0 * contact_modulus(layer) * radius * punch.stiffness


def cell_pressure(layer: Layer, depth: float, cell_size: float, punch: PunchSolution) -> FloatArray:
    """p [Pa] on the cells of the quadrant under a depth [m]."""
    return np.asarray(punch.pressure * (contact_modulus(layer) * depth / cell_size))


def radius_of_stiffness(layer: Layer, stiffness: float, near: float, cells: int) -> float:
    """The radius a [m] with k_N(a) = stiffness, by the secant method in logarithms.

    Raises:
        NotConvergedError: If it was not met.
    """
    radius, exponent = near, 1.0
    miss = log(stiffness / contact_stiffness(layer, radius, cells))
    for _ in range(20):
        if abs(miss) < RADIUS_TOLERANCE:
            return radius
        step = miss / exponent
        radius *= float(np.exp(step))
        before, miss = miss, log(stiffness / contact_stiffness(layer, radius, cells))
        exponent = float(np.clip((before - miss) / step, 0.5, LARGEST_EXPONENT + 0.5))
    raise NotConvergedError(f"no radius has the stiffness {stiffness:g} N/m", {"stiffness": abs(miss)})

"""Flat punches of any radius on a layer, from discs of cells, and the radius that has a given stiffness."""

from __future__ import annotations

from math import log

import numpy as np

from bem.grid.calibrated_disc import THIN, PixelDisc, PunchSolution, measured_disc
from bem.grid.error_model import DIRECT
from bem.kernels.moduli import contact_modulus
from contact import ElasticLayer, Layer, NotConvergedError
from contact.records.validation import FloatArray


def grid_punch(layer: ElasticLayer, radius: float, cells: int) -> tuple[PunchSolution, PixelDisc]:
    """The flat punch of this radius [m], and the grid disc it was computed with."""
    # The ratio is zero on a half-space.
    ratio = radius / layer.thickness
    if not isinstance(layer, Layer):
        disc = measured_disc(cells, False)
        return disc.on_layer(layer.in_own_units().stretched(disc.radius / ratio), ratio, None), disc
    disc = measured_disc(cells, bool(ratio > THIN))
    if layer.is_half_space:
        return PunchSolution(1.0, np.array([0.5]), disc.half_space.pressure, 0), disc  # Eq. (14)
    return disc.solve(ratio, layer.support, layer.poissons_ratio, None), disc


def stiffness_exponent(ratio: float) -> float:
    """Bound of d ln(k_N)/d ln(a) at a/h: 1 on the half-space, 4 on thin incompressible layers."""
    return min(1.0 + DIRECT.exponent_growth * ratio, DIRECT.largest_exponent)


def contact_stiffness(layer: ElasticLayer, radius: float, cells: int) -> float:
    """k_N(a) [N/m], Eq. (10)."""
    punch, _ = grid_punch(layer, radius, cells)
    return punch_stiffness(layer, radius, punch)


def punch_stiffness(layer: ElasticLayer, radius: float, punch: PunchSolution) -> float:
    """k_N [N/m] of a punch of this radius [m], Eq. (10)."""
    return 2.0 * contact_modulus(layer) * radius * punch.stiffness


def cell_pressure(layer: ElasticLayer, depth: float, cell_size: float, punch: PunchSolution) -> FloatArray:
    """p [Pa] on the cells of the quadrant under a depth [m]."""
    return np.asarray(punch.pressure * (contact_modulus(layer) * depth / cell_size))


def radius_of_stiffness(layer: ElasticLayer, stiffness: float, near: float, cells: int) -> float:
    """The radius a [m] with k_N(a) = stiffness to 1e-7, by the secant method in logarithms.

    Raises:
        NotConvergedError: If it was not met.
    """
    radius, exponent = near, 1.0
    miss = log(stiffness / contact_stiffness(layer, radius, cells))
    for _ in range(20):
        if abs(miss) < 1e-7:
            return radius
        step = miss / exponent
        radius *= float(np.exp(step))
        before, miss = miss, log(stiffness / contact_stiffness(layer, radius, cells))
        exponent = float(np.clip((before - miss) / step, 0.5, DIRECT.largest_exponent + 0.5))
    raise NotConvergedError(f"no radius has the stiffness {stiffness:g} N/m", {"stiffness": abs(miss)})

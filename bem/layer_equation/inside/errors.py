"""What is stated of fields inside: errors of pressure and quadrature, and what rounded positions do near rims."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from bem.layer_equation.inside.density import Density
from bem.layer_equation.inside.fields import SURFACE
from contact.records.validation import FloatArray

_EPS = float(np.finfo(float).eps)
# What quadrature and rounding leave of stresses, over the largest: 2e-14 at worst, five times that is
# stated (540 points of 60 contacts, a/h 0.1 to 10, six kinds of profile, seed 2929, against rules of 36 nodes,
# 2026-11-22).
_QUADRATURE = 1e-13
# The error of the pressure counts so many times in the stresses, since s_1 - 2 G u_r/r combines three integrals of it;
# chosen.
_PRESSURE_SHARE = 3.0
# The gradient, a derivative of the pressure, errs by so many times more.
_GRADIENT = 3.0
# Share of a rounding over the depth that the gradient loses near the surface, where its integrals cancel: 0.01 to 0.02
# away from rims, and 195 points of 39 contacts are covered, 22 times in the median (seeds 5 and 779, against rules of
# 40 nodes in extended precision, 2026-11-22).
_CANCELLED = 0.05


class Magnitudes(NamedTuple):
    """Of fields at n points, in the density's length unit and one unit of stress.

    Attributes:
        stress: Largest of the stresses at each point, shape (n,).
        gradient: Of the pressure's gradient, shape (n,).
        length: The smaller of contact radius and thickness.
    """

    stress: FloatArray
    gradient: FloatArray
    length: float


def stated_errors(
    density: Density, points: FloatArray, found: Magnitudes, pressure_error: float
) -> Mapping[str, float]:
    """Relative errors of each kind of field, as `InsideFields` has it.

    Args:
        density: Of the contact's pressure.
        points: r and z in the density's length unit, shape (2, n).
        found: How large the fields are.
        pressure_error: Relative error of the contact's pressure.
    """
    stress, gradient, length = found
    a, (r, z) = density.radius, points
    largest = max(float(stress.max(initial=0.0)), float(np.finfo(float).tiny))
    # Integrals err by a share of the mean pressure, which counts for more where stresses are small.
    own = _PRESSURE_SHARE * pressure_error + _QUADRATURE
    base = own * max(1.0, density.mean_pressure / largest)
    lowest = np.maximum(z, SURFACE * a)
    rims = np.array([a, *(piece.start for piece in density.pieces if piece.start > 0.0 and piece.power > 1.0)])
    away = np.hypot(r[:, None] - rims, lowest[:, None]).min(axis=1, initial=np.inf)
    # A stress that grows like a root towards a rim changes by half of what the distance to it does.
    moved = 0.5 * _EPS * a / away + (lowest - z) * (1.0 / away + _GRADIENT / length)
    steepest = max(float(gradient.max(initial=0.0)), largest / length)
    stresses = base + float((moved * stress).max(initial=0.0)) / largest
    lost = _GRADIENT * moved * gradient + _CANCELLED * _EPS * stress / lowest
    return {
        "displacement": own + float((lowest - z).max(initial=0.0)) / length,
        "stress": stresses,
        "hydrostatic_pressure": stresses,
        "pressure_gradient": _GRADIENT * base + float(lost.max(initial=0.0)) / steepest,
    }

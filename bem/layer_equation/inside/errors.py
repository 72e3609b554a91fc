"""What is stated of fields inside: errors of pressure and quadrature, and what rounded positions do near rims."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from bem.layer_equation.inside.density import Density
from bem.layer_equation.inside.fields import SURFACE
from bem.layer_equation.inside.half_space_part import Points
from contact.answer.inside import KnownContact
from contact.records.validation import FloatArray

_EPS = float(np.finfo(float).eps)
# What quadrature leaves of stresses and displacements, over the largest: 7e-15 at worst, three times that is stated
# (250 points of 50 contacts, a/h 0.1 to 10, seven kinds of profile, seed 912, against rules of 40 nodes in extended
# precision, 2026-11-22).
_QUADRATURE = 2e-14
# Roundings of integrals over the contact, which count against the mean pressure where stresses are small, and against
# the depth of a half-space where a thin layer yields less: 2.2 at worst, about doubled (seeds 901 and 912, 2026-11-22).
_ROUNDINGS = 5.0
# Share of the pressure's error in stresses and displacements: at worst 0.7 of it on 10 nodes, where it is nearly all
# of the error (200 points of 40 contacts, seed 32, campaign of the fields inside, 2026-11-22).
_PRESSURE_SHARE = 1.0
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
        depth: delta.
    """

    stress: FloatArray
    gradient: FloatArray
    length: float
    depth: float


def stated_errors(density: Density, points: Points, found: Magnitudes, known: KnownContact) -> Mapping[str, float]:
    """Relative errors of each kind of field, as `InsideFields` has it.

    Args:
        density: Of the contact's pressure.
        points: In the density's length unit.
        found: How large the fields are.
        known: Errors of the contact.
    """
    stress, gradient, length, depth = found
    a, z = density.radius, points.z
    largest = max(float(stress.max(initial=0.0)), float(np.finfo(float).tiny))
    # Integrals err by a share of the mean pressure, which counts for more where stresses are small.
    of_mean = density.mean_pressure / largest
    of_pressure, rounding = _PRESSURE_SHARE * known.pressure_error, _ROUNDINGS * _EPS
    base = of_pressure * max(1.0, of_mean) + _QUADRATURE + rounding * of_mean
    lowest = np.maximum(z, SURFACE * a)
    rims = [*(piece.start > 0.0 and piece.power > 1.0 for piece in density.pieces), True]
    away = np.hypot(points.ends[rims], lowest).min(axis=0)
    # A stress that grows like a root towards the edge changes by half of what the distance to it does.
    moved = 0.5 * known.radius_error * a / np.hypot(points.ends[-1], lowest)
    moved += (lowest - z) * (1.0 / away + _GRADIENT / length)
    # A thin layer yields far less than a half-space would under the same force, and is computed as a difference.
    condition = math.pi * a * density.mean_pressure / abs(depth)
    surface = float((lowest - z).max(initial=0.0)) / length
    steepest = max(float(gradient.max(initial=0.0)), largest / length)
    stresses = base + float((moved * stress).max(initial=0.0)) / largest
    lost = _GRADIENT * moved * gradient + _CANCELLED * _EPS * stress / lowest
    return {
        "displacement": of_pressure + _QUADRATURE + rounding * condition + surface,
        "stress": stresses,
        "hydrostatic_pressure": stresses,
        "pressure_gradient": _GRADIENT * base + float(lost.max(initial=0.0)) / steepest,
    }

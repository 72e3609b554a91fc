"""What is stated of fields inside: errors of pressure and quadrature, and what rounded positions do near rims."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from bem.layer_equation.inside.density import Density
from bem.layer_equation.inside.half_space_part import Points
from contact.answer.inside import SURFACE, KnownContact
from contact.records.validation import FloatArray

_EPS = float(np.finfo(float).eps)
# What quadrature leaves of stresses, displacements and gradients, over the largest: 4e-15 at worst, doubled (7000
# points of 1000 contacts, a/h 0.1 to 10, seven kinds of profile, seeds 78 and 79; rules of 40 nodes over the same
# density, in extended precision; 2026-11-22).
_QUADRATURE = 8e-15
# Roundings of integrals over the contact, which count against the mean pressure where stresses are small, and against
# both integrals that make a displacement where most of them cancels: 2.2 (seeds 901 and 912) and 2.4 at worst (seed
# 19501, `contact-verify campaign inside`, 2026-11-23), a fourth more.
_ROUNDINGS = 3.0
# Added to `_ROUNDINGS` times a/h, since the argument of a wave as short as the layer is thick is rounded by eps a/h.
# Without it the bar of a gradient beside a flat punch of a/h = 9.9 was just enough (scene 117 of seed 19302,
# 2026-11-22).
_OF_WAVES = 0.5
# A derivative along r or z errs by so many times the error over the smaller of contact radius and thickness; chosen,
# 2.4 is needed (300 contacts, seeds 9 and 41, with 8, 12 and 24 nodes, campaign of the fields inside, 2026-11-22).
_DERIVATIVE = 3.0
# Displacements err by so many times the share of the density: 1.3 is needed beside wide contacts (the same contacts).
_MOVED = 2.0
# Shares of the density's error by which gradients err, of themselves and of the stress over the length, which is all
# where they pass zero: beside 1.5 of the first 0.34 of the second is needed, near the axis of a truncated cone (scene
# 97 of seed 9 on 12 nodes, campaign of the fields inside, 2026-11-22); half as much again.
_ALIKE, _UNLIKE = 1.5, 0.5
# What the difference of two transfer functions leaves of a layer's gradient, over stress and length: 3.8e-14 at worst,
# on the axis just below a flat punch, where the rest states as much (scene 351 of seed 19302); half of it is added.
_SUBTRACTED = 2e-14
# Roundings of a sum of terms, times the root of the sum of their squares: 5.9 at worst within 1e-6 of the surface,
# doubled (1000 contacts, seeds 78 and 79, 24 nodes, 2026-11-22).
_TERM = 12.0


LEFT_OUT = ("left_out", "gradient_left_out", "displacement_left_out")


class Magnitudes(NamedTuple):
    """Of fields at n points, in the density's length unit and one unit of stress.

    An adhering contact is one that presses less a flat punch that pulls. Both err by a share of themselves, however
    much cancels, so that sizes are sums of the magnitudes of the edge's field and of the rest.

    Attributes:
        stress: Largest of the stresses at each point, shape (n,).
        displacement: Larger of the two displacements, shape (n,).
        yields: E* over 2 G there, shape (n,).
        gradient: Of the pressure's gradient, shape (n,).
        largest_stress: Of all points, of both parts together.
        largest_gradient: The same of the gradient.
        displacement_terms: Larger sum of what the half-space and the layers below make of a displacement, shape (n,).
        gradient_terms: Root of the sum of the squares of its terms, shape (n,).
        edge_displacement: Displacement under a density of edge value one, shape (n,).
        edge_stress: Largest stress under it, shape (n,).
        edge_gradient: The pressure's gradient under it, shape (n,).
        length: The smaller of contact radius and thickness.
        tip_order: n of a profile that begins like r^n.
        tilt: Slope of the indenter at the edge of the contact.
        thickness: Of the body, infinite for a half-space.
        depth: delta.
        left_out: Of stresses, what is left out of integrals over waves, shape (n,).
        gradient_left_out: The same of the gradient.
        displacement_left_out: The same of displacements, times 2 G.
    """

    displacement: FloatArray
    yields: FloatArray
    stress: FloatArray
    gradient: FloatArray
    largest_stress: float
    largest_gradient: float
    displacement_terms: FloatArray
    gradient_terms: FloatArray
    edge_displacement: FloatArray
    edge_stress: FloatArray
    edge_gradient: FloatArray
    length: float
    tip_order: float
    tilt: float
    thickness: float
    depth: float
    left_out: FloatArray | float = 0.0
    gradient_left_out: FloatArray | float = 0.0
    displacement_left_out: FloatArray | float = 0.0


def stated_errors(
    density: Density, points: Points, found: Magnitudes, known: KnownContact, unit: float
) -> Mapping[str, float]:
    """Relative errors of each kind of field, as `InsideFields` has it.

    Fields are linear in the density's slope. What is solved for errs by a share of it, and so do fields, however small
    they are beside the mean pressure. An edge that is off, or its value, adds the fields of a singular edge.

    Args:
        density: Of the contact's pressure.
        points: In the density's length unit.
        found: How large the fields are.
        known: Errors of the contact.
        unit: Length unit [m].
    """
    a, z = density.radius, points.z
    largest = max(found.largest_stress, float(np.finfo(float).tiny))
    mean, rounding = density.mean_pressure, (_ROUNDINGS + _OF_WAVES * a / found.thickness) * _EPS
    grown = _DERIVATIVE * known.radius_error * a / found.length
    share = known.density_error + _QUADRATURE + grown
    lowest = np.maximum(z, SURFACE * a)
    # The surface is looked at a little below, where gradients are other ones beside rims and tips. Stresses change by
    # what the gradient tells.
    away = np.hypot(points.ends[_rims(density, found.tip_order)], lowest).min(axis=0)
    shifted = (lowest - z) * (1.0 / away + _DERIVATIVE / found.length)
    below = (lowest - z) * (_DERIVATIVE / found.length * found.stress + _rises(found.tip_order) * found.gradient)
    edge = _of_edge(density, known, unit)
    felt = edge * left_by(found.thickness, points)
    # A rigid base throws back what arrives, so that stresses there are up to twice those of the half-space.
    thrown = (1.0 + points.z / found.thickness) * felt
    stress = share * found.stress + below + thrown * found.edge_stress + rounding * mean + found.left_out
    gradient = (_ALIKE * share + _DERIVATIVE * shifted) * found.gradient + thrown * found.edge_gradient
    gradient += _DERIVATIVE * rounding * mean / found.length
    # A radius that is off moves all fields by as much over the length, those where the gradient passes zero as well.
    unlike = _UNLIKE * (share - grown) + grown / _DERIVATIVE + _DERIVATIVE * _QUADRATURE
    unlike += _SUBTRACTED * (found.thickness < math.inf)
    gradient += unlike * found.stress / found.length
    gradient += _TERM * _EPS * found.gradient_terms + found.gradient_left_out
    # A thin layer yields far less than a half-space would under the same force: what is computed is a difference of two
    # integrals, each of them rounded.
    own = _MOVED * known.density_error + _QUADRATURE + grown
    moved = own * found.displacement + felt * found.edge_displacement + found.displacement_left_out
    moved += _ROUNDINGS * _EPS * found.displacement_terms
    # Beside a rim stresses are of the size of their gradient times its distance, though some vanish on the surface, and
    # so are tilts; elsewhere tilts are of the size of the depth over a length, at the edge that of the indenter.
    strain = found.yields * (found.stress + np.minimum(away, found.length) * found.gradient)
    tilt = found.tilt + _DERIVATIVE * abs(found.depth) / found.length
    moved += (lowest - z) * (_rises(found.tip_order) * strain + tilt)
    steepest = max(found.largest_gradient, largest / found.length)
    stresses = float(stress.max(initial=0.0)) / largest
    return {
        "displacement": float(moved.max(initial=0.0)) / abs(found.depth) + _QUADRATURE,
        "stress": stresses,
        "hydrostatic_pressure": stresses,
        "pressure_gradient": float(gradient.max(initial=0.0)) / steepest,
    }


def _rims(density: Density, tip_order: float) -> list[bool]:
    """Which ends of pieces the gradient is singular at: kinks, the edge, and a tip that is no parabola."""
    kinks = (piece.power > 1.0 if piece.start > 0.0 else tip_order != 2.0 for piece in density.pieces)
    return [*kinks, True]


def _rises(tip_order: float) -> float:
    """Change of stresses on the last way to the surface, over that way times the pressure's gradient at its beginning.

    Stresses of a compressible body have three times the gradient of the hydrostatic pressure. They change like a power
    of the way: at edges like its root, by twice the gradient, at a tip r^n like its power n - 1.
    """
    return 3.0 * max(2.0, 1.0 / (tip_order - 1.0) if tip_order > 1.0 else 0.0)


def left_by(thickness: float, points: Points) -> FloatArray:
    """Share of a half-space's fields that a layer leaves: they fade over a thickness, here more slowly than in fact."""
    away = np.hypot(points.ends[-1], points.z)
    return np.asarray(np.exp(-np.maximum(away / thickness - 1.0, 0.0)))


def _of_edge(density: Density, known: KnownContact, unit: float) -> float:
    """Error of the density's value at the edge: its own, and its slope there times the error of the radius."""
    last = density.pieces[-1]
    slope = float(density.slope(last, np.full(1, last.length))[0])
    return known.edge_error / unit + abs(slope) * known.radius_error * density.radius

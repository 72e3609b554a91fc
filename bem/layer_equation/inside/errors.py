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


class Causes(NamedTuple):
    """What fields at n points err by, whatever their kind.

    Attributes:
        density_error: Relative error of the density.
        grown: Share of fields by which they change with a contact radius that is off.
        rounding: Relative rounding of integrals over the contact.
        mean_pressure: That integrals are rounded against.
        raised: How much deeper than the points fields are evaluated at the surface, shape (n,).
        away: Distance from there to the nearest rim, shape (n,).
        rises: Factor of the gradient on that way, see `_rises`.
        felt: Error of the density's value at the edge, as much of it as a layer leaves, shape (n,).
        thrown: The same with what a rigid base throws back, shape (n,).
    """

    density_error: float
    grown: float
    rounding: float
    mean_pressure: float
    raised: FloatArray
    away: FloatArray
    rises: float
    felt: FloatArray
    thrown: FloatArray

    @property
    def share(self) -> float:
        """Of fields, by which density, quadrature and contact radius make them err."""
        return self.density_error + _QUADRATURE + self.grown


def stated_errors(
    density: Density, points: Points, found: Magnitudes, known: KnownContact, unit: float
) -> Mapping[str, float]:
    """Relative errors of each kind of field, as `InsideFields` has it.

    Args:
        density: Of the contact's pressure.
        points: In the density's length unit.
        found: How large the fields are.
        known: Errors of the contact.
        unit: Length unit [m].
    """
    causes = _causes(density, points, found, known, unit)
    largest = max(found.largest_stress, float(np.finfo(float).tiny))
    steepest = max(found.largest_gradient, largest / found.length)
    stress = float(_of_stress(causes, found).max(initial=0.0)) / largest
    gradient = float(_of_gradient(causes, found).max(initial=0.0)) / steepest
    moved = float(_of_displacement(causes, found).max(initial=0.0)) / abs(found.depth) + _QUADRATURE
    return {
        "displacement": moved,
        "stress": stress,
        "hydrostatic_pressure": stress,
        "pressure_gradient": gradient,
    }


def _causes(density: Density, points: Points, found: Magnitudes, known: KnownContact, unit: float) -> Causes:
    """What the contact's errors, roundings and the look below the surface amount to at these points."""
    a, z = density.radius, points.z
    # The surface is looked at a little below, where gradients are other ones beside rims and tips.
    lowest = np.maximum(z, SURFACE * a)
    felt = _of_edge(density, known, unit) * left_by(found.thickness, points)
    return Causes(
        density_error=known.density_error,
        grown=_DERIVATIVE * known.radius_error * a / found.length,
        rounding=(_ROUNDINGS + _OF_WAVES * a / found.thickness) * _EPS,
        mean_pressure=density.mean_pressure,
        raised=lowest - z,
        away=np.hypot(points.ends[_rims(density, found.tip_order)], lowest).min(axis=0),
        rises=_rises(found.tip_order),
        felt=felt,
        # Stresses at a rigid base are up to twice those of the half-space.
        thrown=(1.0 + z / found.thickness) * felt,
    )


def _of_stress(causes: Causes, found: Magnitudes) -> FloatArray:
    """Error of the stresses at each point, in the unit of stress.

    Stresses are linear in the density's slope: what is solved for errs by a share of it, and so do they, however small
    they are beside the mean pressure. Looking deeper changes them by that way times the gradient. An edge value that is
    off adds the stress of a singular edge. Integrals over the contact are rounded against the mean pressure, and
    integrals over waves leave out what they say.
    """
    below = causes.raised * (_DERIVATIVE / found.length * found.stress + causes.rises * found.gradient)
    stress = causes.share * found.stress + below + causes.thrown * found.edge_stress
    return np.asarray(stress + causes.rounding * causes.mean_pressure + found.left_out)


def _of_gradient(causes: Causes, found: Magnitudes) -> FloatArray:
    """Error of the pressure's gradient at each point, in the unit of stress over the length unit.

    It errs by shares of itself and of the stress over the length, for a derivative of what is off passes zero elsewhere
    than the gradient does: a radius that is off moves all fields by as much over the length. Looking deeper changes a
    gradient by the way over the distance from the nearest rim and over the length. The edge, roundings and integrals
    over waves add what they add to stresses, and each of its own terms, which cancel, its rounding.
    """
    shifted = causes.raised * (1.0 / causes.away + _DERIVATIVE / found.length)
    gradient = (_ALIKE * causes.share + _DERIVATIVE * shifted) * found.gradient + causes.thrown * found.edge_gradient
    gradient += _DERIVATIVE * causes.rounding * causes.mean_pressure / found.length
    unlike = _UNLIKE * (causes.share - causes.grown) + causes.grown / _DERIVATIVE + _DERIVATIVE * _QUADRATURE
    unlike += _SUBTRACTED * (found.thickness < math.inf)
    gradient += unlike * found.stress / found.length
    return np.asarray(gradient + (_TERM * _EPS * found.gradient_terms + found.gradient_left_out))


def _of_displacement(causes: Causes, found: Magnitudes) -> FloatArray:
    """Error of the displacements at each point, in the length unit.

    They err by a share of themselves, by the displacement of a singular edge, and by what integrals over waves leave
    out. A thin layer yields far less than a half-space would under the same force: what is computed is a difference of
    two integrals, each of them rounded. Looking deeper changes them by that way times strain and tilt. Beside a rim
    stresses are of the size of their gradient times its distance, though some vanish on the surface, and so are tilts;
    elsewhere tilts are of the size of the depth over a length, at the edge that of the indenter.
    """
    own = _MOVED * causes.density_error + _QUADRATURE + causes.grown
    moved = own * found.displacement + causes.felt * found.edge_displacement + found.displacement_left_out
    moved += _ROUNDINGS * _EPS * found.displacement_terms
    strain = found.yields * (found.stress + np.minimum(causes.away, found.length) * found.gradient)
    tilt = found.tilt + _DERIVATIVE * abs(found.depth) / found.length
    return np.asarray(moved + causes.raised * (causes.rises * strain + tilt))


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

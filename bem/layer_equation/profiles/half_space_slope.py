"""Slope g_hs'(t) of the half-space's MDR profile, Eq. (15), in closed form: the density of its pressure, Eq. (9).

Derivatives of the forms in Popov, Hess and Willert, Handbook of Contact Mechanics (2019), chapter 2.
"""

from __future__ import annotations

import math
from functools import singledispatch

import numpy as np

from contact.records.validation import FloatArray
from contact.scene.profiles import (
    Cone,
    Paraboloid,
    PowerLaw,
    Profile,
    Sphere,
    Spheroconical,
    TruncatedCone,
    TruncatedParaboloid,
)


@singledispatch
def profile_slope(indenter: Profile, excess: FloatArray, room: FloatArray) -> FloatArray | None:
    """g_hs' [-] at t = b + excess; None for profiles without a closed form.

    Args:
        indenter: Profile of revolution.
        excess: t - b [m] over the radius b of the flat end, any shape.
        room: What is left [m] from t to the end of the profile, which a sphere needs near its equator.
    """
    return None


def has_closed_slope(indenter: Profile) -> bool:
    """Whether a closed form is registered for this kind of profile."""
    return profile_slope.dispatch(type(indenter)) is not profile_slope.dispatch(Profile)


@profile_slope.register
def _(indenter: Cone, excess: FloatArray, room: FloatArray) -> FloatArray:
    return np.full(excess.shape, np.pi / 2 * indenter.slope)


@profile_slope.register
def _(indenter: Paraboloid, excess: FloatArray, room: FloatArray) -> FloatArray:
    return 2 / indenter.radius_of_curvature * excess


@profile_slope.register
def _(indenter: Sphere, excess: FloatArray, room: FloatArray) -> FloatArray:
    """artanh(t/R) + R t/(R^2 - t^2)."""
    R = indenter.radius
    return np.log1p(2 * excess / room) / 2 + R * excess / (room * (R + excess))


@profile_slope.register
def _(indenter: Spheroconical, excess: FloatArray, room: FloatArray) -> FloatArray:
    """The sphere's slope up to b, and beyond it the cone's.

    ln[(R + t)/(c + q)] + t/(R + t) + slope arctan(q/b) + (b^2 - c q)/(c (c + q)), c^2 = R^2 - b^2, q^2 = t^2 - b^2.
    """
    R, b, t = indenter.radius, indenter.tangent_radius, excess
    c, q = R / math.hypot(1.0, indenter.slope), np.sqrt(np.maximum(t - b, 0.0) * (t + b))
    cone = np.log((R + t) / (c + q)) + t / (R + t) + indenter.slope * np.arctan2(q, b) + (b**2 - c * q) / (c * (c + q))
    left = np.where(t < b, np.where(np.isfinite(room), room, R - t), R)
    return np.where(t < b, np.log1p(2 * t / left) / 2 + R * t / (left * (R + t)), cone)


def room_to_pole(indenter: Profile, radius: float, room: float) -> float:
    """Distance [m] from a radius to the pole of g_hs' beyond it, where a sphere is upright; infinite without one.

    Args:
        indenter: Profile of revolution.
        radius: End [m] of a stretch between breakpoints.
        room: What is left [m] from there to the end of the profile.
    """
    if isinstance(indenter, Spheroconical):
        return indenter.radius - radius if radius <= indenter.tangent_radius else math.inf
    return math.inf if indenter.max_radius in indenter.breakpoints else room


@profile_slope.register
def _(indenter: PowerLaw, excess: FloatArray, room: FloatArray) -> FloatArray:
    n, R = indenter.exponent, indenter.reference_radius
    factor = n * math.sqrt(math.pi) * math.exp(math.lgamma(n / 2 + 1) - math.lgamma((n + 1) / 2))
    return np.asarray(factor * indenter.reference_height / R * (excess / R) ** (n - 1))


@profile_slope.register
def _(indenter: TruncatedCone, excess: FloatArray, room: FloatArray) -> FloatArray:
    """slope (arccos(b/t) + b/sqrt(t^2 - b^2))."""
    b = indenter.flat_radius
    leg = np.sqrt(excess * (excess + 2 * b))
    return indenter.slope * (np.arctan2(leg, b) + b / leg)


@profile_slope.register
def _(indenter: TruncatedParaboloid, excess: FloatArray, room: FloatArray) -> FloatArray:
    """(2 t^2 - b^2)/(R sqrt(t^2 - b^2))."""
    b = indenter.flat_radius
    square = excess * (excess + 2 * b)
    return np.asarray((b**2 + 2 * square) / (np.sqrt(square) * indenter.radius_of_curvature))

"""MDR profile of the half-space, Eq. (15): ``g_hs(x) = x int_0^x f'(r)/sqrt(x^2 - r^2) dr``.

It is also the right-hand side of the layer's equation. Positions are given as *excess* ``d = x - b`` over the
indenter's flat radius b, because a difference formed by the caller is exact while ``x - b`` of rounded x is not: that
keeps all digits when the contact has grown only slightly beyond the flat end. For a pointed profile d = x.

Profiles with a closed form are registered below; every other profile is integrated.
"""

from __future__ import annotations

import math
from functools import singledispatch

import numpy as np

from bem.layer_equation.profiles.half_space_slope import profile_slope
from bem.polynomials.gauss_panels import gauss_nodes
from contact.records.validation import FloatArray
from contact.scene.profiles import (
    Cone,
    FlatPunch,
    Paraboloid,
    PowerLaw,
    Profile,
    Sphere,
    Spheroconical,
    TruncatedCone,
    TruncatedParaboloid,
)
from mdr.springs.error_model import EPS, POSITION_ROUNDINGS

# Gauss nodes on each stretch of the profile between breakpoints; chosen.
NODES = 48


@singledispatch
def half_space_profile(indenter: Profile, excess: FloatArray) -> FloatArray:
    """g_hs [m] at x = flat radius + excess [m], any shape; by Gauss quadrature between the profile's breakpoints."""
    return integrated_half_space_profile(indenter, excess)


def integrated_half_space_profile(indenter: Profile, excess: FloatArray) -> FloatArray:
    """g_hs [m] of any profile by quadrature, with r = x cos(psi): no singularity is left."""
    b = indenter.flat_radius
    x = b + excess
    inner = [b, *(k for k in indenter.breakpoints if b < k < np.max(x, initial=0.0))]
    total = np.zeros_like(x)
    for start, stop in zip(inner, [*inner[1:], np.inf], strict=True):
        total += np.where(x > start, _stretch(indenter, x, np.maximum(x - start, 0), np.minimum(x, stop)), 0.0)
    return x * total


def _stretch(indenter: Profile, x: FloatArray, beyond: FloatArray, stop: FloatArray) -> FloatArray:
    """int f'(x cos psi) dpsi between r = x - beyond and r = stop.

    The nodes crowd with the fourth power towards the inner end, where a profile like r^1.7 is not analytic.
    """
    nodes, weights = gauss_nodes(NODES)
    # This is arccos((x - beyond)/x), exact near zero.
    widest = np.arctan2(np.sqrt(beyond * (2 * x - beyond)), x - beyond)
    narrowest = np.arctan2(np.sqrt((x - stop) * (x + stop)), stop)
    span = (widest - narrowest)[..., None]
    slope = indenter.slope_at(x[..., None] * np.cos(widest[..., None] - span * nodes**4))
    values: FloatArray = span[..., 0] * ((slope * 4 * nodes**3) @ weights)
    return values


def profile_beside_end(indenter: Profile, excess: FloatArray, room: FloatArray) -> FloatArray:
    """g_hs [m] where the room [m] that is left to the indenter's end has more digits than the excess [m].

    Only an end that stands upright asks for them.
    """
    if not isinstance(indenter, Sphere):
        return half_space_profile(indenter, excess)
    return np.asarray(excess * np.log1p(2 * excess / room) / 2)  # x artanh(x/R)


def is_endless(indenter: Profile, radius: float) -> bool:
    """Whether a contact of this radius [m] reaches the indenter's end and that stands upright, as a sphere's does."""
    if radius < indenter.max_radius or math.isinf(indenter.max_radius):
        return False
    # An infinite depth is what is looked for.
    with np.errstate(divide="ignore"):
        depth = half_space_profile(indenter, np.asarray(indenter.max_radius - indenter.flat_radius))
    return not np.isfinite(depth)


def rounding_beside_end(indenter: Profile, largest: float, radius: FloatArray) -> FloatArray:
    """What rounded positions do to a profile that is upright at its end: eps d(ln g_hs)/d(ln x), and a margin.

    The largest radius is where the grid ends, with all its digits.
    """
    end = indenter.radius if isinstance(indenter, Spheroconical) else indenter.max_radius / 2
    is_steep = isinstance(indenter, Spheroconical)
    inside = (radius > indenter.flat_radius) & (is_steep | (radius != largest))
    if not (np.any(inside) and (is_steep or is_endless(indenter, indenter.max_radius))):
        return np.zeros_like(radius)
    edge = np.where(inside, radius, end)
    slope = profile_slope(indenter, edge, indenter.max_radius - edge)
    share = 0.0 if slope is None else POSITION_ROUNDINGS * EPS * edge * slope / half_space_profile(indenter, edge)
    return np.where(inside, share, 0.0)


@half_space_profile.register
def _(indenter: FlatPunch, excess: FloatArray) -> FloatArray:
    return np.zeros_like(excess)


@half_space_profile.register
def _(indenter: Cone, excess: FloatArray) -> FloatArray:
    return np.pi / 2 * indenter.slope * excess


@half_space_profile.register
def _(indenter: Paraboloid, excess: FloatArray) -> FloatArray:
    return excess**2 / indenter.radius_of_curvature


@half_space_profile.register
def _(indenter: Sphere, excess: FloatArray) -> FloatArray:
    return profile_beside_end(indenter, excess, indenter.radius - excess)


@half_space_profile.register
def _(indenter: Spheroconical, excess: FloatArray) -> FloatArray:
    """The sphere's up to b; x {ln[(R + x)/(c + q)] + slope arctan(q/b)} beyond, c and q as in `profile_slope`."""
    R, b, x = indenter.radius, indenter.tangent_radius, excess
    c, q = R / math.hypot(1.0, indenter.slope), np.sqrt(np.maximum(x - b, 0.0) * (x + b))
    cone = x * (np.log((R + x) / (c + q)) + indenter.slope * np.arctan2(q, b))
    return np.where(x < b, x * np.log1p(2 * x / np.where(x < b, R - x, R)) / 2, cone)


@half_space_profile.register
def _(indenter: PowerLaw, excess: FloatArray) -> FloatArray:
    n = indenter.exponent
    # n int_0^1 s^(n-1)/sqrt(1 - s^2) ds
    factor = n * math.sqrt(math.pi) / 2 * math.exp(math.lgamma(n / 2) - math.lgamma((n + 1) / 2))
    height = indenter.reference_height * (excess / indenter.reference_radius) ** n
    return np.asarray(factor * height)


@half_space_profile.register
def _(indenter: TruncatedCone, excess: FloatArray) -> FloatArray:
    b = indenter.flat_radius
    angle = np.arctan2(np.sqrt(excess * (excess + 2 * b)), b)  # arccos(b/x)
    return indenter.slope * (b + excess) * angle


@half_space_profile.register
def _(indenter: TruncatedParaboloid, excess: FloatArray) -> FloatArray:
    b = indenter.flat_radius
    return (b + excess) * np.sqrt(excess * (excess + 2 * b)) / indenter.radius_of_curvature

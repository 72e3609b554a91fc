"""What a profile does on a half-space without adhesion, in closed form up to one integral (Sneddon 1965)."""

from __future__ import annotations

import numpy as np

from contact import Profile
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.indenter import shape

# Gauss points between two breakpoints, where f' is mostly a low polynomial of sin(theta): closed forms of cones and
# paraboloids are met to 1e-13 (tests/fem_reference/test_adhesive_branch.py).
_POINTS = 12


def half_space_parts(profile: Profile, radius: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Depth g [m] and half the force over E* at depth zero, V [m^2], of contacts of radii a [m], shape (n,).

    ``g(a) = int_0^a a f'(r) / sqrt(a^2 - r^2) dr`` and ``V(a) = int_0^a g = int_0^a f'(r) sqrt(a^2 - r^2) dr``, by
    Gauss's rule in ``r = a sin(theta)`` between the breakpoints of f.
    """
    s, weight = np.polynomial.legendre.leggauss(_POINTS)
    inside = np.minimum(np.array([0.0, *profile.breakpoints]), radius[:, None]) / radius[:, None]
    ends = np.concatenate([np.arcsin(inside), np.full((len(radius), 1), np.pi / 2)], axis=1)
    half = np.diff(ends, axis=1)[..., None] / 2
    theta = ends[:, :-1, None] + half * (1 + s)
    slope = shape(profile, np.minimum(radius[:, None, None] * np.sin(theta), profile.max_radius)).slope
    terms = half * weight * slope
    depth = radius * terms.sum(axis=(1, 2))
    return depth, radius**2 * (terms * np.cos(theta) ** 2).sum(axis=(1, 2))

"""What a profile does on a layer whose flat punches' pressures are known: a superposition, up to one integral.

The layer under a flat punch and under the profile held at depth zero obey Betti's theorem: the force that holds the
profile is ``F_2 = -int p_1 f 2 pi r dr``, p_1 the pressure of the punch at unit depth.  That pressure is as smooth in
the contact radius as the layer is, wherever the profile has its breakpoints.  With ``c = sqrt(1 - r^2 / a^2)``,
stresses by E* and lengths by a,

    p_1 = q(c) / c,   q = sum_k q_k P_2k(c),   q_k = (4k + 1) / (2 pi) int p_1 P_2k(c) 2 pi r dr,

where P_2k are Legendre's polynomials; on a half-space ``q_0 = 1 / pi`` stands alone.  Each q_k is the force of a smooth
profile, hence as accurate as an energy.
"""

from __future__ import annotations

import numpy as np
from numpy.polynomial.legendre import legval, legvander

from contact import Profile
from contact.records.validation import FloatArray
from fem_reference.prescribed_contact import PrescribedContact
from fem_reference.profiles import shape

# Gauss points between two breakpoints, where f' is mostly a low polynomial of sin(theta): closed forms of cones and
# paraboloids are met to 1e-13 (tests/fem_reference/test_adhesive_branch.py).
_POINTS = 12
# Polynomials in which the pressure of a flat punch is expanded.  Chosen: what they leave of F_2 is interpolated, 1e-6
# of it with four of them, 2e-7 with eight (tables on five layers, a/h up to 1.8, seed 6101, 2026-11-26).
_TERMS = 8


def punch_pressure(contact: PrescribedContact) -> FloatArray:
    """The coefficients q_k of one solved contact, shape (term,)."""
    trace = contact.contact_trace
    radius, weight = (values.ravel() for values in trace.gauss(trace.degree + 2))
    pressure = trace.evaluate(contact.pressures[:, 0], radius)
    even = legvander(np.sqrt((1.0 - radius) * (1.0 + radius)), 2 * _TERMS - 2)[:, ::2]
    return np.asarray((4 * np.arange(_TERMS) + 1) / (2 * np.pi) * ((weight * pressure) @ even))


def superposed(
    profile: Profile, radius: FloatArray, coefficients: FloatArray, growth: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """``k_N' delta_0 / 2`` [m] and F_2 / E* [m^2] of contacts of radii a [m], shape (n,).

    With ``l = (pi / c) int_0^c q dc`` the force is ``F_2 = -2 int_0^a f' sqrt(a^2 - r^2) l dr``, and
    ``k_N' delta_0 = -dF_2 / da``, by Gauss's rule in ``r = a sin(theta)`` between the breakpoints of f.

    Args:
        profile: f.
        radius: a [m].
        coefficients: q_k there, shape (term, n).
        growth: their derivatives by ln a.
    """
    s, weight = np.polynomial.legendre.leggauss(_POINTS)
    breaks = [0.0, *(r for r in profile.breakpoints if r < radius.max(initial=0.0))]
    inside = np.minimum(np.array(breaks), radius[:, None]) / radius[:, None]
    ends = np.concatenate([np.arcsin(inside), np.full((len(radius), 1), np.pi / 2)], axis=1)
    half = np.diff(ends, axis=1)[..., None] / 2
    theta = ends[:, :-1, None] + half * (1 + s)
    slope = shape(profile, np.minimum(radius[:, None, None] * np.sin(theta), profile.max_radius)).slope
    terms, sine, cosine = half * weight * slope, np.sin(theta), np.cos(theta)
    q, mean, more = (
        legval(cosine, series[..., None, None], tensor=False)
        for series in (_even(coefficients), _integrated(coefficients), _integrated(growth))
    )
    outer = sine**2 * q + cosine * (mean + more)
    depth = np.pi * radius * np.sum(terms * outer, axis=(1, 2))
    return depth, -2.0 * np.pi * radius**2 * np.sum(terms * cosine * mean, axis=(1, 2))


def _even(coefficients: FloatArray) -> FloatArray:
    """Legendre series of q."""
    series = np.zeros((2 * len(coefficients), *coefficients.shape[1:]))
    series[::2] = coefficients
    return series


def _integrated(coefficients: FloatArray) -> FloatArray:
    """Legendre series of ``int_0^c q dc``: the integral of P_n is ``(P_n+1 - P_n-1) / (2 n + 1)``."""
    series = np.zeros((2 * len(coefficients), *coefficients.shape[1:]))
    share = coefficients / (4 * np.arange(len(coefficients)) + 1)[:, None]
    series[1::2] = share
    series[1:-1:2] -= share[1:]
    return series

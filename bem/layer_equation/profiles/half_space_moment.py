"""Depth and force of a profile on the half-space as integrals over its heights and slopes, stretch by stretch."""

from __future__ import annotations

from typing import Final

import numpy as np

from bem.polynomials.gauss import legendre_rule
from contact import Profile
from contact.records.validation import FloatArray

# Nodes of an integral over the profile between its breakpoints: that of a power of 1 or more is off by 32^-6 = 1e-9 of
# itself at most, a tenth of the linear solutions' error.
MOMENT_NODES: Final = 32


def half_space_moment(indenter: Profile, radius: float) -> float:
    """-F_N/E* at no depth [m^2] of a profile pressed into the half-space: 2 int_0^a f r/sqrt(a^2 - r^2) dr."""
    return float(half_space_moments(indenter, np.array([radius]))[0])


def half_space_moments(indenter: Profile, radii: FloatArray) -> FloatArray:
    """The same at many radii a > 0 [m], shape (n,).

    With r = a sin(theta) the integrand is analytic between breakpoints; at a tip f begins like a power of theta.
    """
    lengths, sine, weight = _stretches(indenter, radii)
    height = indenter.height(radii[:, None, None] * sine)
    return np.asarray(radii * np.einsum("ns,nsk,k->n", lengths, sine * height, weight))


def half_space_depth(indenter: Profile, radius: float) -> float:
    """g_hs(a) [m], half the derivative of that moment: int_0^(pi/2) (f + r f') sin(theta) d(theta).

    Unlike a int_0^(pi/2) f' d(theta) it begins at a tip like a power of two or more.
    """
    (lengths,), (sine,), weight = _stretches(indenter, np.array([radius]))
    r = radius * sine
    return float(0.5 * lengths @ (sine * (indenter.height(r) + r * indenter.slope_at(r))) @ weight)


def _stretches(indenter: Profile, radii: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Lengths in theta of the stretches between breakpoints, r/a at their nodes, and the weights of Gauss's rule.

    Shapes (n, stretches), (n, stretches, nodes) and (nodes,); stretches beyond a radius have no length.
    """
    inside = [r for r in indenter.breakpoints if r < radii.max()]
    begins = np.arcsin(np.minimum(np.array([0.0, *inside]) / radii[:, None], 1.0))
    x, weight = legendre_rule(MOMENT_NODES)
    lengths = np.diff(begins, axis=1, append=np.pi / 2)
    return lengths, np.sin(begins[..., None] + 0.5 * lengths[..., None] * (1.0 + x)), weight

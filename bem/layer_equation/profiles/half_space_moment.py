"""What a profile takes off the half-space's force at a given depth: an integral of its heights."""

from __future__ import annotations

from typing import Final

import numpy as np

from bem.polynomials.gauss import legendre_rule
from contact import Profile

# Nodes of an integral over the profile between its breakpoints: that of a power of 1 or more is off by 32^-6 = 1e-9 of
# itself at most, a tenth of the linear solutions' error.
MOMENT_NODES: Final = 32


def half_space_moment(indenter: Profile, radius: float) -> float:
    """-F_N/E* at no depth [m^2] of a profile pressed into the half-space: 2 int_0^a f r/sqrt(a^2 - r^2) dr.

    With r = a sin(theta) the integrand is analytic between breakpoints; at a tip f begins like a power of theta.
    """
    inside = [r for r in indenter.breakpoints if r < radius]
    ends = np.append(np.arcsin(np.array([0.0, *inside]) / radius), np.pi / 2)
    x, weight = legendre_rule(MOMENT_NODES)
    sine = np.sin(ends[:-1, None] + 0.5 * np.diff(ends)[:, None] * (1.0 + x))
    return float(radius * np.diff(ends) @ (sine * indenter.height(radius * sine)) @ weight)

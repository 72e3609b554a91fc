"""Where the mesh may end: disturbances of a layer die out within a few thicknesses.

A disturbance of the bonded layer decays like ``exp(-s r / h)`` with s the smallest root of
``1 - 4 s^2 + kap^2 + 2 kap cos(2 s)`` (the kernel's denominator at q = i s), and the stiffness of a mesh with a free
outer edge errs like ``exp(-2 s (R - a) / h)``.  The unbonded layer has one bending-like mode, and a membrane mode
u_r = C / r that the spring on the outer edge carries exactly.
"""

from __future__ import annotations

import math

# Rate per thickness of the bending-like mode of an unbonded layer: smallest imaginary part of the complex roots of
# sinh(2 q) + 2 q = 0.
UNBONDED_DECAY = 2.10619612


def decay_rate(poissons_ratio: float, support: str) -> float:
    """Slowest exponential decay along the layer, per thickness."""
    if support == "unbonded":
        return UNBONDED_DECAY
    kolosov = 3 - 4 * poissons_ratio
    s, rest = 1.0, math.inf
    # Newton's steps from the middle of where the zero lies for all nu, 0.7 to 1.3; the last one is quadratically small.
    while abs(rest) > 1e-10:
        rest = (1 - 4 * s**2 + kolosov**2 + 2 * kolosov * math.cos(2 * s)) / (8 * s + 4 * kolosov * math.sin(2 * s))
        s += rest
    return s


def outer_distance(poissons_ratio: float, support: str, tolerance: float, least: float = 3.0) -> float:
    """Distance (R - a) / h at which the outer edge changes the stiffness by about ``tolerance``, relative."""
    return max(least, math.log(1 / tolerance) / (2 * decay_rate(poissons_ratio, support)))

"""Where the mesh may end: disturbances of a layer die out within a few thicknesses.

A disturbance of the bonded layer decays like ``exp(-s r / h)`` with s the smallest root of
``1 - 4 s^2 + kap^2 + 2 kap cos(2 s)`` (the kernel's denominator at q = i s), and the stiffness of a mesh with a free
outer edge errs like ``exp(-2 s (R - a) / h)``.  The unbonded layer has one bending-like mode, and a membrane mode
u_r = C / r that the spring on the outer edge carries exactly.
"""

from __future__ import annotations

import math
import sys

from contact.answer.lapack import compiled

# Rate per thickness of the bending-like mode of an unbonded layer: smallest imaginary part of the complex roots of
# sinh(2 q) + 2 q = 0.
UNBONDED_DECAY = 2.10619612


def decay_rate(poissons_ratio: float, support: str) -> float:
    """Slowest exponential decay along the layer, per thickness."""
    if support == "unbonded":
        return UNBONDED_DECAY
    kolosov = 3 - 4 * poissons_ratio

    def denominator(s: float) -> float:
        return 1 - 4 * s**2 + kolosov**2 + 2 * kolosov * math.cos(2 * s)

    # Brent's method behind `scipy.optimize.brentq`, in its order of arguments: xtol, rtol, iterations, and how it
    # answers. All of scipy.optimize would take 0.15 s to import.
    brent = compiled("scipy.optimize._zeros", "scipy.optimize._zeros")._brentq
    return float(brent(denominator, 0.7, 1.3, 1e-14, 4 * sys.float_info.epsilon, 100, (), False, True))


def outer_distance(poissons_ratio: float, support: str, tolerance: float) -> float:
    """Distance (R - a) / h at which the outer edge changes the stiffness by about ``tolerance``, relative."""
    return max(3.0, math.log(1 / tolerance) / (2 * decay_rate(poissons_ratio, support)))

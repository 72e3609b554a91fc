"""First guesses of the contact radius from the height of the profile.

They start searches and set the size of grids and tables; no answer depends on them. Lengths in metres.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

from contact.scene.profiles import Profile

# Range [m] of the search, which contains the radii of all scenes.
_RADII: Final = (1e-15, 1e15)
# Least guess a over the radius b of a flat end: searches begin with a - b, which has no correct digits at closer radii.
_NEXT_TO_FLAT: Final = 1.0 + 1e-12


def first_radius(indenter: Profile, reached: Callable[[float], bool]) -> float:
    """Smallest radius [m] beyond the flat end from which on a condition is true; the end of the profile if it never is.

    Bisection in the logarithm to the last digit, so that every unit system takes the same steps to within rounding.
    """
    low, high = max(_RADII[0], _NEXT_TO_FLAT * indenter.flat_radius), min(indenter.max_radius, _RADII[1])
    while low < (middle := math.sqrt(low * high)) < high:
        low, high = (low, middle) if reached(middle) else (middle, high)
    return high


def radius_of_depth(indenter: Profile, depth: float) -> float:
    """Radius r [m] at which f(r) equals the depth [m]."""
    return first_radius(indenter, lambda r: float(indenter.height(r)) >= depth)


def radius_of_load(indenter: Profile, load: float) -> float:
    """Radius r [m] at which r f(r) equals the load [m^2], a force over a multiple of E*."""
    return first_radius(indenter, lambda r: r * float(indenter.height(r)) >= load)


def radius_of_elongation(indenter: Profile, length: float) -> float:
    """Radius r [m] at which f(r) equals the elongation sqrt(2 pi length r) of a half-space; length [m] = dgamma/E*."""
    return first_radius(indenter, lambda r: float(indenter.height(r)) ** 2 >= 2.0 * math.pi * length * r)

"""First guesses of how far a contact reaches, from the profile alone: where it is as high as the loading asks for.

They start searches and size grids and tables; no answer rests on them. Lengths in metres.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

from contact.scene.profiles import Profile

# Radii [m] between which is looked; magnitudes of scenes lie well within.
_RADII: Final = (1e-15, 1e15)
# Least guess over the radius of a flat end: searches begin with a - b, which closer radii leave without digits.
_BESIDE_FLAT: Final = 1.0 + 1e-12


def first_radius(indenter: Profile, reached: Callable[[float], bool]) -> float:
    """The smallest radius [m] beyond the flat end from which on a condition holds; the profile's end, if it never does.

    Bisection in the logarithm to the last digit, so that every unit system takes the same steps to within rounding.
    """
    low, high = max(_RADII[0], _BESIDE_FLAT * indenter.flat_radius), min(indenter.max_radius, _RADII[1])
    while low < (middle := math.sqrt(low * high)) < high:
        low, high = (low, middle) if reached(middle) else (middle, high)
    return high


def radius_of_depth(indenter: Profile, depth: float) -> float:
    """Radius [m] where f(r) is the depth [m]."""
    return first_radius(indenter, lambda r: float(indenter.height(r)) >= depth)


def radius_of_load(indenter: Profile, load: float) -> float:
    """Radius [m] where r f(r) is the load [m^2], a force over some multiple of E*."""
    return first_radius(indenter, lambda r: r * float(indenter.height(r)) >= load)


def radius_of_elongation(indenter: Profile, length: float) -> float:
    """Radius [m] where f(r) is the critical elongation sqrt(2 pi length r) of a half-space; length [m] = dgamma/E*."""
    return first_radius(indenter, lambda r: float(indenter.height(r)) ** 2 >= 2.0 * math.pi * length * r)

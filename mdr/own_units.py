"""Dimensionless problems of power laws f = C r^n, which layers of equal ratios share.

Lengths are in the thickness h, depths in C h^n, forces in E* C h^(n+1).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

import numpy as np

from bem.kernels.moduli import contact_modulus
from contact import ElasticLayer, PowerLaw, Profile
from mdr.profiles import PowerTip, tip_of


@dataclass(frozen=True)
class OwnUnits:
    """A dimensionless problem and its units.

    Attributes:
        layer: The layer with thickness 1 and E* = 1.
        indenter: The power law f = r^n.
        length: Unit of length [m].
        depth: Unit of depth [m].
        stiffness: Unit of stiffness [N/m].
    """

    SCALES: ClassVar[tuple[str, ...]] = ("length", "depth", "stiffness")

    layer: ElasticLayer
    indenter: Profile
    length: float
    depth: float
    stiffness: float


def is_power_law(indenter: Profile) -> bool:
    """Whether the profile is a power law f = C r^n."""
    return isinstance(tip_of(indenter), PowerTip)


def own_units(layer: ElasticLayer, indenter: Profile) -> OwnUnits:
    """The dimensionless problem of a power law.

    Args:
        layer: Layer, stack or half-space.
        indenter: Power law.
    """
    length = 1.0 if layer.is_half_space else layer.thickness
    depth, stiffness = float(indenter.height(np.array([length]))[0]), contact_modulus(layer) * length
    return OwnUnits(layer.in_own_units(), _unit_power(tip_of(indenter).exponent), length, depth, stiffness)


@lru_cache(maxsize=64)
def _unit_power(exponent: float) -> PowerLaw:
    """The power law f = r^n, cached."""
    return PowerLaw(exponent=exponent, reference_radius=1.0, reference_height=1.0)

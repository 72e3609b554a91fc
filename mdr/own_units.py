"""Scenes that are one problem in their own units: a power law f = C r^n on layers that differ in scale.

With lengths in the thickness h, depths in C h^n and forces in E* C h^(n+1), every layer of the same ratios is the same.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar

from bem.kernels.moduli import contact_modulus
from contact import Cone, ElasticLayer, Layer, Paraboloid, PowerLaw, Profile
from contact.scene.layer import Support


@dataclass(frozen=True)
class OwnUnits:
    """A problem in its own units.

    Attributes:
        layer: The layer, of thickness 1 and E* = 1.
        indenter: f = r^n.
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


def power_law(indenter: Profile) -> tuple[float, float] | None:
    """C and n of f = C r^n; None for other profiles."""
    match indenter:
        case Paraboloid():
            return 0.5 / indenter.radius_of_curvature, 2.0
        case Cone():
            return indenter.slope, 1.0
        case PowerLaw():
            return indenter.reference_height / indenter.reference_radius**indenter.exponent, indenter.exponent
    return None


def own_units(layer: ElasticLayer, indenter: Profile, length: float = 1.0) -> OwnUnits:
    """A power law's problem in its own units.

    Args:
        layer: Layer, stack or half-space.
        indenter: Power law.
        length: Unit of length [m] on the half-space, which has none of its own.

    Raises:
        TypeError: If the indenter is no power law.
    """
    law = power_law(indenter)
    if law is None:
        raise TypeError(f"{type(indenter).__name__} is no power law")
    coefficient, exponent = law
    length = length if layer.is_half_space else layer.thickness
    depth, stiffness = coefficient * length**exponent, contact_modulus(layer) * length
    alike = _uniform(layer.support, layer.poissons_ratio, layer.is_half_space) if isinstance(layer, Layer) else None
    return OwnUnits(alike or layer.in_own_units(), _unit_power(exponent), length, depth, stiffness)


@lru_cache(maxsize=64)
def _uniform(support: Support, poissons_ratio: float, is_half_space: bool) -> Layer:
    """One record for all uniform layers that are alike, so that caches find it by identity."""
    thickness = math.inf if is_half_space else 1.0
    layer = Layer(thickness=thickness, youngs_modulus=1.0, poissons_ratio=poissons_ratio, support=support)
    return layer.in_own_units()


@lru_cache(maxsize=64)
def _unit_power(exponent: float) -> PowerLaw:
    """f = r^n."""
    return PowerLaw(exponent=exponent, reference_radius=1.0, reference_height=1.0)

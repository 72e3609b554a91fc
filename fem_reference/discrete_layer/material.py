"""Moduli in units of the contact modulus E* = E / (1 - nu^2)."""

from __future__ import annotations

from dataclasses import dataclass

from contact import InvalidInput, Layer


@dataclass(frozen=True)
class Moduli:
    """Shear modulus and compressibility.

    Attributes:
        shear: shear modulus mu.
        compressibility: 1/K, zero for an incompressible material.
    """

    shear: float
    compressibility: float

    @property
    def bulk(self) -> float:
        """Bulk modulus K.

        Raises:
            InvalidInput: the material is incompressible.
        """
        if self.compressibility == 0:
            raise InvalidInput("a displacement formulation needs nu < 0.5: take a mixed pair such as P3P2")
        return 1 / self.compressibility


def moduli(poissons_ratio: float) -> Moduli:
    """Moduli at E* = 1: ``mu = (1 - nu) / 2``, ``1/K = 3 (1 - 2 nu) / (2 mu (1 + nu))``."""
    nu = poissons_ratio
    mu = (1 - nu) / 2
    return Moduli(mu, 3 * (1 - 2 * nu) / (2 * mu * (1 + nu)))


def shear_modulus(layer: Layer) -> float:
    """Lame's mu = E / (2 (1 + nu)) [Pa]."""
    return layer.youngs_modulus / (2 * (1 + layer.poissons_ratio))


def contact_modulus(layer: Layer) -> float:
    """The unit of stress of finite elements [Pa]: what makes Lame's mu of `moduli` that of the layer."""
    return shear_modulus(layer) / moduli(layer.poissons_ratio).shear

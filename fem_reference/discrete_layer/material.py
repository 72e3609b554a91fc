"""Moduli in units of the contact modulus E* = E / (1 - nu^2)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from contact.records.errors import InvalidInput
from contact.records.validation import FloatArray, IntArray
from contact.scene.layer import ElasticLayer


@dataclass(frozen=True)
class PointModuli:
    """Shear modulus and compressibility at points, or of all of them, each of a shape that fits theirs."""

    shear: FloatArray
    compressibility: FloatArray


class ElasticConstants(Protocol):
    """What the points of a mesh are made of."""

    def on(self, triangles: IntArray) -> PointModuli:
        """At the quadrature points of triangles, shape (triangle, point) or ()."""

    def at(self, triangles: IntArray, depth: FloatArray) -> PointModuli:
        """At one point of each of n triangles, at depths z, shape (n,) or ()."""


@dataclass(frozen=True)
class Moduli:
    """Shear modulus and compressibility.

    Attributes:
        shear: shear modulus mu.
        compressibility: 1/K, zero for an incompressible material.
    """

    shear: float
    compressibility: float

    def on(self, triangles: IntArray) -> PointModuli:
        """The same at every point."""
        return PointModuli(np.asarray(self.shear), np.asarray(self.compressibility))

    def at(self, triangles: IntArray, depth: FloatArray) -> PointModuli:
        """The same at every point."""
        return self.on(triangles)

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


def shear_modulus(layer: ElasticLayer) -> float:
    """Lame's mu = E / (2 (1 + nu)) [Pa] at the surface."""
    return layer.surface.youngs_modulus / (2 * (1 + layer.surface.poissons_ratio))


def contact_modulus(layer: ElasticLayer) -> float:
    """The unit of stress of finite elements [Pa]: what makes Lame's mu of `moduli` that of the surface."""
    return shear_modulus(layer) / moduli(layer.surface.poissons_ratio).shear

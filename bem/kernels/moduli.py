"""Moduli of a layer, as boundary elements and MDR derive them from what the user gave."""

from __future__ import annotations

import math

from contact.scene.elastic_layer import ElasticLayer
from contact.scene.layer import Layer


def contact_modulus(layer: ElasticLayer) -> float:
    """E* = E / (1 - nu^2) [Pa], of the half-space that the surface resembles from near."""
    surface = layer.surface
    nu = surface.poissons_ratio
    return surface.youngs_modulus / ((1.0 - nu) * (1.0 + nu))


def confined_modulus(layer: Layer) -> float:
    """Modulus of uniaxial strain, E (1 - nu) / ((1 + nu) (1 - 2 nu)) [Pa], Eq. (16); infinite at nu = 1/2."""
    nu = layer.poissons_ratio
    return math.inf if nu == 0.5 else layer.youngs_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))


def shear_modulus(layer: ElasticLayer) -> float:
    """G = E / (2 (1 + nu)) [Pa], at the surface."""
    return layer.surface.youngs_modulus / (2.0 * (1.0 + layer.surface.poissons_ratio))

"""Moduli of a layer, as boundary elements and MDR derive them from what the user gave."""

from __future__ import annotations

import math

import numpy as np

from contact.scene.effects import Relaxation, Viscoelasticity
from contact.scene.layer import ElasticLayer, Layer
from contact.scene.scene import Scene


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


def relaxation_of(scene: Scene) -> Relaxation:
    """The scene's shear relaxation, constant for an elastic layer.

    Branches stand in the order of their relaxation times and each time stands once, so the order in which a user lists
    them makes no difference.
    """
    model = scene.effect(Viscoelasticity)
    if model is None:
        return Relaxation(
            long_term_modulus=shear_modulus(scene.layer), moduli=np.empty(0), times=np.empty(0), viscosity=0.0
        )
    relaxation = model.relaxation
    if relaxation.moduli.size == 1 and relaxation.moduli[0] > 0.0:
        return relaxation
    order = np.lexsort((relaxation.moduli, relaxation.times))
    order = order[relaxation.moduli[order] > 0.0]
    times, first = np.unique(relaxation.times[order], return_index=True)
    return Relaxation(
        long_term_modulus=relaxation.long_term_modulus,
        moduli=np.add.reduceat(relaxation.moduli[order], first) if first.size else np.empty(0),
        times=times,
        viscosity=relaxation.viscosity,
    )

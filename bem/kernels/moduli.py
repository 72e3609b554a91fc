"""Contact modulus of a layer and relaxation function of a scene, for boundary elements and MDR."""

from __future__ import annotations

import dataclasses

import numpy as np

from contact.scene.effects import Relaxation, Viscoelasticity
from contact.scene.layer import ElasticLayer
from contact.scene.scene import Scene


def contact_modulus(layer: ElasticLayer) -> float:
    """E* = E / (1 - nu^2) [Pa] of the material at the surface."""
    surface = layer.surface
    nu = surface.poissons_ratio
    return surface.youngs_modulus / ((1.0 - nu) * (1.0 + nu))


def relaxation_of(scene: Scene) -> Relaxation:
    """Shear relaxation function of the scene, constant for an elastic layer.

    Branches are sorted by relaxation time, and branches of equal times are added, so the order of the input has no
    influence.
    """
    model = scene.effect(Viscoelasticity)
    if model is None:
        none = np.empty(0)
        return Relaxation(long_term_modulus=scene.layer.shear_modulus, moduli=none, times=none, viscosity=0.0)
    relaxation = model.relaxation
    order = np.lexsort((relaxation.moduli, relaxation.times))
    order = order[relaxation.moduli[order] > 0.0]
    times, first = np.unique(relaxation.times[order], return_index=True)
    moduli = np.add.reduceat(relaxation.moduli[order], first) if first.size else np.empty(0)
    return dataclasses.replace(relaxation, moduli=moduli, times=times)

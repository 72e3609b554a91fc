"""Batches answer as their scenes do one by one, in their order, and say how far they are."""

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    NormalForces,
    Paraboloid,
    PowerLaw,
    Scene,
    TruncatedCone,
)
from mdr import Mdr
from mdr.batches import equilibria

PUNCH = IntegralEquation()
RNG = np.random.default_rng(7)
INDENTERS = (
    Paraboloid(radius_of_curvature=0.02),
    Paraboloid(radius_of_curvature=0.005),
    Cone(slope=0.1),
    PowerLaw(exponent=4.0, reference_radius=1e-3, reference_height=2e-4),
    TruncatedCone(flat_radius=2e-4, slope=0.1),
    FlatPunch(radius=1e-3),
)
LAYERS = (
    Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.4),
    Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45),
    Layer(thickness=3e-4, youngs_modulus=2e6, poissons_ratio=0.45),
    Layer(thickness=2e-3, youngs_modulus=3e6, poissons_ratio=0.3, support="unbonded"),
)


def shuffled(scenes):
    return [scenes[i] for i in RNG.permutation(len(scenes))]


def test_equilibria_are_what_single_scenes_say():
    scenes = shuffled(
        [
            Scene(layer=layer, indenter=indenter, loading=loading)
            for layer in LAYERS
            for indenter in INDENTERS
            for loading in (ContactRadii([1.5e-3]), IndentationDepths([2e-5]), NormalForces([0.1]))
            if not (isinstance(indenter, FlatPunch) and isinstance(loading, ContactRadii))
        ]
    )
    together = equilibria(scenes, PUNCH)
    for i, scene in enumerate(scenes):
        alone = Mdr(flat_punch=PUNCH).solve(scene)
        for name in ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness"):
            assert getattr(together, name)[i] == pytest.approx(getattr(alone, name)[0], rel=1e-12, abs=0.0), (
                name,
                scene,
            )


def test_what_a_batch_refuses():
    scene = Scene(layer=LAYERS[1], indenter=INDENTERS[0], loading=ContactRadii([1e-3, 2e-3]))
    with pytest.raises(InvalidInput, match=r"scenes\[0\].loading: give one"):
        equilibria([scene], PUNCH)
    adhesive = scene.replace(effects=(Adhesion(work_of_adhesion=0.1),))
    with pytest.raises(InvalidInput, match=r"scenes\[0\].effects"):
        equilibria([adhesive], PUNCH)

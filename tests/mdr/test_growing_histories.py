"""Histories of the force: on elastic layers, and beyond the end of the indenter."""

import numpy as np
import pytest

from contact import (
    ForceHistory,
    InvalidInput,
    Layer,
    NormalForces,
    Scene,
    StandardSolid,
    Tabulated,
    TruncatedCone,
)
from mdr import Mdr

SOLID = StandardSolid(long_term_shear_modulus=0.25, maxwell_shear_modulus=0.75, viscosity=0.75)
LAYER = Layer.incompressible(thickness=1.0, shear_modulus=1.0)


def test_an_elastic_layer_knows_the_present_only():
    force = np.array([0.0, 0.02, 0.01, 0.0])
    scene = Scene(
        layer=LAYER,
        indenter=TruncatedCone(flat_radius=0.3, slope=0.2),
        loading=ForceHistory(time=np.arange(4.0), force=force),
    )
    answer, alone = Mdr().solve(scene), Mdr().solve(scene.replace(loading=NormalForces(force[1:3])))
    for name in ("indentation_depth", "contact_radius"):
        pressed = pytest.approx(getattr(alone, name), rel=1e-13, abs=0.0)
        assert getattr(answer, name)[1:3] == pressed
        assert getattr(answer, name)[[0, 3]].tolist() == [0.0, 0.0]


def test_a_force_beyond_the_rim_is_refused_by_its_name():
    scene = Scene(
        layer=LAYER,
        indenter=Tabulated(radii=[0.0, 0.1, 0.2], heights=[0.0, 0.01, 0.05]),
        loading=ForceHistory(time=[0.0, 1.0], force=[0.0, 5.0]),
        effects=(SOLID,),
    )
    with pytest.raises(InvalidInput, match=r"loading.force, as an elastic layer .* the indenter ends at a radius of"):
        Mdr().solve(scene)

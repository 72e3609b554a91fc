"""Forces that never fall, against matrix exponentials of 60 digits."""

import numpy as np
import pytest

from contact import (
    Cone,
    ForceHistory,
    InvalidInput,
    KelvinVoigt,
    Layer,
    NormalForces,
    Paraboloid,
    PronySeries,
    Scene,
    StandardSolid,
    Tabulated,
    TruncatedCone,
)
from mdr import Mdr

SOLID = StandardSolid(long_term_shear_modulus=0.25, maxwell_shear_modulus=0.75, viscosity=0.75)
LIQUID = PronySeries(long_term_shear_modulus=0.0, shear_moduli=[0.3, 0.7], relaxation_times=[0.1, 2.0])
DASHPOT = KelvinVoigt(shear_modulus=1.0, viscosity=0.5)
LAYER = Layer.incompressible(thickness=1.0, shear_modulus=1.0)
HALF_SPACE = Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5)


COMPARED = ("indentation_depth", "contact_radius")


@pytest.mark.parametrize(
    ("layer", "indenter", "model"),
    [
        (LAYER, Paraboloid(radius_of_curvature=2.0), SOLID),
        (HALF_SPACE, Cone(slope=0.2), LIQUID),
        (LAYER, TruncatedCone(flat_radius=0.3, slope=0.2), DASHPOT),
    ],
)
def test_depths_under_a_force_that_never_falls_need_no_steps(layer, indenter, model):
    loading = ForceHistory(time=[0.0, 0.3, 3.0], force=[0.0, 0.02, 0.02])
    scene = Scene(layer=layer, indenter=indenter, loading=loading, effects=(model,))
    found = Mdr().solve(scene)
    for name in COMPARED:
        assert np.all(found.error_estimate[name] < 1e-12), name


def test_a_dashpot_beside_a_flat_end_is_answered():
    """Springs stepped in time stated 1.4e-5; asked for 1e-6 they did not resolve it, and it was refused."""
    scene = Scene(
        layer=LAYER,
        indenter=TruncatedCone(flat_radius=0.3, slope=0.2),
        loading=ForceHistory(time=[0.0, 0.0667, 0.1014, 1.0844], force=[0.0, 0.0, 0.0023, 0.02]),
        effects=(DASHPOT.replace(viscosity=0.014),),
    )
    answer = Mdr().solve(scene)
    assert np.all(answer.error_estimate["indentation_depth"] < 1e-12)
    assert answer.indentation_depth[1] == 0.0


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

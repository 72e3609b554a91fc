"""Only the effects that a scene lists are imported, called and paid for."""

from contact import Adhesion, ContactRadii, Detachment, Layer, Paraboloid, Scene
from mdr import Mdr
from tests.mdr.viscoelastic_scenes import figure_12


def stages(path):
    return {stage.name for stage in path.stages}


def elastic(effects=(), loading=None):
    return Scene(
        layer=Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45),
        indenter=Paraboloid(radius_of_curvature=0.01),
        loading=loading or ContactRadii([1e-3]),
        effects=effects,
    )


def test_stage_records_name_what_ran():
    bare = stages(Mdr().solve(elastic()))
    adhesion = (Adhesion(work_of_adhesion=0.05),)
    assert not bare & {"adhesion", "impact", "history"}
    assert "adhesion" in stages(Mdr().solve(elastic(adhesion)))
    assert "adhesion" in stages(Mdr().solve(elastic(adhesion, Detachment())))
    impact = stages(Mdr().solve(figure_12(1e-3)))
    assert "impact" in impact
    assert "adhesion" not in impact

"""Depths over the thickness: a note from a tenth on, a refusal from one on unless the scene says so."""

import json

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from contact import (
    Adhesion,
    ContactRadii,
    DepthHistory,
    Detachment,
    ElasticBase,
    ForceHistory,
    Impact,
    IndentationDepths,
    KelvinVoigt,
    Layer,
    LayerStack,
    NormalForces,
    Paraboloid,
    Scene,
    Sublayer,
    UnsupportedSceneError,
    load_scene,
    scene_from_mapping,
    scene_to_mapping,
)
from fem_reference import Fem
from mdr import Mdr
from mdr.batches import equilibria, impacts
from mdr.curves import fit_curve
from reports.command_line import run

LAYER = Layer(thickness=5e-6, youngs_modulus=5e3, poissons_ratio=0.45)
BALL = Paraboloid(radius_of_curvature=1e-5)
DEEP = """{flag}
layer = {{thickness = "5 um", youngs_modulus = "5 kPa", poissons_ratio = 0.5}}
indenter = {{kind = "paraboloid", radius_of_curvature = "10 um"}}
loading = {{kind = "indentation_depths", values = ["{depth} um"]}}
"""
# Each presses BALL between 1.2 and 5 thicknesses deep.
LOADINGS = {
    "radii": ContactRadii([2e-5]),
    "depths": IndentationDepths([1e-7, 1e-5]),
    "forces": NormalForces([1e-4]),
    "depth history": DepthHistory(time=[0.0, 1.0], depth=[0.0, 1e-5]),
    "force history": ForceHistory(time=[0.0, 1.0], force=[0.0, 1e-4]),
    "impact": Impact(mass=1e-9, velocity=1.0),
}


def scene(loading, **changes):
    return Scene(**({"layer": LAYER, "indenter": BALL, "loading": loading} | changes))


@pytest.mark.parametrize("name", LOADINGS)
def test_depths_from_the_thickness_on_are_refused_under_every_loading(name):
    with pytest.raises(UnsupportedSceneError, match=r"layer is 5e-06 m thick.* beyond_small_strains = true"):
        Mdr().solve(scene(LOADINGS[name]))
    answer = Mdr().solve(scene(LOADINGS[name], beyond_small_strains=True))
    assert "of the layer's thickness: small strains are assumed" in answer.notes[0]
    assert "note: the depth is" in repr(answer)


@pytest.mark.first(1)
@pytest.mark.parametrize("method", [Mdr(), Fem(order=2, edge_cell=1e-3)], ids=lambda m: m.name)
def test_every_method_refuses_and_notes(method):
    with pytest.raises(UnsupportedSceneError, match="beyond_small_strains"):
        method.solve(scene(NormalForces([1e-4])))
    assert "the depth is 0.1 of" in method.solve(scene(IndentationDepths([5e-7]))).notes[0]
    assert not method.solve(scene(IndentationDepths([4e-7]))).notes


def test_detachments_that_begin_too_deep_are_refused():
    start = scene(Detachment(initial_contact_radius=2e-5), effects=(Adhesion(work_of_adhesion=1e-5),))
    with pytest.raises(UnsupportedSceneError, match="beyond_small_strains"):
        Mdr().solve(start)


def test_half_spaces_and_soft_bases_have_no_limit_and_stiff_bases_have():
    half_space = Layer.half_space(youngs_modulus=5e3, poissons_ratio=0.5)
    assert not Mdr().solve(scene(IndentationDepths([1e-3]), layer=half_space)).notes

    def film(modulus):
        base = ElasticBase(youngs_modulus=modulus, poissons_ratio=0.5)
        sublayers = (Sublayer(thickness=5e-6, youngs_modulus=5e3, poissons_ratio=0.45),)
        return scene(IndentationDepths([6e-6]), layer=LayerStack(sublayers=sublayers, support=base))

    assert not Mdr().solve(film(1e3)).notes
    with pytest.raises(UnsupportedSceneError, match="beyond_small_strains"):
        Mdr().solve(film(1e6))


def test_batches_refuse_with_the_number_of_the_scene():
    scenes = [scene(IndentationDepths([depth])) for depth in (1e-7, 1e-5)]
    with pytest.raises(UnsupportedSceneError, match=r"scenes\[1\]: depth = 1e-05 m"):
        equilibria(scenes, IntegralEquation())
    assert np.isfinite(equilibria(scenes[:1], IntegralEquation()).normal_force).all()
    falls = [scene(LOADINGS["impact"], effects=(KelvinVoigt(shear_modulus=LAYER.shear_modulus, viscosity=1e-3),))]
    with pytest.raises(UnsupportedSceneError, match="beyond_small_strains"):
        impacts(falls, IntegralEquation())


def test_fits_beyond_the_thickness_warn():
    depth = np.linspace(1e-7, 6e-6, 30)
    force = Mdr().solve(scene(IndentationDepths(depth), beyond_small_strains=True)).normal_force
    fit = fit_curve(scene(IndentationDepths([1e-6])), depth, force, parameters=("youngs_modulus",))
    assert fit.values["youngs_modulus"] == pytest.approx(5e3, rel=1e-6, abs=0.0)
    assert "the depth is 1.2 of the layer's thickness" in fit.warnings[0]


def test_the_command_line_warns_above_the_table_and_refuses(tmp_path, capsys):
    file = tmp_path / "scene.toml"

    def told(depth, flag=""):
        file.write_text(DEEP.format(depth=depth, flag=flag))
        code = run(["solve", str(file)])
        return code, " ".join("".join(capsys.readouterr()).split())

    code, text = told(18.7)
    assert code == 4
    assert "depth = 1.87e-05 m: the layer is 5e-06 m thick" in text
    code, text = told(18.7, "beyond_small_strains = true")
    assert code == 0
    assert text.startswith("warning: the depth is 3.7 of the layer's thickness")
    assert text.count("the depth is 3.7") == 1
    assert told(0.5)[1].startswith("warning: the depth is 0.1 of")
    assert "warning" not in told(0.4)[1]


def test_the_flag_is_kept_in_files_and_absent_where_it_is_not_set(tmp_path):
    deep, plain = scene(IndentationDepths([1e-7]), beyond_small_strains=True), scene(IndentationDepths([1e-7]))
    assert scene_from_mapping(json.loads(json.dumps(scene_to_mapping(deep)))) == deep != plain
    assert "beyond_small_strains" not in scene_to_mapping(plain)
    file = tmp_path / "scene.toml"
    file.write_text(DEEP.format(depth=1, flag="beyond_small_strains = true"))
    assert load_scene(file).beyond_small_strains

"""Scene files with and without units on the command line: mixtures are refused, bare numbers are SI."""

from __future__ import annotations

import re

import pytest

from contact import GradedLayer, load_scene
from reports.command_line import run

MIXED = """
layer = {thickness = 5, youngs_modulus = "5 kPa", poissons_ratio = 0.5}
indenter = {kind = "paraboloid", radius_of_curvature = "10 um"}
loading = {kind = "indentation_depths", values = [0, "0.1 um", 2e-7]}
"""
WITH_UNITS = MIXED.replace("= 5,", '= "5 um",').replace("2e-7", '"0.2 um"')
BARE = MIXED.replace("= 5,", "= 5e-6,").replace('"5 kPa"', "5e3").replace('"10 um"', "1e-5").replace('"0.1 um"', "1e-7")


@pytest.fixture
def told(tmp_path, capsys):
    """Returns a function of scene and arguments: exit code and output, white space as single blanks."""
    return lambda text, *arguments: answer(tmp_path, capsys, text, *arguments)


def answer(tmp_path, capsys, text, *arguments):
    file = tmp_path / "scene.toml"
    file.write_text(text)
    (tmp_path / "depths.csv").write_text("depth\n1e-7\n2e-7\n")
    code = run([arguments[0], str(file), *arguments[1:]])
    return code, re.sub(r"\s+", " ", "".join(capsys.readouterr()))


def test_a_scene_with_some_units_names_the_bare_fields_and_the_remedy(told):
    code, text = told(MIXED, "solve")
    assert code == 4
    assert "layer.thickness = 5: no unit" in text
    assert "loading.values = [0, '0.1 um', 2e-07]: no unit" in text
    assert "('5 kPa')" in text
    assert 'as in "5 um", or none of them (SI)' in text


@pytest.mark.parametrize(
    "column",
    ['{file = "depths.csv"}', '{start = 1e-7, stop = "1 um", count = 3}', '[{value = 1}, "1 um", 3]'],
)
def test_columns_and_ranges_without_units_beside_units_are_refused(told, column):
    code, text = told(re.sub(r"values = \[.*\]", f"values = {column}", WITH_UNITS), "solve")
    assert code == 4
    assert "loading.values" in text


def test_tables_over_depth_and_effects_take_part(told, tmp_path):
    text = WITH_UNITS + 'effects = [{kind = "adhesion", work_of_adhesion = 1e-5}]\n'
    assert "effects[0].work_of_adhesion = 1e-05: no unit" in told(text, "solve")[1]
    graded = """{kind = "graded_layer", thickness = "5 um", youngs_modulus = {kind = "tabulated_depth",
        depths = ["0 um", "5 um"], values = ["1 kPa", "2 kPa"]},
        poissons_ratio = {kind = "tabulated_depth", depths = ["0 um", "5 um"], values = [0.4, 0.45]}}"""
    file = tmp_path / "graded.toml"
    file.write_text(re.sub(r"\{thickness.*\}", graded.replace("\n", ""), WITH_UNITS))
    assert isinstance(load_scene(file).layer, GradedLayer)


@pytest.mark.parametrize("text", [WITH_UNITS, BARE], ids=["units", "bare"])
def test_all_units_or_none_give_one_answer_that_repeats_the_scene_with_units(told, text):
    code, shown = told(text, "solve")
    assert code == 0
    assert "scene: Layer(thickness=5 µm, youngs_modulus=5 kPa, poissons_ratio=0.5, support='bonded')" in shown
    assert "Paraboloid(radius_of_curvature=10 µm), IndentationDepths(values=[0 ... 200] nm (3 values))" in shown


@pytest.mark.parametrize("over", ["thickness=2..50:3", "thickness=2..50um:3", "thickness=2um..5e-5:3"])
def test_bare_ends_of_a_sweep_beside_units_are_refused(told, over):
    code, text = told(WITH_UNITS, "solve", "--over", over)
    assert code == 4
    assert "no unit, but the scene or the other end has" in text


def test_a_sweep_has_units_as_its_scene_has(told):
    assert told(WITH_UNITS, "solve", "--over", "thickness=2um..50um:3:log")[0] == 0
    assert told(WITH_UNITS, "solve", "--over", "poissons_ratio=0.4..0.5:3")[0] == 0
    assert told(BARE, "solve", "--over", "thickness=2e-6..5e-5:3")[0] == 0


def test_uncertain_ranges_take_units_and_need_them_beside_units(told):
    code, text = told(WITH_UNITS, "solve", "--uncertain", "thickness=4e-6..6e-6")
    assert code == 4
    assert "no unit, but the scene" in text
    for inputs in ("thickness=4um..6um", "thickness=5%, poissons_ratio=0.4..0.5"):
        assert told(WITH_UNITS, "solve", "--uncertain", inputs)[0] == 0
    assert told(BARE, "solve", "--uncertain", "thickness=4e-6..6e-6")[0] == 0

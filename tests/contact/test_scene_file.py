"""Scenes in TOML: what is written is what is read; what is wrong is named by file, place, value and remedy."""

from __future__ import annotations

import pytest

from contact import (
    Adhesion,
    ContactRadii,
    InvalidInput,
    Layer,
    Scene,
    TruncatedCone,
    load_scene,
    scene_from_mapping,
)

GOOD = """
[layer]
thickness = 1e-3
youngs_modulus = 1e6
poissons_ratio = 0.45
support = "unbonded"

[indenter]
kind = "truncated_cone"
flat_radius = 0.5e-3
slope = 0.1

[loading]
kind = "contact_radii"
values = [1e-3, 2e-3]

[[effects]]
kind = "adhesion"
work_of_adhesion = 0.05
"""

SCENE = Scene(
    layer=Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.45, support="unbonded"),
    indenter=TruncatedCone(flat_radius=0.5e-3, slope=0.1),
    loading=ContactRadii([1e-3, 2e-3]),
    effects=(Adhesion(work_of_adhesion=0.05),),
)


EXAMPLE_SCENE_TABLES = """
[layer]
thickness = 1e-3
youngs_modulus = 1e6
poissons_ratio = 0.45
[indenter]
kind = "cone"
slope = 0.1
[loading]
kind = "indentation_depths"
values = [2e-6]
"""


def write(folder, text):
    file = folder / "scene.toml"
    file.write_text(text, encoding="utf-8")
    return file


def test_a_good_file_is_the_scene_it_describes(tmp_path):
    assert load_scene(write(tmp_path, GOOD)) == SCENE


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("values = [1e-3, 2e-3]", "values = [2e-3, 1e-3]", r"loading\.values = .*must increase strictly"),
        ("work_of_adhesion = 0.05", "work_of_adhesion = -1", r"effects\[0\]\.work_of_adhesion = -1: must be finite"),
        (
            "thickness = 1e-3",
            "thickness = 1e-3\nhalf_space = true",
            r"layer\.thickness = 0\.001: a half-space has none",
        ),
        ("thickness = 1e-3", "half_space = 1", r"layer\.half_space = 1: must be true or false"),
        ("values = [1e-3, 2e-3]", "values = [1e-4]", r"scene: loading\.values = 0\.0001: the indenter's flat end"),
    ],
)
def test_what_is_wrong_is_named(tmp_path, old, new, message):
    file = write(tmp_path, GOOD.replace(old, new, 1))
    with pytest.raises(InvalidInput, match=message) as caught:
        load_scene(file)
    assert str(file) in str(caught.value)


@pytest.mark.parametrize("text", ["", " \n\t\n"])
def test_an_empty_file_is_told_what_a_scene_needs(tmp_path, text):
    with pytest.raises(InvalidInput, match=r"the file is empty; a scene needs \[layer\], \[indenter\] and \[loading\]"):
        load_scene(write(tmp_path, text))


def test_a_missing_file_a_folder_and_a_binary_are_refused(tmp_path):
    with pytest.raises(InvalidInput, match="cannot be read"):
        load_scene(tmp_path / "none.toml")
    with pytest.raises(InvalidInput, match="cannot be read"):
        load_scene(tmp_path)
    (tmp_path / "b.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InvalidInput, match="not a text file"):
        load_scene(tmp_path / "b.toml")


def test_a_device_without_an_end_is_refused():
    """It has no size to look at; reading it ended with the memory."""
    with pytest.raises(InvalidInput, match="more than a scene can have"):
        load_scene("/dev/zero")


def test_tables_in_tables_are_refused_however_deep(tmp_path):
    file = tmp_path / "deep.toml"
    file.write_text(".".join("a" * 3000) + " = 1\n" + EXAMPLE_SCENE_TABLES)
    with pytest.raises(InvalidInput, match="a = a huge dict: no such field"):
        load_scene(file)
    deep = 1
    for _ in range(3000):
        deep = {"a": deep}
    with pytest.raises(InvalidInput, match="a = a huge dict: no such field"):
        scene_from_mapping(deep)
    with pytest.raises(InvalidInput, match=r"layer\.a = a huge dict"):
        scene_from_mapping({"layer": deep, "indenter": {}, "loading": {}})


@pytest.mark.parametrize(("value", "place"), [("1e-300", "loading.values"), ("1e300", "loading.values")])
def test_numbers_whose_products_leave_double_precision_are_refused(tmp_path, value, place):
    """They divided by zero, or never ended, far inside."""
    file = tmp_path / "extreme.toml"
    file.write_text(EXAMPLE_SCENE_TABLES.replace("2e-6", value))
    with pytest.raises(InvalidInput, match=f"{place}.*between 1e-75 and 1e[+]75"):
        load_scene(file)


def test_deep_nesting_is_refused(tmp_path):
    with pytest.raises(InvalidInput):
        load_scene(write(tmp_path, "a = " + "[" * 50_000))

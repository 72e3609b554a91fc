"""Scenes in TOML: what is written is what is read; what is wrong is named by file, place, value and remedy."""

from __future__ import annotations

import json

import numpy as np
import pytest

from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    DepthHistory,
    Detachment,
    FlatPunch,
    ForceHistory,
    Impact,
    IndentationDepths,
    InvalidInput,
    Layer,
    NormalForces,
    Paraboloid,
    PronySeries,
    Scene,
    Tabulated,
    TruncatedCone,
    load_scene,
    scene_from_mapping,
    scene_to_mapping,
)
from contact.records.tables import MAX_BYTES

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

SOFT = Layer.incompressible(thickness=1 / 3, shear_modulus=0.3)
PRONY = PronySeries(long_term_shear_modulus=0.1, shear_moduli=[0.1, 0.1], relaxation_times=[1.0, 10.0])
ADHESION = Adhesion(work_of_adhesion=0.1)
SCENES = (
    SCENE,
    Scene(
        layer=Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.1),
        indenter=Cone(slope=0.1),
        loading=IndentationDepths([0.1]),
    ),
    Scene(layer=SOFT, indenter=FlatPunch(radius=0.1), loading=NormalForces([-0.1, 0.3]), effects=(ADHESION,)),
    Scene(layer=SOFT, indenter=FlatPunch(radius=0.1), loading=Detachment(control="force"), effects=(ADHESION,)),
    Scene(
        layer=SOFT,
        indenter=Paraboloid(radius_of_curvature=1.0),
        loading=Detachment(initial_contact_radius=0.2),
        effects=(ADHESION,),
    ),
    Scene(
        layer=SOFT,
        indenter=Tabulated(radii=[0.0, 0.1, 0.3], heights=[0.0, 0.1, 0.2]),
        loading=Impact(mass=0.1, velocity=2.0),
        effects=(PRONY,),
    ),
    Scene(
        layer=SOFT,
        indenter=Cone(slope=0.1),
        loading=DepthHistory(time=[0.0, 0.1], depth=[0.0, 0.3]),
        effects=(PRONY,),
    ),
    Scene(
        layer=SOFT,
        indenter=Cone(slope=0.1),
        loading=ForceHistory(time=[0.0, 0.1], force=[0.0, 0.3]),
        effects=(PRONY,),
    ),
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


@pytest.mark.parametrize("scene", SCENES, ids=lambda s: f"{type(s.indenter).__name__}-{type(s.loading).__name__}")
def test_every_scene_survives_a_round_trip_through_json(scene):
    assert scene_from_mapping(json.loads(json.dumps(scene_to_mapping(scene), allow_nan=False))) == scene


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("poissons_ratio = 0.45", "poissons_ratio = nan", r"layer\.poissons_ratio = nan: must lie in"),
        ("values = [1e-3, 2e-3]", "values = [2e-3, 1e-3]", r"loading\.values = .*must increase strictly"),
        ("values = [1e-3, 2e-3]", 'values = "1e-3"', r"loading\.values = '1e-3': must be a list"),
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


def test_a_huge_file_is_refused_before_it_is_read(tmp_path):
    file = tmp_path / "huge.toml"
    with file.open("wb") as stream:
        stream.truncate(MAX_BYTES + 1)  # sparse: takes no disk
    with pytest.raises(InvalidInput, match="more than a scene can have"):
        load_scene(file)


def test_deep_nesting_is_refused(tmp_path):
    with pytest.raises(InvalidInput):
        load_scene(write(tmp_path, "a = " + "[" * 50_000))


def test_numbers_survive_to_the_last_bit(tmp_path):
    thickness = float(np.nextafter(1e-3, 1.0))
    file = write(tmp_path, GOOD.replace("thickness = 1e-3", f"thickness = {thickness!r}"))
    assert load_scene(file).layer.thickness == thickness

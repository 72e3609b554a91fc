"""The schema of scene files: the published file is that of the code, and both judge the same scenes alike."""

import json
import tomllib
from pathlib import Path

import jsonschema
import pytest

from contact import InvalidInput, scene_from_mapping
from contact.files.scene_file import scene_schema
from contact.scene.effects import EFFECTS
from contact.scene.loading import LOADINGS
from contact.scene.profiles import PROFILES
from contact.scene.shapes import SHAPES

EXAMPLES = Path(__file__).parents[2] / "examples"
SCHEMA = scene_schema()
VALID = {
    "layer": {"thickness": 1e-3, "youngs_modulus": 1e6, "poissons_ratio": 0.3},
    "indenter": {"kind": "cone", "slope": 0.1},
    "loading": {"kind": "contact_radii", "values": [1e-3]},
}


# Built once: checking the schema itself for every mapping takes ten times as long.
VALIDATOR = jsonschema.validators.validator_for(SCHEMA)(SCHEMA)


def accepted(mapping):
    return VALIDATOR.is_valid(mapping)


def test_the_published_file_is_that_of_the_code():
    """Write it again with: contact-verify solve --schema > examples/scene.schema.json."""
    published = json.loads((EXAMPLES / "scene.schema.json").read_text(encoding="utf-8"))
    assert published == SCHEMA


def resolved(part):
    """A part of the schema in place of the reference to it."""
    return SCHEMA["$defs"][part["$ref"].rpartition("/")[2]] if "$ref" in part else part


def test_every_kind_is_offered_to_an_editor():
    for name, kinds in (("indenter", (*PROFILES, *SHAPES)), ("loading", LOADINGS)):
        offered = [resolved(part)["properties"]["kind"] for part in SCHEMA["properties"][name]["oneOf"]]
        assert [kind["const"] for kind in offered] == [cls.kind() for cls in kinds]
    assert len(SCHEMA["properties"]["effects"]["items"]["oneOf"]) == len(EFFECTS)


def test_every_field_is_explained():
    for part in map(resolved, SCHEMA["properties"]["indenter"]["oneOf"]):
        fields = {name: field for name, field in part["properties"].items() if name != "kind"}
        assert all(field.get("description") for field in fields.values()), part["description"]


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.toml")), ids=lambda path: path.name)
def test_the_examples_follow_it_and_name_it(path):
    text = path.read_text(encoding="utf-8")
    assert text.startswith("#:schema scene.schema.json\n")
    assert accepted(tomllib.loads(text))


@pytest.mark.parametrize(
    ("table", "change"),
    [
        ("layer", {"poisons_ratio": 0.3}),
        ("layer", {"poissons_ratio": 0.6}),
        ("layer", {"half_space": True}),
        ("layer", {"support": "glued"}),
        ("indenter", {"kind": "conne"}),
        ("indenter", {"slope": -0.1}),
        ("loading", {"values": []}),
        ("loading", {"value": [1e-3]}),
    ],
    ids=str,
)
def test_schema_and_code_refuse_the_same_mistakes(table, change):
    mapping = VALID | {table: VALID[table] | change}
    assert accepted(VALID)
    assert not accepted(mapping)
    with pytest.raises(InvalidInput):
        scene_from_mapping(mapping)


@pytest.mark.parametrize("table", ["layer", "indenter", "loading"])
def test_schema_and_code_miss_the_same_tables(table):
    mapping = {name: part for name, part in VALID.items() if name != table}
    assert not accepted(mapping)
    with pytest.raises(InvalidInput):
        scene_from_mapping(mapping)

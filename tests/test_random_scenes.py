"""The generator of random scenes knows every record, field and option of the scenes."""

import dataclasses

import numpy as np
import pytest

import contact
from contact import CoatedPair, DepthFunction, Effect, ElasticLayer, Loading, Profile
from contact.files.scene_file import scene_schema
from contact.scene.shapes import SHAPES
from tests import random_scenes
from tests.random_scenes import Around, UnknownField, concrete, drawn_record

_BASES = (ElasticLayer, Profile, Loading, Effect, DepthFunction, CoatedPair)
_RECORDS = [cls for base in _BASES for cls in concrete(base)]


def _around(number, **wish):
    s = Around(np.random.default_rng(number), 0.5, 0.2, wish)
    s.layer = contact.Layer(thickness=s.h, youngs_modulus=s.modulus, poissons_ratio=0.5)
    s.indenter = contact.Paraboloid(radius_of_curvature=s.a / s.slope)
    return s


@pytest.mark.parametrize("cls", _RECORDS, ids=lambda cls: cls.__name__)
def test_every_record_is_drawn_with_all_its_fields(cls):
    fixed = {"loading": contact.ContactRadii([1.0]), "effects": ()} if cls is CoatedPair else {}
    assert type(drawn_record(cls, _around(1), **fixed)) is cls


def test_every_field_of_a_scene_is_known():
    known = {"layer", "indenter", "loading", "effects", "beyond_small_strains"}
    assert {one.name for one in dataclasses.fields(contact.Scene)} == known


def _kinds(schema):
    """Names that files of scenes may have as `kind`, at any level of the schema."""
    if isinstance(schema, dict):
        if "const" in schema.get("properties", {}).get("kind", {}):
            yield schema["properties"]["kind"]["const"]
        for part in schema.values():
            yield from _kinds(part)
    if isinstance(schema, list):
        for part in schema:
            yield from _kinds(part)


def test_every_kind_of_the_published_schema_is_drawn():
    elsewhere = {cls.kind() for cls in SHAPES}  # tests/verification/test_shapes.py
    drawn = {cls.__name__.lower() for cls in _RECORDS}
    assert not {kind for kind in _kinds(scene_schema()) if kind.replace("_", "") not in drawn} - elsewhere


def test_a_new_class_is_refused_by_its_name(monkeypatch):
    class Wedge(contact.Cone):
        """A class without a rule."""

    monkeypatch.setattr(random_scenes, "concrete", lambda base: [Wedge])
    with pytest.raises(UnknownField, match="Wedge"):
        drawn_record(Profile, _around(1))


def test_a_new_field_is_refused_by_its_name(monkeypatch):
    monkeypatch.setitem(random_scenes.RULES, "Cone", lambda s: {})
    with pytest.raises(UnknownField, match=r"Cone\.slope"):
        drawn_record(contact.Cone, _around(1))


def test_every_class_has_a_kind_of_its_own():
    parts = (random_scenes.LAYERS, random_scenes.INDENTERS, random_scenes.LOADINGS)
    kinds = {kind.base for part in parts for kind in part.values()}
    kinds |= {kind.base for several in random_scenes.EFFECTS.values() for kind in several}
    kinds |= {kind.fixed["youngs_modulus"] for kind in random_scenes.GRADED.values()}
    assert not set(_RECORDS) - kinds
    assert all(dataclasses.is_dataclass(kind) for kind in kinds)

"""The generator of random scenes knows every record, field and option of the scenes."""

import dataclasses
import math

import numpy as np
import pytest

import contact
from contact import CoatedPair, DepthFunction, Effect, ElasticLayer, Loading, Profile, scene_from_mapping
from contact.files.scene_file import scene_schema
from contact.records.record import record
from contact.scene.shapes import SHAPES
from tests import random_scenes
from tests.random_scenes import Around, UnknownField, concrete, drawn_record, drawn_scene

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
    @record
    class Wedge(contact.Cone):
        """A class without a rule."""

    monkeypatch.setattr(random_scenes, "concrete", lambda base: [Wedge])
    with pytest.raises(UnknownField, match="Wedge"):
        drawn_record(Profile, _around(1))


def test_a_new_field_is_refused_by_its_name(monkeypatch):
    monkeypatch.setitem(random_scenes.RULES, "Cone", lambda s: {})
    with pytest.raises(UnknownField, match=r"Cone\.slope"):
        drawn_record(contact.Cone, _around(1))


def _drawn(count, **kinds):
    return [drawn_scene(np.random.default_rng([3, n]), **kinds) for n in range(count)]


def test_poissons_ratio_is_drawn_from_zero_to_exactly_one_half():
    ratios = [
        scene.layer.poissons_ratio
        for scene in _drawn(120, layer="bonded layer", indenter="Cone", loading="NormalForces", effect="no effect")
    ]
    assert {0.0, 0.5} <= set(ratios)
    assert any(0.49 < nu < 0.5 for nu in ratios)
    assert any(0.1 < nu < 0.4 for nu in ratios)


def test_slopes_and_ratios_span_all_decades():
    scenes = _drawn(150, layer="bonded layer", indenter="Cone", loading="ContactRadii", effect="no effect")
    slopes = [scene.indenter.slope for scene in scenes]
    ratios = [scene.loading.values[-1] / scene.layer.thickness for scene in scenes]
    assert min(slopes) < 0.02
    assert max(slopes) > 50.0
    assert min(ratios) < 3e-3
    assert max(ratios) > 300.0


@pytest.mark.parametrize("name", ["DepthHistory", "ForceHistory"])
def test_histories_begin_with_and_without_a_jump_and_have_short_ramps(name):
    scenes = _drawn(80, layer="half-space", loading=f"{name}, ramp", effect="StandardSolid")
    jumps = _drawn(20, layer="half-space", loading=f"{name}, jump", effect="StandardSolid")
    values = name.removesuffix("History").lower()
    assert all(getattr(scene.loading, values)[0] == 0.0 for scene in scenes)
    assert all(getattr(scene.loading, values)[0] > 0.0 for scene in jumps)
    ramps = [scene.loading.time[1] / scene.loading.time[-1] for scene in scenes]
    assert min(ramps) < 0.005
    assert max(ramps) > 0.5


def test_friction_is_drawn_finite_and_infinite():
    drawn = [drawn_record(contact.Friction, _around(n)).coefficient for n in range(40)]
    assert any(math.isinf(mu) for mu in drawn)
    assert any(0.0 < mu < 0.1 for mu in drawn)


def test_scenes_survive_the_way_through_a_file():
    for number in range(40):
        scene = drawn_scene(np.random.default_rng([5, number]), layer="sliding stack", loading="NormalForces")
        assert scene_from_mapping(contact.scene_to_mapping(scene)) == scene


def test_every_class_has_a_kind_of_its_own():
    parts = (random_scenes.LAYERS, random_scenes.INDENTERS, random_scenes.LOADINGS)
    kinds = {kind.base for part in parts for kind in part.values()}
    kinds |= {kind.base for several in random_scenes.EFFECTS.values() for kind in several}
    kinds |= {kind.fixed["youngs_modulus"] for kind in random_scenes.GRADED.values()}
    assert not set(_RECORDS) - kinds
    assert all(dataclasses.is_dataclass(kind) for kind in kinds)

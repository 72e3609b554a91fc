"""Every scene follows the schema and comes back the same through TOML, JSON and HDF5, as do saved answers."""

import json

import numpy as np
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from contact import ContactPath, Cost, InvalidInput, Scene, Solution, load_scene, scene_from_mapping, scene_to_mapping
from tests.contact.test_mutated_scenes import file_of
from tests.contact.test_scene_schema import VALIDATOR
from tests.random_scenes import EFFECTS, INDENTERS, LAYERS, LOADINGS, drawn_scene

COST = Cost(wall_seconds=0.1, cpu_seconds=0.1, peak_memory_bytes=1, unknowns=3, counters={"solves": 1})
KINDS = {"layer": LAYERS, "indenter": INDENTERS, "loading": LOADINGS, "effect": EFFECTS}
each_example = settings(suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow])


@st.composite
def scenes(draw):
    kinds = {part: draw(st.sampled_from(list(names))) for part, names in KINDS.items()}
    try:
        return drawn_scene(np.random.default_rng(draw(st.integers(0, 2**32))), **kinds)
    except InvalidInput:
        assume(False)


@each_example
@given(scenes())
def test_a_scene_survives_toml_and_json(tmp_path, scene):
    tables = scene_to_mapping(scene)
    assert VALIDATOR.is_valid(tables)
    (tmp_path / "scene.toml").write_text(file_of(tables), encoding="utf-8")
    assert load_scene(tmp_path / "scene.toml") == scene
    assert scene_from_mapping(json.loads(json.dumps(tables, allow_nan=False))) == scene
    assert all(scene.replace(**{part: getattr(scene, part)}) == scene for part in ("layer", "indenter", "effects"))


@settings(each_example, max_examples=25)
@given(scenes(), st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=5))
def test_an_answer_survives_hdf5_with_its_scene(tmp_path, scene, numbers):
    arrays = dict.fromkeys(ContactPath.ARRAYS, np.array(numbers))
    errors = {"normal_force": np.abs(numbers)}
    answer = ContactPath(scene=scene, method="any", settings={"nodes": 3}, error_estimate=errors, cost=COST, **arrays)
    answer.save(tmp_path / "answer.h5")
    again = Solution.load(tmp_path / "answer.h5")
    assert isinstance(again.scene, Scene)
    assert (type(again), again.scene, again.cost, again.settings) == (ContactPath, scene, COST, {"nodes": 3})
    assert all(np.array_equal(getattr(again, name), numbers) for name in ContactPath.ARRAYS)
    assert np.array_equal(again.error_estimate["normal_force"], np.abs(numbers))

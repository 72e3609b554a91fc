"""Mappings that once crashed, hung or filled the screen; each is now one short refusal."""

from __future__ import annotations

import numpy as np
import pytest

from contact import ContactRadii, InvalidInput, Layer, load_scene, scene_from_mapping

GOOD = {"layer": {}, "indenter": {}, "loading": {}}

CRASHED = {
    "no mapping at all": (3.0, "3.0: a scene is a table"),
    "keys that cannot be sorted": ({1: 2, "x": 3}, "Keys should be strings"),
    "a key of a hundred thousand letters": ({"x" * 100_000: 1}, "no such field"),
    "effects without end": (GOOD | {"effects": range(10**12)}, "effects = range.*: 1000000000000 are listed"),
    "bytes for effects": (GOOD | {"effects": b"1"}, "must be a list of tables"),
    "an integer that Python does not print": (GOOD | {"layer": 10**5000}, "layer = a huge int: must be a table"),
    "a kind that is none": (
        {
            "layer": {"half_space": True, "youngs_modulus": 1.0, "poissons_ratio": 0.3},
            "indenter": {"kind": "x" * 10**5},
        },
        "must be one of",
    ),
    "a hundred wrong fields": ({"layer": {f"x{n}": n for n in range(100)}}, "scene: 9[0-9] more problems"),
}


@pytest.mark.parametrize("name", CRASHED)
def test_a_mapping_that_is_no_scene_is_refused_in_few_words(name):
    mapping, message = CRASHED[name]
    with pytest.raises(InvalidInput, match=message) as caught:
        scene_from_mapping(mapping)
    assert len(str(caught.value)) < 1500


def test_numbers_under_a_mask_are_not_read():
    with pytest.raises(InvalidInput, match="must not be masked"):
        ContactRadii(np.ma.array([1.0, 2.0], mask=[False, True]))


def test_a_long_text_is_shown_short():
    with pytest.raises(InvalidInput) as caught:
        Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3, support="x" * 10**6)
    assert len(str(caught.value)) < 300


def test_an_integer_of_five_thousand_digits_is_refused(tmp_path):
    file = tmp_path / "scene.toml"
    file.write_text(f"[layer]\nthickness = {'9' * 5000}\n")
    with pytest.raises(InvalidInput, match="not valid TOML"):
        load_scene(file)

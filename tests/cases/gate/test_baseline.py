"""Baselines on disk: nothing is lost, and a file that `accept` did not write is refused."""

import json

import pytest

from cases.gate.baseline import baseline_path, read_baselines
from cases.run.specification import specification_hash
from contact import InvalidInput
from tests.cases.gate.example_baselines import CASE, accepted


@pytest.fixture
def file(tmp_path):
    return baseline_path(accepted(tmp_path), CASE, "mdr")


def edited(file, old, new):
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")
    return file.parent.parent


def rewritten(file, **changes):
    tree = json.loads(file.read_text(encoding="utf-8"))["baseline"]
    tree["records"][0] |= changes.pop("record", {})
    file.write_text(json.dumps({"baseline": tree | changes}), encoding="utf-8")
    return file.parent.parent


def test_a_wide_tolerance_is_refused(file):
    with pytest.raises(InvalidInput, match="is not max"):
        read_baselines(rewritten(file, record={"tolerance": 1e-3}))


def test_another_version_is_refused_by_number(file):
    with pytest.raises(InvalidInput, match="version 99"):
        read_baselines(rewritten(file, version=99))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("1.5\n", "NaN\n", "non-finite number NaN"),
        ('"baseline"', '"something"', "version None"),
        ("{", "", "not readable"),
    ],
)
def test_a_damaged_file_is_refused(file, old, new, message):
    with pytest.raises(InvalidInput, match=message):
        read_baselines(edited(file, old, new))


def test_a_digest_of_an_older_version_is_passed_over(file):
    tree = json.loads(file.read_text(encoding="utf-8"))
    before = read_baselines(file.parent.parent)
    file.write_text(json.dumps({**tree, "digest": "0"}), encoding="utf-8")
    assert read_baselines(file.parent.parent) == before


def test_no_folder_has_no_baselines(tmp_path):
    assert read_baselines(tmp_path / "nowhere") == ()


def test_a_file_in_the_wrong_place_is_refused(file):
    file.rename(file.with_name("fem.json"))
    with pytest.raises(InvalidInput, match="holds mdr on example_cone"):
        read_baselines(file.parent.parent)


def test_the_specification_is_the_same_where_only_the_last_bit_differs():
    assert specification_hash('{"a": 0.1}', {"n": 3}) == specification_hash('{"a": 0.10000000000000002}', {"n": 3})


@pytest.mark.parametrize(
    ("scene", "settings"), [('{"a": 0.1000001}', {"n": 3}), ('{"a": 0.1}', {"n": 4}), ('{"b": 0.1}', {"n": 3})]
)
def test_another_scene_or_setting_has_another_specification(scene, settings):
    assert specification_hash(scene, settings) != specification_hash('{"a": 0.1}', {"n": 3})

"""Baselines on disk: nothing is lost, and a file that `accept` did not write is refused."""

import json

import pytest

from cases.gate.baseline import baseline_path, read_baselines
from cases.gate.history import append_history, history_path, read_history, write_history
from cases.gate.write_permission import SOURCE
from cases.results.sealed import sealed_text
from cases.run.specification import specification_hash
from contact import InvalidInput
from tests.cases.example_run import acceptance
from tests.cases.gate.example_baselines import CASE, accepted


@pytest.fixture
def file(tmp_path):
    return baseline_path(accepted(tmp_path), CASE, "mdr")


def edited(file, old, new):
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")
    return file.parent.parent


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"tolerance": 1e-09', '"tolerance": 1e-08', "changed after it was written"),
        ("1.5\n", "1.6\n", "changed after it was written"),
        ("1.5\n", "1.50\n", "changed after it was written"),
        ("1.5\n", "NaN\n", "non-finite number NaN"),
        ('"baseline"', '"something"', "other entries than 'baseline'"),
        ('"digest"', '"seal"', "has no seal"),
    ],
)
def test_a_file_edited_by_hand_is_refused(file, old, new, message):
    with pytest.raises(InvalidInput, match=message):
        read_baselines(edited(file, old, new))


def resealed(file, **changes):
    tree = json.loads(file.read_text(encoding="utf-8"))["baseline"]
    tree["records"][0] |= changes.pop("record", {})
    file.write_text(sealed_text({"baseline": tree | changes}, covered="baseline"), encoding="utf-8")
    return file.parent.parent


def test_a_wide_tolerance_is_refused_even_with_a_right_digest(file):
    with pytest.raises(InvalidInput, match="is not max"):
        read_baselines(resealed(file, record={"tolerance": 1e-3}))


def test_another_version_is_refused_by_number(file):
    with pytest.raises(InvalidInput, match="version 3"):
        read_baselines(resealed(file, version=3))


def test_a_file_in_the_wrong_place_is_refused(file):
    file.rename(file.with_name("fem.json"))
    with pytest.raises(InvalidInput, match="holds mdr on example_cone"):
        read_baselines(file.parent.parent)


def test_no_folder_has_no_baselines_and_no_history(tmp_path):
    assert read_baselines(tmp_path / "nowhere") == ()
    assert read_history(tmp_path / "nowhere") == ()


def test_the_history_is_only_appended_to(tmp_path):
    append_history(tmp_path, [acceptance()])
    first, _ = history_path(tmp_path).read_text(encoding="utf-8").splitlines()
    append_history(tmp_path, [acceptance(), acceptance()])
    assert history_path(tmp_path).read_text(encoding="utf-8").startswith(first)
    assert read_history(tmp_path) == (acceptance(),) * 3


def test_a_line_that_is_no_acceptance_is_named(tmp_path):
    append_history(tmp_path, [acceptance()])
    first, _ = history_path(tmp_path).read_bytes().splitlines(keepends=True)
    write_history(tmp_path, [first, b"{}\n"])
    with pytest.raises(InvalidInput, match="line 2"):
        read_history(tmp_path)


@pytest.mark.parametrize("edit", [lambda text: text.replace("1", "2", 1), lambda text: text + "{}\n", lambda _: ""])
def test_a_history_edited_by_hand_is_neither_read_nor_appended_to(edit, tmp_path):
    append_history(tmp_path, [acceptance()])
    path = history_path(tmp_path)
    path.write_text(edited := edit(path.read_text(encoding="utf-8")), encoding="utf-8")
    for touch in (read_history, lambda folder: append_history(folder, [acceptance()])):
        with pytest.raises(InvalidInput, match="changed after it was written"):
            touch(tmp_path)
    assert path.read_text(encoding="utf-8") == edited


def test_the_accepted_history_of_this_project_is_sealed():
    assert len(read_history(SOURCE / "baselines")) > 2000


def test_the_specification_is_the_same_where_only_the_last_bit_differs():
    assert specification_hash('{"a": 0.1}', {"n": 3}) == specification_hash('{"a": 0.10000000000000002}', {"n": 3})


@pytest.mark.parametrize(
    ("scene", "settings"), [('{"a": 0.1000001}', {"n": 3}), ('{"a": 0.1}', {"n": 4}), ('{"b": 0.1}', {"n": 3})]
)
def test_another_scene_or_setting_has_another_specification(scene, settings):
    assert specification_hash(scene, settings) != specification_hash('{"a": 0.1}', {"n": 3})

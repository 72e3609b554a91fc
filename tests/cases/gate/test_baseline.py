"""Baselines on disk: nothing is lost, and a file that `accept` did not write is refused."""

import dataclasses

import pytest

from cases.gate.baseline import read_baselines
from cases.run.keys import question
from contact import InvalidInput
from tests.cases.example_run import PASSING
from tests.cases.fake_case import fake_case
from tests.cases.gate.example_baselines import accepted


@pytest.fixture
def file(tmp_path):
    return accepted(tmp_path) / f"{PASSING}.jsonl"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('"scale": 1.5', '"scale": NaN', "line 2: .*scale"),
        ('"scale": 1.5', '"scale": -1.5', "line 2: .*scale"),
        ('"suites"', '"something"', "line 1: .*something"),
        ("{", "", "line 1: .*Invalid JSON"),
    ],
)
def test_a_damaged_file_is_refused_by_its_place(file, old, new, message):
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(InvalidInput, match=message):
        read_baselines(file.parent)


def test_no_folder_has_no_baselines(tmp_path):
    assert read_baselines(tmp_path / "nowhere") == ()


def test_a_file_in_the_wrong_place_is_refused(file):
    file.rename(file.with_name("another_case.jsonl"))
    with pytest.raises(InvalidInput, match="has answers of example_cone"):
        read_baselines(file.parent)


def changed(task, modulus=1.0, **settings):
    layer = task.problem.layer
    scene = task.problem.replace(layer=layer.replace(youngs_modulus=modulus * layer.youngs_modulus))
    use = dataclasses.replace(task.use, settings={**task.use.settings, **settings})
    return dataclasses.replace(task, problem=scene, use=use)


def test_the_question_is_the_same_where_only_the_last_bit_differs():
    task = next(fake_case().tasks())
    assert question(changed(task, 1 + 2.3e-16)) == question(task)


@pytest.mark.parametrize("change", [{"modulus": 1 + 1e-7}, {"cell": 0.5}])
def test_another_scene_or_setting_is_another_question(change):
    task = next(fake_case().tasks())
    assert question(changed(task, **change)) != question(task)

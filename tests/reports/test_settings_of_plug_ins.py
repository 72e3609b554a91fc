"""Settings of a method of an installed package, from the shell and from a file: `run`, `cost`."""

from pathlib import Path

import pytest

from cases.declare.settings import read_settings, with_settings
from cases.foreign import with_registered
from cases.run.timing import timed_warm
from cases.runs import read_run
from contact import InvalidInput
from reports.command_line import run
from tests.cases.fake_case import fake_case


@pytest.fixture(autouse=True)
def mine(install, monkeypatch, tmp_path):
    """Two methods of installed packages, in an empty folder."""
    install(dict.fromkeys(("mine", "my.own"), "tests.cases.fake_method:FakeHertz"))
    monkeypatch.chdir(tmp_path)


# Without a time limit methods of installed packages need no process of their own.
IN_THIS_PROCESS = ("--quiet", "--out", "out", "--time-limit", "0")


def written(text):
    Path("mine.toml").write_text(text, encoding="utf-8")
    return "mine.toml"


@pytest.mark.parametrize(
    ("texts", "chosen", "found"),
    [
        (["cell=0.5"], ["mine", "mdr"], {"mine": {"cell": 0.5}}),
        (["mine.cell=0.5", "mine.cell=0.25"], [], {"mine": {"cell": 0.25}}),
        (["my.own.plant=die", "mine.plant='a.b=c'"], [], {"my.own": {"plant": "die"}, "mine": {"plant": "a.b=c"}}),
        (["mine.cell=[1, 2]", "mine.plant="], [], {"mine": {"cell": [1, 2], "plant": ""}}),
        ([], ["mine"], {}),
    ],
)
def test_words_are_values_of_toml(texts, chosen, found):
    assert read_settings(texts, chosen) == found


def test_a_file_has_a_table_for_each_method():
    name = written("[mine]\ncell = 0.5\n[mine.'scene a']\ncell = 0.1\n[\"my.own\"]\nerror = 2\n")
    found = {"mine": {"cell": 0.5, "scene a": {"cell": 0.1}}, "my.own": {"error": 2}}
    assert read_settings([name], []) == found
    assert read_settings([name, "mine.cell=3"], [])["mine"]["cell"] == 3


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("cell=1", "name the method, as in mine.cell=1"),
        ("fem.cell=1", "'fem' is no method of an installed package; those are .*mine"),
        ("=1", "write name=value"),
        ("absent.toml", "no such file of settings can be read"),
        ("loose", "cell stands outside a table"),
        ("broken", "can be read"),
    ],
)
def test_what_is_no_setting_is_refused(text, words):
    Path("loose").write_text("cell = 1\n", encoding="utf-8")
    Path("broken").write_text("[mine\n", encoding="utf-8")
    with pytest.raises(InvalidInput, match=words):
        read_settings([text], [])


def test_one_scene_may_have_its_own_and_others_keep_theirs():
    case = with_registered(fake_case(), ["mine"])
    first, *others = [scene.name for scene in case.scenes]
    changed = with_settings(case, {"mine": {"cell": 0.5, first: {"cell": 0.1, "error": 3.0}}})
    settings = {scene.name: changed.use(scene, "mine").settings for scene in changed.scenes}
    assert settings == {first: {"cell": 0.1, "error": 3.0}, **{name: {"cell": 0.5} for name in others}}
    for scene in case.scenes:
        kept = [use for use in case.methods_of(scene) if use.label != "mine"]
        assert [use for use in changed.methods_of(changed.scene(scene.name)) if use.label != "mine"] == kept
    assert with_settings(case, {}) == case


@pytest.mark.parametrize("settings", [{"cells": 3}, {"cells": "x"}])
def test_a_setting_that_the_method_has_not_is_told_with_those_it_has(settings):
    case = with_registered(fake_case(), ["mine"])
    with pytest.raises(InvalidInput, match=r"'mine' does not take cells=.*; it has cell, error, order"):
        with_settings(case, {"mine": settings})


@pytest.mark.usefixtures("library", "without_pages")
def test_a_run_is_made_with_them(capsys):
    words = ["run", "--executor", "serial", *IN_THIS_PROCESS, "--method", "mine"]
    run([*words, "--setting", "cell=0.125"])
    answers = read_run(Path("out")).answers
    assert {a.settings["cell"] for a in answers if a.method == "mine" and a.settings} == {0.125}
    assert run([*words, "--setting", "cells=1"]) == 4
    assert "it has cell" in capsys.readouterr().err


@pytest.mark.usefixtures("without_pages")
def test_cost_climbs_a_ladder_of_them(library, monkeypatch, capsys):
    monkeypatch.setitem(timed_warm.__kwdefaults__, "shortest", 1e-3)
    library(fake_case(work=True))
    words = ["run", "--only", "cost", "--suite", "ci", *IN_THIS_PROCESS, "--method", "mine"]
    assert run([*words, "--setting", "cell=[0.01, 0.001]", "--setting", "order=2"]) == 0
    (record,) = read_run(Path("out")).judged.costs
    assert [(point.method, point.setting) for point in record.points] == [
        ("mine", "cell=0.01, order=2"),
        ("mine", "cell=0.001, order=2"),
    ]
    assert record.points[0].error > 50 * record.points[1].error
    assert run([*words, "--setting", "cell=[0.01, 0.001]", "--setting", "order=[1, 2, 3]"]) == 4
    assert "lists must have the same length" in capsys.readouterr().err
    assert run([*words[:-1], "bem"]) == 4
    assert "nothing times bem" in capsys.readouterr().err

"""advise, ladders and campaign say what they found, and their exit code says whether something is wrong."""

from __future__ import annotations

import pytest

from reports.command_line import EXAMPLE_SCENE, run


@pytest.fixture
def scene(tmp_path):
    file = tmp_path / "scene.toml"
    file.write_text(EXAMPLE_SCENE, encoding="utf-8")
    return str(file)


def test_advice_names_what_matters(scene, capsys):
    assert run(["advise", scene, "--accuracy", "1e-2"]) == 0
    assert "needed at 0.01: finite thickness" in capsys.readouterr().out


def test_a_climbed_ladder_tells_its_digits(capsys):
    assert run(["ladders", "vanishing flat end"]) == 0
    assert "vanishing flat end: climbed to the end, at least 1" in capsys.readouterr().out


def test_an_unknown_ladder_names_those_there_are(capsys):
    assert run(["ladders", "nonsense"]) == 4
    assert "nearly incompressible" in capsys.readouterr().err.replace("\n", " ")


def test_a_small_campaign_counts_its_ends(capsys):
    assert run(["campaign", "elastic", "--count", "3", "--seed", "5"]) == 0
    assert "beyond: 0, crashed: 0" in capsys.readouterr().out


def test_an_unknown_family_names_those_there_are(capsys):
    assert run(["campaign", "plastic"]) == 4
    assert "elastic, adhesive, impact, history" in capsys.readouterr().err.replace("\n", " ")

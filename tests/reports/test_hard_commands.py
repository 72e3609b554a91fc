"""advise and ladders say what they found, and their exit code says whether something is wrong."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from reports.command_line import run


@pytest.fixture
def scene(tmp_path):
    file = tmp_path / "scene.toml"
    file.write_bytes(Path("reports/templates/example.toml").read_bytes())
    return str(file)


def test_advice_names_what_matters(scene, capsys):
    assert run(["solve", scene, "--advise", "--accuracy", "1e-2"]) == 0
    assert "Finite thickness matters at 1 %: without it " in capsys.readouterr().out


@pytest.mark.slow
def test_a_climbed_ladder_tells_its_digits_and_writes_its_table(tmp_path, capsys):
    assert run(["run", "--only", "stability", "vanishing flat end", "--out", str(tmp_path)]) == 0
    assert re.search(r"vanishing flat end +MDR .* completed to .* 1\d\.\d", capsys.readouterr().out)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Stress tests" in page
    assert "completed to" in page


def test_a_case_of_stress_tests_is_listed_with_each_of_them(capsys):
    assert run(["run", "--list", "stability"]) == 0
    out = capsys.readouterr().out
    assert out.count("stress test ") >= 20
    assert "Scenes" not in out


def test_an_unknown_ladder_names_those_there_are(capsys):
    assert run(["run", "--only", "stability", "nonsense"]) == 4
    assert "nearly incompressible" in capsys.readouterr().err.replace("\n", " ")


@pytest.mark.slow
def test_the_cost_command_says_what_accuracy_costs(tmp_path, capsys):
    assert run(["run", "--only", "cost", "truncated_cone", "--suite", "ci", "--out", str(tmp_path), "--quiet"]) == 0
    assert "MDR is faster" in capsys.readouterr().out
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert 'id="costs"' in page


def test_an_answer_lists_the_stages_that_ran_and_no_others(scene, capsys):
    assert run(["solve", scene]) == 0
    line = next(line for line in capsys.readouterr().out.splitlines() if line.startswith("stages: "))
    assert "flat punch data" in line
    assert "adhes" not in line


@pytest.mark.parametrize(
    "command", [["run", "--only", "stability", "--out"], ["run", "--only", "cost", "--out"], ["run", "--out"]]
)
def test_a_file_in_the_way_of_a_report_is_refused_before_the_study(command, tmp_path, capsys):
    (tmp_path / "report").write_text("mine")
    assert run([*command, str(tmp_path / "report")]) == 4
    assert "report" in capsys.readouterr().err.replace("\n", " ")
    assert (tmp_path / "report").read_text() == "mine"

"""advise and ladders say what they found, and their exit code says whether something is wrong."""

from __future__ import annotations

import dataclasses

import pytest

from cases.results.records.reliability import Ladder, Rung
from cases.results.status import Status
from reports.charts.ladder import refusals
from reports.command_line import EXAMPLE_SCENE, run
from reports.tables import hard_tables
from tests.cases.example_run import passing_case


@pytest.fixture
def scene(tmp_path):
    file = tmp_path / "scene.toml"
    file.write_text(EXAMPLE_SCENE, encoding="utf-8")
    return str(file)


def test_advice_names_what_matters(scene, capsys):
    assert run(["solve", scene, "--advise", "--accuracy", "1e-2"]) == 0
    assert "needed at 0.01: finite thickness" in capsys.readouterr().out


def test_a_climbed_ladder_tells_its_digits_and_writes_its_table(tmp_path, capsys):
    assert run(["run", "--only", "stability", "vanishing flat end", "--out", str(tmp_path)]) == 0
    assert "vanishing flat end, mdr: climbed to the end, at least 1" in capsys.readouterr().out
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "Breakdown rungs and digits" in page
    assert "climbed to the end" in page


def test_an_unknown_ladder_names_those_there_are(capsys):
    assert run(["run", "--only", "stability", "nonsense"]) == 4
    assert "nearly incompressible" in capsys.readouterr().err.replace("\n", " ")


def test_a_refusal_and_a_failure_are_told_apart_and_said_once():
    def rungs(*ends):
        return tuple(Rung(value=10.0**k, status=s, reason=r, digits=d) for k, (s, r, d) in enumerate(ends))

    fine, refused = (Status.PASS, "", 9.0), (Status.INVALID, "NotConvergedError: too thin", None)
    walks = {"mdr": (fine, fine), "bem": (fine, refused, refused), "fem": (fine, (Status.FAIL, "beyond", 9.0), fine)}
    ladders = tuple(
        Ladder(name="walk", parameter="p", unit="1", method=name, quantity="normal_force", rungs=rungs(*ends))
        for name, ends in walks.items()
    )
    case = dataclasses.replace(passing_case(), ladders=ladders)
    table = hard_tables.ladders(case)
    assert table is not None
    column = table.heads.index("how far")
    assert [row[column] for row in table.rows] == ["climbed to the end", "refuses 10", "fails at 10"]
    assert list(refusals(case)) == ["BEM, walk, p = 10 to 100 (2 rungs): NotConvergedError: too thin"]


@pytest.mark.slow
def test_the_cost_command_says_what_accuracy_costs(tmp_path, capsys):
    assert run(["run", "--only", "cost", "truncated_cone", "--suite", "ci", "--out", str(tmp_path), "--quiet"]) == 0
    assert "How much faster MDR is" in capsys.readouterr().out
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert 'id="costs"' in page
    assert "true static scaling" in page


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

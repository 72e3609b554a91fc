"""`gate` and `accept` from the shell: a number accepted, moved, refused, accepted again."""

import dataclasses
import json
from pathlib import Path

import pytest

from cases.gate import spread
from cases.gate.accept import WriteConditions
from cases.run import executors, runner
from cases.run.runner import RunOptions
from cases.run.stamp import revision
from reports.command_line import run
from reports.commands import baselines
from tests.cases.fake_case import FAST, fake_case, spoiled
from tests.cases.fake_method import FakeHertz
from tests.cases.test_narrow import with_a_nightly_method

CLEAN = WriteConditions(revision=revision(), changed=(), in_ci=False)


@pytest.fixture
def here(tmp_path, library, monkeypatch):
    """A folder of a run, a library, and a clean working tree."""
    monkeypatch.setattr(spread, "process_pool", executors.serial)
    monkeypatch.setattr(baselines, "write_conditions", lambda *_: CLEAN)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")  # whatever the terminal: a table is not folded
    return library


def run_cases(case=None):
    """What `run` stores, without its pages."""
    options = RunOptions(out=Path("out"), suite="ci", executor=executors.serial, timing=False)
    runner.run_cases([case or fake_case()], options)
    clean_stamp()


def clean_stamp():
    """As if the run had been made on a clean tree."""
    edit_results(lambda tree: tree["stamp"].update(dirty=False))


def edit_results(edit):
    path = Path("out/run.json")
    tree = json.loads(path.read_text(encoding="utf-8"))
    edit(tree)
    path.write_text(json.dumps(tree), encoding="utf-8")


def accept_case(*more, name="fake_hertz", reason="first numbers"):
    return run(["accept", *([name] if name else []), "--reason", reason, "--run", "out", *more])


def gate_run(*more):
    return run(["gate", "out", "--quiet", *more])


@pytest.mark.usefixtures("here")
def test_without_baselines_the_gate_is_not_configured(capsys):
    run_cases()
    assert gate_run() == 4
    assert "accept a case first" in capsys.readouterr().err


def test_what_only_the_suite_nightly_solves_stays_accepted_and_is_not_missed(here, tmp_path):
    run_cases()
    accept_case("--write")
    case = with_a_nightly_method()
    here(case)
    run_cases(case.in_suite("ci"))
    assert accept_case("--loosen", "--write") == 0
    lines = (tmp_path / "baselines" / f"{case.name}.jsonl").read_text(encoding="utf-8").splitlines()[1:]
    answered = {(row["scene"], row["method"]) for row in map(json.loads, lines)}
    assert answered >= case.nightly_only()
    assert gate_run() == 0


@pytest.mark.usefixtures("here")
def test_the_gate_writes_verdicts_and_draws_no_figure_again(tmp_path):
    run_cases()
    accept_case("--write")
    assert gate_run() == 0
    assert "accepted normal_force" in (tmp_path / "out" / "junit.xml").read_text(encoding="utf-8")
    assert (tmp_path / "out" / "summary.md").is_file()
    assert not (tmp_path / "out" / "figures").exists()


@pytest.mark.usefixtures("here")
def test_a_dry_run_writes_nothing(tmp_path, capsys):
    run_cases()
    assert accept_case() == 0
    assert "nothing written" in capsys.readouterr().out
    assert not (tmp_path / "baselines").exists()


def better_quadrature(monkeypatch):
    """As if the code of the coarser method had changed: its error is a tenth larger."""
    own = FakeHertz._path
    monkeypatch.setattr(FakeHertz, "_path", lambda self, scene: own(dataclasses.replace(self, error=1.1), scene))


@pytest.mark.usefixtures("here")
def test_an_accepted_number_is_gated_from_then_on(tmp_path, monkeypatch, capsys):
    run_cases()
    assert accept_case("--write") == 0
    assert gate_run() == 0
    assert "PASSED" in capsys.readouterr().out
    better_quadrature(monkeypatch)
    run_cases()
    assert gate_run() == 1
    output = capsys.readouterr().out
    assert "DIFF fake_hertz" in output
    assert "against accepted" in output
    assert accept_case("--write", reason="a better quadrature") == 0
    shown = capsys.readouterr().out
    assert "in tolerances" in shown
    assert "normal_force" in shown
    assert gate_run() == 0


@pytest.mark.usefixtures("here")
def test_accepting_where_nothing_may_be_accepted_is_refused_before_anything_is_repeated(monkeypatch, capsys):
    """Every such place and time is a row in `tests/cases/gate/test_accept.py`."""
    run_cases()
    monkeypatch.setattr(baselines, "write_conditions", lambda *_: dataclasses.replace(CLEAN, changed=("mdr/core.py",)))
    monkeypatch.setattr(baselines, "measured_spreads", None)
    assert accept_case("--write") == 4
    assert "mdr/core.py" in capsys.readouterr().err


def test_a_failing_exact_claim_cannot_be_accepted(here, tmp_path, capsys):
    wrong = fake_case(fast=spoiled(FAST, cell=1.0, error=1e-3))
    here(wrong)
    run_cases(wrong)
    assert accept_case("--write") == 4
    assert "closed form" in capsys.readouterr().err
    assert not (tmp_path / "baselines").exists()


@pytest.mark.usefixtures("here")
def test_a_case_that_did_not_run_cannot_be_accepted(capsys):
    run_cases()
    edit_results(lambda tree: tree.update(cases=[]))
    assert accept_case() == 4
    assert "run it first" in capsys.readouterr().err


@pytest.mark.usefixtures("here")
def test_without_a_name_all_cases_of_the_run_are_accepted(tmp_path):
    run_cases()
    assert accept_case("--write", name="") == 0
    assert [path.name for path in (tmp_path / "baselines").iterdir()] == ["fake_hertz.jsonl"]


@pytest.mark.usefixtures("here")
def test_the_gate_reads_from_the_run_which_methods_were_chosen(capsys):
    """Accepted numbers of the other method are not missed; without the record they were."""
    run_cases()
    assert accept_case("--write") == 0
    run(["run", "--executor", "serial", "--quiet", "--suite", "ci", "--out", "out", "--method", "fast"])
    assert gate_run() == 0
    assert gate_run("--method", "fast") == 0
    assert gate_run("--method", "slow") == 1
    assert "slow" in capsys.readouterr().out

"""A method of an installed package at the shell: `run`, `run --against`, `gate`, `cost` and `maps` with `--method`."""

from importlib.metadata import EntryPoint
from pathlib import Path

import pytest

from cases.declare import methods
from cases.declare.against import against, beside
from cases.declare.case import Case
from cases.declare.foreign_methods import with_registered
from cases.declare.registry import load_cases
from cases.declare.selection import in_suite
from cases.judgement.claims.agreement import Agreement
from cases.results.files import read_run
from cases.results.status import Status
from contact import InvalidInput
from reports.command_line import run
from tests.cases.fake_case import fake_case
from tests.cases.fake_method import FakeHertz


@pytest.fixture(autouse=True)
def mine(monkeypatch, tmp_path):
    """A method of an installed package, and another that nobody chooses."""
    value = "tests.cases.fake_method:FakeHertz"
    entries = [EntryPoint(name=name, value=value, group=methods.ENTRY_POINT_GROUP) for name in ("mine", "unchosen")]
    monkeypatch.setattr(methods, "entry_points", lambda group: entries)
    monkeypatch.chdir(tmp_path)


def solved(*more):
    code = run(["run", "--executor", "serial", "--quiet", "--out", "out", *more])
    return code, read_run(Path("out"))


def test_alone_it_is_compared_with_the_fast_method_where_it_models_the_scene(tmp_path):
    case = with_registered(load_cases()["thin_layer_limits"], ["mine"])
    found = beside(case, ["mine"], "mdr")
    assert {task.method for task in found.tasks()} == {"mine", "mdr"}
    assert ("mine", "mdr") in {(claim.fast, claim.reference) for claim in found.claims if isinstance(claim, Agreement)}
    for scene in found.scenes:
        supported = bool(FakeHertz().supports(scene.scene))
        assert {use.label for use in scene.methods} == ({"mdr", "mine"} if supported else {"mine"})
    _, result = solved("held_indentation", "--method", "mine")
    assert result.methods == ("mine",)
    assert "unchosen" not in (tmp_path / "out" / "results.json").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", sorted(load_cases()))
@pytest.mark.parametrize("suite", ["", "ci"])
def test_nothing_is_claimed_of_the_fast_method_itself(name, suite):
    case = in_suite(with_registered(load_cases()[name], ["mine"]), suite)
    found = beside(case, ["mine"], "mdr")
    for claim in found.claims:
        for scene in claim.scenes_of(found):
            assert "mine" in claim.labels(found, scene)
            assert set(claim.labels(found, scene)) <= {"mine", "mdr"}


@pytest.mark.usefixtures("library")
def test_any_method_is_compared_with_any_other():
    for one, other in (("mine", "slow"), ("slow", "fast"), ("mine", "unchosen")):
        code, result = solved("--method", one, "--against", other)
        (case,) = result.cases
        assert code in (0, 1)
        assert result.methods == (one, other)
        assert {row.method for row in case.runs} == {one, other}
        assert {claim.methods for claim in case.claims} == {(one, other)}
        assert {claim.quantity for claim in case.claims} == {"normal_force", "pressure"}


@pytest.mark.parametrize("name", sorted(load_cases()))
def test_a_comparison_has_every_scene_that_the_case_compares_whatever_the_suite(name):
    case = load_cases()[name]
    compared = {s.name for claim in case.claims if hasattr(claim, "fast") for s in claim.scenes_of(case)}
    if not compared:
        with pytest.raises(InvalidInput, match="methods are not compared there"):
            against([case], ["mine"], ["fem"])
        return
    (found,) = against([case], ["mine"], ["fem"])
    assert isinstance(found, Case)
    assert {scene.name for scene in found.scenes} == compared
    places = [(task.scene, task.method, task.variant) for task in found.tasks()]
    assert len(places) == len(set(places)) or any("refined" in variant for *_, variant in places)
    assert {method for _, method, _ in places} == {"mine", "fem"}


@pytest.mark.usefixtures("library")
def test_a_comparison_with_nothing_is_refused(capsys):
    for words in (["--against", "slow"], ["--method", "mine", "--against", "mine"]):
        assert run(["run", "--quiet", "--out", "out", *words]) == 4
        assert "name with --method what is compared with it" in capsys.readouterr().err
    assert run(["run", "--quiet", "--out", "out", "--method", "mine", "--against", "abaqus"]) == 4
    assert "no method 'abaqus'; there are" in capsys.readouterr().err


def test_cost_times_only_the_methods_named(library, capsys, monkeypatch):
    from reports.commands import runs

    case = fake_case(work=True)
    monkeypatch.setattr(runs, "load_cases", lambda: {case.name: case})
    assert run(["run", "--only", "cost", "--suite", "ci", "--out", "out", "--quiet", "--method", "mine"]) == 0
    (record,) = read_run(Path("out")).cases[0].work_precision
    assert [(point.method, point.label, point.status) for point in record.points] == [
        ("mine", "as it comes", Status.PASS)
    ]
    assert run(["run", "--only", "cost", "--suite", "ci", "--out", "out", "--quiet", "--method", "bem"]) == 4
    assert "nothing times bem" in capsys.readouterr().err

"""A method of an installed package at the shell: `run`, `run --against`, `gate`, `cost` and `maps` with `--method`."""

from pathlib import Path

import pytest

from cases.case import Case
from cases.claims import Agree
from cases.declare.registry import load_cases
from cases.foreign import against, beside, with_registered
from cases.run.runner import plan
from cases.runs import RUN, read_run
from contact import InvalidInput
from reports.command_line import run
from tests.cases.fake_method import FakeHertz


@pytest.fixture(autouse=True)
def mine(install, monkeypatch, tmp_path):
    """A method of an installed package, and another that nobody chooses."""
    install(dict.fromkeys(("mine", "unchosen"), "tests.cases.fake_method:FakeHertz"))
    monkeypatch.chdir(tmp_path)


def solved(*more):
    code = run(["run", "--executor", "serial", "--time-limit", "0", "--quiet", "--out", "out", *more])
    return code, read_run(Path("out"))


@pytest.mark.slow
@pytest.mark.usefixtures("library")
def test_alone_it_is_compared_with_the_fast_method_where_it_models_the_scene(tmp_path):
    case = with_registered(load_cases()["thin_layer_limits"], ["mine"])
    found = beside(case, ["mine"], "mdr")
    assert {task.use.label for task in found.tasks()} == {"mine", "mdr"}
    assert ("mine", "mdr") in {(claim.fast, claim.reference) for claim in found.claims if isinstance(claim, Agree)}
    for scene in found.scenes:
        supported = bool(FakeHertz().supports(scene.scene))
        assert {use.label for use in scene.methods} == ({"mdr", "mine"} if supported else {"mine"})
    _, result = solved("--method", "mine")
    assert result.judged.methods == ("mine",)
    assert "unchosen" not in (tmp_path / "out" / RUN).read_text(encoding="utf-8")


@pytest.mark.parametrize("name", sorted(load_cases()))
@pytest.mark.parametrize("suite", ["", "ci"])
def test_nothing_is_claimed_of_the_fast_method_itself(name, suite):
    case = with_registered(load_cases()[name], ["mine"]).in_suite(suite)
    found = beside(case, ["mine"], "mdr")
    for claim in found.claims:
        for _, use in claim.places(found):
            assert "mine" in claim.labels(use)
            assert set(claim.labels(use)) <= {"mine", "mdr"}


@pytest.mark.usefixtures("library", "without_pages")
def test_any_method_is_compared_with_any_other():
    for one, other in (("mine", "slow"), ("slow", "fast"), ("mine", "unchosen")):
        code, result = solved("--method", one, "--against", other)
        assert code in (0, 1)
        assert result.judged.methods == (one, other)
        assert {answer.method for answer in result.answers} == {one, other}
        assert {verdict.methods for verdict in result.judged.verdicts} == {(one, other)}
        assert {verdict.quantity for verdict in result.judged.verdicts} == {"normal_force", "pressure"}


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
    places = [(task.scene, task.use.label, task.variant) for task in plan([found])]
    assert len(places) == len(set(places)) or any("refined" in variant for *_, variant in places)
    assert {method for _, method, _ in places} == {"mine", "fem"}


@pytest.mark.usefixtures("library")
def test_a_comparison_with_nothing_is_refused(capsys):
    for words in (["--against", "slow"], ["--method", "mine", "--against", "mine"]):
        assert run(["run", "--quiet", "--out", "out", *words]) == 4
        assert "name with --method what is compared with it" in capsys.readouterr().err
    assert run(["run", "--quiet", "--out", "out", "--method", "mine", "--against", "abaqus"]) == 4
    assert "no method 'abaqus'; there are" in capsys.readouterr().err

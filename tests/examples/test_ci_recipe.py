"""The CI recipe is tested by running its commands, with one fabricated case in place of the library."""

import dataclasses
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from cases.answers import Table
from cases.runs import read_run
from reports.command_line import run
from tests.cases.example_run import example_stamp
from tests.cases.gate.example_baselines import accepted, scaled

ROOT = Path(__file__).parents[2]
RECIPE = ROOT / "examples" / "ci" / "verify.sh"
WORKFLOW = ROOT / "examples" / "ci" / "github-actions.yml"

COMMAND = """#!{python}
import sys
sys.path.insert(0, {root!r})
from cases.declare import methods
methods.BUILT_IN["fake"] = methods.TableEntry(module="tests.cases.fake_method", attribute="FakeHertz")
from reports.commands import baselines, runs
from reports import page
# Other tests look at pictures, which take most of the time.
page.svg_text = lambda drawing, key: "<svg></svg>"
from tests.cases.fake_case import SLOW, fake_case, spoiled
case = fake_case(slow=spoiled(SLOW, plant={plant!r}))
runs.load_cases = baselines.load_cases = lambda: {{case.name: case}}
from reports.command_line import main
# Processes that draw import this file once more, as they do the installed command.
if __name__ == "__main__":
    main()
"""


def verify(tmp_path, *arguments, plant="", **environment):
    """Run the recipe with a `contact-verify` that knows one fabricated case."""
    command = tmp_path / "bin" / "contact-verify"
    command.parent.mkdir(exist_ok=True)
    command.write_text(COMMAND.format(python=sys.executable, root=str(ROOT), plant=plant), encoding="utf-8")
    command.chmod(0o755)
    inherited = {name: value for name, value in os.environ.items() if not name.startswith("GITHUB_")}
    path = {"PATH": f"{command.parent}:{os.environ['PATH']}"}
    return subprocess.run(
        ["sh", str(RECIPE), *arguments],
        cwd=tmp_path,
        env={**inherited, **path, **environment},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    """A folder in which the recipe ran without a fault, and the finished process."""
    folder = tmp_path_factory.mktemp("sound")
    return folder, verify(folder, "out", "--executor", "serial")


@pytest.fixture(scope="module")
def broken_on_github(tmp_path_factory):
    """The same with a solver that answers NaN, where GitHub says that it runs the recipe."""
    folder = tmp_path_factory.mktemp("broken")
    github = {"GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": str(folder / "step_summary.md")}
    return folder, verify(folder, "out", "--executor", "serial", plant="nan", **github)


def test_recipe_writes_the_report_and_hands_on_the_exit_code(sound, broken_on_github):
    for (folder, done), code in ((sound, 0), (broken_on_github, 1)):
        assert done.returncode == code, done.stderr
        written = {p.name for p in (folder / "out").iterdir()}
        assert {"report.html", "summary.md", "junit.xml", "run.json", "answers.jsonl"} <= written


@pytest.mark.slow
def test_recipe_gates_where_numbers_are_accepted(tmp_path, sound):
    folder, done = sound
    assert done.returncode == 0
    result = read_run(folder / "out")
    result = dataclasses.replace(result, judged=dataclasses.replace(result.judged, stamp=example_stamp()))
    accepted(tmp_path / "baselines", result, case="fake_hertz")
    done = verify(tmp_path, "out", "--executor", "serial")
    assert (done.returncode, "checks" in done.stdout) == (0, True), done.stdout
    moved = tmp_path / "elsewhere"
    accepted(moved, edited(result), case="fake_hertz")
    done = verify(tmp_path, "out", "--executor", "serial", BASELINES=str(moved))
    assert done.returncode == 1
    assert "DIFF fake_hertz" in done.stdout


def edited(result):
    """The run with every number moved by 1e-7."""

    def moved(answer):
        quantities = {n: q if q.at else scaled(1 + 1e-7)(q) for n, q in answer.quantities.items()}
        return dataclasses.replace(answer, quantities=quantities)

    return dataclasses.replace(result, answers=Table(map(moved, result.answers)))


def test_recipe_fills_the_summary_page_and_annotates_on_github(broken_on_github):
    folder, done = broken_on_github
    assert done.returncode == 1
    assert (folder / "step_summary.md").read_text(encoding="utf-8").startswith("# FAILED")
    assert 1 <= done.stdout.count("::error") <= 9


@pytest.mark.slow
def test_recipe_refuses_wrong_usage_with_exit_code_4(tmp_path):
    assert verify(tmp_path, "out", "--suite", "weekly").returncode == 4
    assert verify(tmp_path).returncode != 0


@pytest.mark.slow
def test_workflow_runs_the_recipe_and_keeps_what_it_writes(tmp_path):
    workflow = WORKFLOW.read_text(encoding="utf-8")
    (command,) = re.findall(r"run: .*(sh examples/ci/verify\.sh .*)", workflow)
    assert command.split()[:3] == ["sh", "examples/ci/verify.sh", "build/verification"]
    verify(tmp_path, *command.split()[2:], "--executor", "serial")
    for kept in re.findall(r"^ +(build/verification/\S+)$", workflow, re.MULTILINE):
        assert (tmp_path / kept).exists(), kept
    assert "make setup" in workflow
    assert re.search(r"^setup:", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)


def test_gate_line_of_the_readme_uses_options_that_exist(capsys):
    readme = (ROOT / "examples" / "ci" / "README.md").read_text(encoding="utf-8")
    (line,) = re.findall(r"^contact-verify (gate .*)$", readme, re.MULTILINE)
    assert run([*line.split(), "--help"]) == 0
    assert "--baseline" in capsys.readouterr().out

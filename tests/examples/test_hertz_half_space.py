"""Someone else's solver with a mistake: caught by the cases, and the report shows where it is wrong."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from cases.runs import read_run
from cases.verdicts import Kind, Status
from reports.command_line import run

FOLDER = Path(__file__).parents[2] / "examples" / "hertz_half_space"
NAME = "hertz_half_space"
# Without a time limit it is solved in this process; in one of its own the source on the disk would be read.
ARGUMENTS = ("run", "truncated_cone", "--method", NAME, "--executor", "serial", "--time-limit", "0", "--quiet")


@pytest.fixture
def registered(install, monkeypatch):
    """The example as if it were installed."""
    install({NAME: "hertz_half_space:HertzHalfSpace"})
    monkeypatch.syspath_prepend(str(FOLDER))


@pytest.mark.usefixtures("registered")
def test_the_mistake_is_caught_and_the_report_shows_where(tmp_path, capsys):
    assert run([*ARGUMENTS, "--out", str(tmp_path)]) == 1
    told = " ".join(capsys.readouterr().out.split())
    assert "FAIL truncated_cone" in told
    sentence = "normal force is off against closed form, -0.09 each in 4 comparisons, as by one factor 0.91"
    pages = [(tmp_path / name).read_text(encoding="utf-8") for name in ("report.html", "summary.md")]
    for text in (told, *pages):
        assert text.count(sentence) == 1
        assert "while indentation depth passes" in text[text.index(sentence) :][:200]
    verdicts = read_run(tmp_path).judged.verdicts
    force, depth = ([v for v in verdicts if v.claim == f"half-space {what}"] for what in ("force", "depth"))
    assert {claim.status for claim in depth} == {Status.PASS}
    assert {claim.status for claim in force} == {Status.FAIL}
    for claim in force:  # E for E*: the relative error is -nu^2, nu = 0.3
        assert claim.error == pytest.approx(-0.09, rel=1e-9, abs=0.0)
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    worst = page[page.index('id="worst"') : page.index('id="matrix"')]
    assert "half-space force" in worst
    assert NAME in worst or "hertz" in worst.lower()
    assert "half-space depth" not in worst


@pytest.mark.usefixtures("registered")
def test_what_it_does_not_model_is_skipped_with_its_reason(tmp_path):
    run([*ARGUMENTS, "--out", str(tmp_path)])
    layers = [row for row in read_run(tmp_path).answers if not row.variant and "half-space" not in row.scene]
    assert layers
    assert {(row.status, row.reason) for row in layers} == {(Status.SKIP, "this code knows the half-space only")}


@pytest.mark.usefixtures("registered")
def test_without_its_mistake_it_passes(tmp_path, monkeypatch):
    import hertz_half_space

    source = Path(hertz_half_space.__file__).read_text(encoding="utf-8")
    mended = source.replace("scene.layer.youngs_modulus  #", "scene.layer.contact_modulus  #")
    assert mended != source
    namespace = {"__name__": "hertz_half_space"}
    exec(compile(mended, "mended", "exec"), namespace)
    monkeypatch.setattr(hertz_half_space, "HertzHalfSpace", namespace["HertzHalfSpace"])
    assert run([*ARGUMENTS, "--out", str(tmp_path)]) == 0
    exact = [v for v in read_run(tmp_path).judged.verdicts if v.kind is Kind.EXACT]
    assert {claim.status for claim in exact} == {Status.PASS, Status.SKIP}


@pytest.mark.slow
def test_installed_by_pip_it_is_found_by_the_command_line(tmp_path):
    """The commands of the example's README, into a folder that vanishes."""
    target = tmp_path / "site"
    package = shutil.copytree(FOLDER, tmp_path / "package")  # a build leaves its traces
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps"]
    subprocess.run([*pip, "--target", str(target), str(package)], check=True)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(target), str(FOLDER.parents[1])])}
    main = "from reports.command_line import main; main()"
    command = [sys.executable, "-c", main, "run", "truncated_cone", "--method", NAME, "--quiet"]
    done = subprocess.run(
        [*command, "--out", str(tmp_path / "out")],
        env=environment,
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1, done.stderr
    verdicts = read_run(tmp_path / "out").judged.verdicts
    assert {v.status for v in verdicts if v.claim == "half-space force"} == {Status.FAIL}

"""The tasks of a new user: each at most ten lines, each does what its page says."""

import re
import runpy
import shutil
import tomllib
from pathlib import Path

import jsonschema
import numpy as np
import pytest

from contact import ContactPath, Friction, Shape, load_scene
from contact.files.scene_file import scene_schema
from mdr import Mdr
from mdr.curves import fit_curve, read_curve
from reports.command_line import run
from reports.style import figure_style, svg_text

FOLDER = Path(__file__).parents[2] / "examples" / "tasks"
PAGE = (FOLDER / "README.md").read_text(encoding="utf-8")
SCENES = sorted(file.name for file in FOLDER.glob("*.toml"))
SCRIPTS = sorted(file.name for file in FOLDER.glob("*.py"))
SLOW = {"verify_a_case.py", "wheel_alone.py", "stress_inside.py", "two_methods.py", "creep.toml"}


def tasks(names):
    return [pytest.param(n, marks=pytest.mark.slow if n in SLOW else ()) for n in names]


def texts(svg):
    """Labels of a figure: coordinates may differ in their last digits from machine to machine."""
    return re.findall(r"<text[^>]*>([^<]+)<", svg)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    copied = shutil.copytree(FOLDER, tmp_path / "tasks")
    monkeypatch.chdir(copied)
    return copied


def test_there_are_twenty_tasks_and_the_page_names_them_all():
    assert len(SCENES) + len(SCRIPTS) >= 20
    assert all(f"`{name}`" in PAGE for name in SCENES + SCRIPTS)


@pytest.mark.parametrize("name", SCENES + SCRIPTS)
def test_a_task_has_at_most_ten_lines(name):
    lines = (FOLDER / name).read_text(encoding="utf-8").splitlines()
    assert len([line for line in lines if line.strip() and not line.startswith(("#", '"""'))]) <= 10


@pytest.mark.first(3)
@pytest.mark.parametrize("name", tasks(SCENES))
def test_a_scene_is_solved_with_small_stated_errors(name, folder):
    scene = load_scene(folder / name)
    jsonschema.validate(tomllib.loads((folder / name).read_text(encoding="utf-8")), scene_schema())
    # The quiet scenes are solved as they come; a weight that is put on costs seconds at the usual accuracy.
    answer = Mdr(accuracy=1e-4 if name == "creep.toml" else 1e-9).solve(scene)
    error = answer.error_estimate["normal_force"] if "normal_force" in answer.error_estimate else np.zeros(1)
    # An expansion to second order states its third.
    assert np.max(error) < (0.03 if isinstance(scene.indenter, Shape) else 1e-3)
    if isinstance(answer, ContactPath) and scene.effect(Friction) is None:
        assert np.all(np.diff(answer.normal_force) > 0.0)


@pytest.mark.first(4)
@pytest.mark.parametrize("name", tasks(SCRIPTS))
@pytest.mark.usefixtures("folder")
def test_a_script_prints_what_its_page_says(name, capsys):
    expected = re.search(rf"`{name}`[^\n]*\n```text\n(.*?)```", PAGE, re.DOTALL)
    runpy.run_path(name, run_name="__main__")
    assert capsys.readouterr().out == expected[1]


@pytest.mark.slow
@pytest.mark.usefixtures("folder")
def test_the_commands_of_the_page_run_and_write_their_files(capsys):
    commands = re.search(r"```sh\n(.*?)```", PAGE, re.DOTALL)[1].splitlines()
    for command in commands:
        assert run(command.split("  #")[0].split()[1:]) == 0, capsys.readouterr().err
    out = capsys.readouterr().out
    assert "Dimitriadis" in out
    assert "95 % interval" in out
    for name in ("fit.svg", "sweep.csv", "sweep.svg"):
        assert Path(name).stat().st_size > 0
    rows = np.genfromtxt("sweep.csv", delimiter=",", names=True)
    assert len(rows) == 12 * 20


@pytest.mark.slow
@pytest.mark.usefixtures("folder")
def test_notes_of_an_answer_are_told(capsys):
    assert run(["solve", "measured_tip.toml"]) == 0
    out = " ".join(capsys.readouterr().out.split())
    depth = "warning: the depth is 0.1 of the layer's thickness"
    for part in (depth, "smoothing changed the tip by at most", "Friction with mu = 0.1 changes the force"):
        assert part in out
    assert run(["solve", "afm_pyramid.toml"]) == 0
    assert "force and stiffness of second order in the deviation from a circle" in " ".join(
        capsys.readouterr().out.split()
    )


def test_the_figure_and_the_numbers_of_the_readme_are_those_of_the_example():
    root = FOLDER.parents[1]
    make = runpy.run_path(str(root / "assets" / "force_curve.py"))
    assert (FOLDER / "curve.csv").read_text(encoding="utf-8") == make["synthetic_curve"]()
    found = fit_curve(load_scene(FOLDER / "sphere_on_a_gel.toml"), *read_curve(FOLDER / "curve.csv"))
    with figure_style():
        drawn = svg_text(make["picture"](found), key="force_curve")
    assert texts(drawn) == texts((root / "assets" / "force_curve.svg").read_text(encoding="utf-8"))
    hertz, dimitriadis = (1e-3 * one.youngs_modulus for one in found.formulas[:2])
    low, high = (1e-3 * end for end in found.interval("youngs_modulus"))
    readme = (root / "README.md").read_text(encoding="utf-8")
    for number in (
        f"finds {hertz:.1f} kPa",
        f"thin layers {dimitriadis:.2f} kPa",
        f"layer itself {1e-3 * found.youngs_modulus:.2f} kPa",
        f"between {low:.2f} and {high:.2f}",
    ):
        assert number in readme


@pytest.mark.usefixtures("folder")
def test_fits_and_sweeps_are_printed_and_what_is_wrong_is_one_line(capsys):
    command = ["fit", "curve.csv", "sphere_on_a_gel.toml", "--with", "contact_point", "--write", "fit.csv"]
    assert run(command) == 0
    out = capsys.readouterr().out
    assert "5.002(41)" in out
    assert "+558 %" in out
    assert np.genfromtxt("fit.csv", delimiter=",", names=True).size == 160
    assert run(["solve", "force_steps.toml", "--over", "youngs_modulus=1kPa..1MPa:2:log"]) == 0
    assert "Young's modulus [MPa]" in capsys.readouterr().out
    for arguments, message in (
        (["fit", "curve.csv", "sphere_on_a_gel.toml", "--with", "colour"], "fit youngs_modulus, and any of"),
        (["fit", "none.csv", "sphere_on_a_gel.toml"], "cannot be read"),
        (["fit", "curve.csv", "sphere_on_a_gel.toml", "--write", "a.xls"], "use one of .csv"),
        (["solve", "force_steps.toml", "--over", "thickness"], 'write "thickness=1um..10um:20"'),
        (["solve", "force_steps.toml", "--over", "colour=1..2:3"], "over 'colour' is no number of the scene"),
        (["solve", "force_steps.toml", "--over", "values=1..2:3"], "it is a list of numbers"),
        (["solve", "force_steps.toml", "--over", "poissons_ratio=0.6..0.7:2"], "no value was answered"),
    ):
        assert run(arguments) == 4
        assert message in capsys.readouterr().err


def test_a_map_of_curves_from_a_file(folder, capsys):
    depth, force = np.genfromtxt(folder / "curve.csv", delimiter=",", skip_header=1, unpack=True)
    table = np.column_stack([depth * 1e-6, force * 1e-9, force * 2e-9])
    np.savetxt(folder / "map.csv", table, delimiter=",", header="depth [m],a [N],b [N]", comments="")
    command = ["fit", str(folder / "map.csv"), "sphere_on_a_gel.toml", "--map", "--write", str(folder / "out.csv")]
    assert run(command) == 0
    assert "2 of 2 fitted" in capsys.readouterr().out
    moduli = np.genfromtxt(folder / "out.csv", delimiter=",", skip_header=1, usecols=0)
    assert moduli == pytest.approx([4998.8, 9997.6], rel=1e-3, abs=0.0)


def test_a_sweep_is_a_frame_where_pandas_is(folder):
    from cases.sweep import sweep
    from contact import InvalidInput

    found = sweep(load_scene(folder / "force_steps.toml"), "poissons_ratio=0..0.5:2", Mdr())
    assert found.columns["poissons_ratio"].tolist() == [0.0, 0.0, 0.0, 0.5, 0.5, 0.5]
    try:
        import pandas  # noqa: F401
    except ImportError:
        with pytest.raises(InvalidInput, match="a frame needs pandas"):
            found.to_frame()
    else:
        assert list(found.to_frame().columns) == list(found.columns)

"""The command line: every way to end has its exit code, errors are one clear line, help comes at once."""

import csv
import json
import os
import re
import subprocess
import sys
from xml.etree import ElementTree

import h5py
import pytest
from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from cases.declare.registry import load_cases
from cases.run.runner import plan
from contact import load_scene
from reports import command_line
from reports.command_line import COMMANDS, GONE, run
from reports.commands import solve as solve_command
from tests.cases.fake_case import FAST, SLOW, fake_case, spoiled
from tests.cases.fake_method import FakeHertz
from tests.cases.gate.example_baselines import accepted
from tests.cases.test_run_lock import other_process

HERTZ = """
[layer]
half_space = true
youngs_modulus = 1e6
poissons_ratio = 0.3
[indenter]
kind = "paraboloid"
radius_of_curvature = 0.01
[loading]
kind = "contact_radii"
values = [0.5e-3, 1e-3]
"""


@pytest.fixture
def hertz(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(HERTZ, encoding="utf-8")
    return str(path)


def run_here(tmp_path, *more):
    return run(["run", "--executor", "serial", "--quiet", "--out", str(tmp_path / "out"), *more])


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_a_help_text(command, capsys):
    assert run([command, "--help"]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert len(shown) > 200
    assert "Exit codes: 0 passed; 1 a check failed" in shown


def test_there_are_six_commands():
    assert set(COMMANDS) == {"solve", "fit", "run", "gate", "accept", "report"}


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["solv"], "invalid choice: 'solv'"),
        (["solve"], "required: SCENE"),
        (["solve", "nowhere.toml"], "nowhere.toml: cannot be read"),
        (["run", "--suite", "weekly"], "'weekly'"),
        (["run", "--jobs", "0"], "jobs must be at least 1, got 0"),
        (["report", "nowhere"], "no run.json in nowhere"),
    ],
)
@pytest.mark.usefixtures("library")
def test_wrong_usage_is_one_clear_line_and_exit_code_4(arguments, words, capsys):
    assert run(arguments) == 4
    captured = capsys.readouterr()
    assert words in captured.err
    assert "Traceback" not in captured.err
    assert len(captured.err.strip().splitlines()) <= 2


def test_a_wrong_scene_names_place_value_and_remedy(hertz, tmp_path, capsys):
    path = tmp_path / "wrong.toml"
    path.write_text(HERTZ.replace("0.3", "0.6"), encoding="utf-8")
    assert run(["solve", str(path)]) == 4
    error = capsys.readouterr().err
    assert "poissons_ratio" in error
    assert "0.6" in error
    assert "Traceback" not in error


def test_an_internal_error_is_exit_code_3_with_its_traceback(monkeypatch, capsys):
    monkeypatch.setattr(command_line, "carry_out", lambda *_, **__: 1 / 0)
    assert run([]) == 3
    assert "ZeroDivisionError" in capsys.readouterr().err


def test_an_interrupt_is_exit_code_2(monkeypatch, capsys):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(command_line, "carry_out", interrupted)
    assert run([]) == 2
    assert "interrupted" in capsys.readouterr().err


@pytest.mark.usefixtures("library")
def test_a_sound_run_passes_and_writes_everything(tmp_path, capsys):
    assert run_here(tmp_path) == 0
    written = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"run.json", "answers.jsonl", "report.html", "summary.md", "junit.xml", "figures"} <= written
    output = capsys.readouterr().out
    assert "PASSED" in output
    assert "report.html" in output


@pytest.mark.usefixtures("without_pages")
@pytest.mark.parametrize(
    ("case", "words"),
    [
        (fake_case(slow=spoiled(SLOW, plant="nan")), "INVALID fake_hertz"),
        (fake_case(fast=spoiled(FAST, cell=1.0, error=1e-3)), "FAIL fake_hertz"),
    ],
    ids=["a broken solver", "a wrong number"],
)
def test_what_is_wrong_fails_the_run_by_name(case, words, library, tmp_path, capsys):
    """Every way to break is a row in `tests/cases/test_runner.py`; GitHub alone gets annotations."""
    library(case)
    assert run_here(tmp_path) == 1
    output = capsys.readouterr().out
    assert "FAILED" in output
    assert words in output
    assert "::error" not in output


@pytest.mark.usefixtures("without_pages")
def test_an_open_verdict_fails_only_when_strict(library, tmp_path):
    library(fake_case(slow=spoiled(SLOW, stated=1e-3)))
    assert run_here(tmp_path) == 0
    assert run_here(tmp_path, "--resume", "--strict") == 6


@pytest.mark.usefixtures("library", "without_pages")
def test_an_unknown_case_or_method_names_those_there_are(tmp_path, capsys):
    assert run_here(tmp_path, "nothing") == 4
    assert "fake_hertz" in capsys.readouterr().err
    assert run_here(tmp_path, "--method", "magic") == 4
    assert "fast, slow" in capsys.readouterr().err


@pytest.mark.usefixtures("library", "without_pages")
def test_one_method_alone_answers_the_claims_it_can(tmp_path):
    assert run_here(tmp_path, "--method", "fast") == 0
    verdicts = json.loads((tmp_path / "out" / "run.json").read_text(encoding="utf-8"))["verdicts"]
    assert {verdict["claim"] for verdict in verdicts} == {"closed form", "doubling E doubles F"}


def test_the_list_counts_a_solution_that_several_claims_need_once(capsys):
    assert run(["run", "--list"]) == 0
    solutions = len(plan(case.in_suite("") for case in load_cases().values()))
    assert f", {solutions} solutions: all valid" in capsys.readouterr().out


@pytest.mark.usefixtures("library")
def test_the_library_is_listed_shown_and_validated(capsys):
    assert run(["run", "--list"]) == 0
    listed = capsys.readouterr().out
    assert "fake_hertz" in listed
    assert "all valid" in listed
    assert run(["run", "--list", "fake_hertz"]) == 0
    shown = capsys.readouterr().out
    for words in ("Fabricated Hertz contact", "half-space nu=0.3", "closed form", "round-off"):
        assert words in shown
    assert run(["run", "--list", "nothing"]) == 4


def test_schema_describes_scenes(capsys):
    assert run(["solve", "--schema"]) == 0
    assert {"layer", "indenter", "loading"} <= set(json.loads(capsys.readouterr().out)["properties"])


def test_two_methods_are_compared_beside_the_errors_they_state(hertz, capsys):
    assert run(["solve", hertz, "--against", "integral_equation"]) == 0
    shown = capsys.readouterr().out
    assert "MDR against integral equation" in shown
    difference, stated = re.search(r"normal force +(\S+) +(\S+)", shown).groups()
    assert float(difference) <= float(stated) < 1e-6
    assert run(["solve", hertz, "--against", "fem", "--advise"]) == 4
    assert "ask one at a time" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--advise", "--write", "a.csv"], "--advise writes no file"),
        (["--over", "youngs_modulus=1e6..2e6:2", "--accuracy", "1e-4"], "--over states the error of each answer"),
        (["--uncertain", "youngs_modulus=3%", "--method", "fake", "--accuracy", "1e-20"], "asked for 1.0e-20"),
    ],
)
def test_no_option_is_left_aside_in_silence(hertz, options, words, capsys, monkeypatch):
    monkeypatch.setattr(solve_command, "build_guarded", lambda *_: FakeHertz(stated=1e-2))
    assert run(["solve", hertz, *options]) in (1, 4)
    assert words in capsys.readouterr().err.replace("\n", " ")


@pytest.mark.slow
def test_pictures_are_written_in_three_formats(hertz, tmp_path):
    begins = {".svg": b"<svg", ".png": b"\x89PNG", ".pdf": b"%PDF"}
    files = [tmp_path / f"answer{ending}" for ending in begins]
    assert run(["solve", hertz, *(word for file in files for word in ("--write", str(file)))]) == 0
    assert all(file.read_bytes().startswith(begins[file.suffix]) for file in files)


def test_solve_prints_numbers_with_error_bars_and_writes_files(hertz, tmp_path, capsys):
    files = [str(tmp_path / f"answer{ending}") for ending in (".csv", ".h5", ".svg")]
    writes = [word for file in files for word in ("--write", file)]
    assert run(["solve", hertz, "--method", "fake", *writes]) == 0
    output = capsys.readouterr().out
    assert "F [mN]" in output
    assert "18.315" in output  # Hertz: 4/3 E* a^3 / R at a = 0.5 mm, E* = 1e6/0.91 Pa
    with open(files[0], encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert float(rows[1]["normal_force_N"]) == pytest.approx(4 / 3 * (1e6 / 0.91) * 1e-9 / 0.01, rel=1e-14, abs=0.0)
    assert float(rows[1]["normal_force_uncertainty_N"]) == 0.0
    with h5py.File(files[1]) as stored:
        assert stored["arrays/normal_force"][1] == float(rows[1]["normal_force_N"])
    assert (tmp_path / "answer.svg").read_text(encoding="utf-8").startswith("<svg")


def test_critical_numbers_stand_above_the_table_and_masses_in_grams(capsys):
    """The restitution came below forty states of the impact, and 4 g were 4 mkg."""
    assert run(["solve", "examples/tasks/impact.toml"]) == 0
    out = capsys.readouterr().out
    assert out.index("warning: ") < out.index("coefficient of restitution: ") < out.index("MDR: ")
    assert "Impact(mass=4 g, " in out


def test_a_range_is_printed_in_units_with_a_prefix(capsys):
    assert run(["solve", "examples/tasks/sphere_on_a_gel.toml", "--over", "thickness=2um..50um:2:log"]) == 0
    assert "thickness [µm]  contact radius [µm]" in capsys.readouterr().out


def test_solve_refuses_an_answer_less_accurate_than_asked(hertz, capsys, monkeypatch):
    assert run(["solve", hertz, "--method", "fake", "--accuracy", "1e-3"]) == 0
    monkeypatch.setattr(solve_command, "build_guarded", lambda *_: FakeHertz(stated=1e-2))
    assert run(["solve", hertz, "--method", "fake", "--accuracy", "1e-3"]) == 1
    assert "asked for 1.0e-03" in capsys.readouterr().err
    assert run(["solve", hertz, "--method", "fake", "--accuracy", "-1"]) == 4


@pytest.fixture
def punch(tmp_path):
    """The quickest scene of finite elements; its pressure is singular at the rim."""
    scene = tmp_path / "punch.toml"
    scene.write_text(
        "[layer]\nthickness = 1e-3\nyoungs_modulus = 1e6\npoissons_ratio = 0.3\n"
        '[indenter]\nkind = "flat_punch"\nradius = 1e-3\n'
        '[loading]\nkind = "indentation_depths"\nvalues = [1e-5]\n',
        encoding="utf-8",
    )
    return str(scene)


def test_an_accuracy_is_no_accuracy_of_the_pressure(punch, capsys):
    fem = ["solve", punch, "--method", "fem", "--accuracy", "1e-3"]
    assert run(fem) == 0
    note = r"note: less accurate than the 0.001 asked for, by the stated relative errors: pressure \d\.\de-0\d"
    out = capsys.readouterr().out.replace("\n", " ")
    assert re.search(note, out).start() < out.index("FEM: ")
    assert run([*fem, "--pressure-accuracy", "2e-2"]) == 0
    assert "note:" not in capsys.readouterr().out
    assert (
        run(["solve", punch, "--method", "integral_equation", "--accuracy", "1e-4", "--pressure-accuracy", "1e-15"])
        == 1
    )
    assert "relative error of pressure" in capsys.readouterr().err.replace("\n", " ")
    assert run(["solve", punch, "--pressure-accuracy", "1e-3"]) == 4
    assert "besides an --accuracy" in capsys.readouterr().err.replace("\n", " ")


@pytest.mark.slow
def test_the_layer_inside_as_a_picture_and_for_paraview(punch, tmp_path):
    picture, files = tmp_path / "inside.svg", [tmp_path / "field.vtu", tmp_path / "field.xdmf"]
    written = [word for file in (*files, picture) for word in ("--write", str(file))]
    assert run(["solve", punch, "--method", "fem", *written]) == 0
    shown = " ".join(ElementTree.fromstring(picture.read_text(encoding="utf-8")).itertext())
    for words in ("von Mises stress", "hydrostatic pressure", "difference", "MDR", "FEM", "[kPa]", "a = 1 mm"):
        assert words in shown
    for words in ("flat punch on a bonded layer", "arrows: where it falls", "at 99.5 % of points below"):
        assert words in shown
    for file, reader in zip(files, (vtkXMLUnstructuredGridReader(), vtkXdmfReader()), strict=True):
        reader.SetFileName(str(file))
        reader.Update()
        data = reader.GetOutputDataObject(0).GetPointData()
        names = {data.GetArrayName(i) for i in range(data.GetNumberOfArrays())}
        assert {"displacement", "hydrostatic_pressure", "pressure_gradient", "von_mises", "principal_stresses"} <= names


def test_a_mesh_is_asked_of_a_method_that_has_one(punch, tmp_path, capsys):
    assert run(["solve", punch, "--write", str(tmp_path / "field.vtu")]) == 4
    assert "mdr has no mesh of this scene; add --method fem" in capsys.readouterr().err.replace("\n", " ")


def test_an_accuracy_is_reached_by_the_first_method_that_states_it(hertz, capsys):
    assert run(["solve", hertz, "--accuracy", "1e-4"]) == 0
    assert re.search(r"achieved: stated error \S+, asked for 1.0e-4, by mdr", capsys.readouterr().out)


@pytest.mark.parametrize("name", GONE)
def test_a_command_that_is_gone_says_where_it_went(name, capsys):
    assert run([name, "--out", "x"]) == 4
    assert GONE[name] in capsys.readouterr().err.replace("\n", " ")


def test_solve_refuses_an_unknown_ending_before_it_solves(hertz, capsys):
    assert run(["solve", hertz, "--write", "answer.xls"]) == 4
    assert ".csv" in capsys.readouterr().err


@pytest.mark.parametrize("ending", [".csv", ".h5", ".svg"])
def test_solve_refuses_a_place_where_no_file_can_be_before_it_solves(hertz, tmp_path, ending, capsys):
    (tmp_path / f"folder{ending}").mkdir()
    for file in (tmp_path / "nowhere" / f"a{ending}", tmp_path / f"folder{ending}"):
        assert run(["solve", hertz, "--write", str(file)]) == 4
        assert "no file can be there" in capsys.readouterr().err.replace("\n", " ")


def test_a_full_disk_is_one_clear_line(hertz, tmp_path, capsys):
    (tmp_path / "full.csv").symlink_to("/dev/full")
    assert run(["solve", hertz, "--method", "fake", "--write", str(tmp_path / "full.csv")]) == 4
    assert "No space left on device" in capsys.readouterr().err.replace("\n", " ")


def test_the_example_scene_is_a_scene(tmp_path, capsys):
    assert run(["solve", "--example"]) == 0
    path = tmp_path / "example.toml"
    path.write_text(capsys.readouterr().out, encoding="utf-8")
    assert load_scene(path).indenter.flat_radius == 0.5e-3


def processor_seconds(code):
    """Of a process that runs the code; another job on the machine does not count."""
    start = os.times()
    subprocess.run([sys.executable, "-c", code], check=True, stdout=subprocess.DEVNULL)
    end = os.times()
    return (end.children_user - start.children_user) + (end.children_system - start.children_system)


def test_help_loads_no_solver_and_takes_hardly_longer_than_the_library_that_prints_it():
    used = processor_seconds(
        "import sys; from reports.command_line import run; run(['--help']); "
        "heavy = {'numpy', 'scipy', 'matplotlib', 'skfem', 'gmsh', 'pydantic', 'h5py'} & set(sys.modules); "
        "sys.exit(f'loaded: {heavy}' if heavy else 0)"
    )
    assert used < 2.0 * processor_seconds("import argparse, importlib.metadata, importlib.resources, inspect")


@pytest.mark.slow
def test_commands_compute_on_one_thread_unless_told_otherwise():
    code = (
        "import reports.command_line, scipy.linalg, threadpoolctl; "
        "pools = [p['num_threads'] for p in threadpoolctl.threadpool_info() if p['user_api'] == 'blas']; "
        "print(max(pools))"
    )
    free = {name: value for name, value in os.environ.items() if not name.endswith("_NUM_THREADS")}
    for asked, threads in (({}, 1), ({"OMP_NUM_THREADS": "2"}, min(2, os.cpu_count() or 1))):
        done = subprocess.run(
            [sys.executable, "-c", code], env=free | asked, capture_output=True, text=True, check=True
        )
        assert int(done.stdout) == threads


@pytest.mark.usefixtures("library", "without_pages")
def test_a_folder_in_which_another_run_works_is_refused_in_one_line(tmp_path, capsys, monkeypatch):
    assert run_here(tmp_path) == 0
    before = (tmp_path / "out" / "run.json").read_bytes()
    accepted(tmp_path / "baselines")
    monkeypatch.chdir(tmp_path)
    capsys.readouterr()
    with other_process(tmp_path / "out"):
        for command in (["report"], ["gate"], ["run", "--executor", "serial", "--out"]):
            assert run([*command, str(tmp_path / "out")]) == 4, command
            lines = capsys.readouterr().err.strip().splitlines()
            assert len(lines) == 1, command
            assert "another run works in" in lines[0], command
            assert (tmp_path / "out" / "run.json").read_bytes() == before, command


@pytest.mark.usefixtures("without_pages")
def test_the_report_of_a_run_without_cases_is_exit_code_5(library, tmp_path, capsys):
    library()
    assert run_here(tmp_path) == 5
    assert run(["report", str(tmp_path / "out")]) == 5
    assert "Nothing ran" in capsys.readouterr().out
    library(fake_case())
    run(["run", "--executor", "serial", "--quiet", "--out", str(tmp_path / "other")])
    assert run(["report", str(tmp_path / "other")]) == 0
    assert run(["report", str(tmp_path / "out"), str(tmp_path / "other")]) == 5


@pytest.mark.usefixtures("library", "without_pages")
def test_the_report_of_a_damaged_run_is_refused_in_one_line(tmp_path, capsys):
    assert run_here(tmp_path) == 0
    results = tmp_path / "out" / "run.json"
    text = results.read_text(encoding="utf-8")
    results.write_text(re.sub(r'"error": (\S+),', '"error": NaN,', text), encoding="utf-8")
    for command in (["report"], ["gate"]):
        capsys.readouterr()
        assert run([*command, str(tmp_path / "out")]) == 4
        captured = capsys.readouterr()
        assert "PASSED" not in captured.out
        assert len(captured.err.strip().splitlines()) == 1

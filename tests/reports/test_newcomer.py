"""What a newcomer meets first: sweeps drawn over depth, and messages that say what to do next."""

import io
import re
import time

import numpy as np
import pytest

from cases.sweep import read_range, sweep
from contact import FlatPunch, ForcePath, Friction, FrictionPath, IndentationDepths, Layer, Scene, Sphere, StageLog
from mdr import Mdr
from reports import terminal
from reports.answer import solution_table
from reports.command_line import run
from reports.pictures import sweep_figure
from reports.terminal import Terminal

SCENE = Scene(
    layer=Layer(thickness=1.5e-3, youngs_modulus=0.8e6, poissons_ratio=0.45),
    indenter=Sphere(radius=3e-3),
    loading=IndentationDepths(np.linspace(0.0, 1.5e-4, 5)),
)
TOML = """
layer = {thickness = "1.5 mm", youngs_modulus = "0.8 MPa", poissons_ratio = 0.45}
indenter = {kind = "sphere", radius = "3 mm"}
loading = {kind = "indentation_depths", values = ["0.15 mm"]}
"""
SLIDING = TOML + '[[effects]]\nkind = "friction"\ncoefficient = 0.1\n'


def test_a_sweep_of_more_depths_than_values_is_drawn_over_the_depth_with_a_line_per_value():
    drawn = sweep_figure(sweep(SCENE, read_range("thickness=1e-3..2e-3:2", SCENE, with_units=False), Mdr()))
    assert drawn.axes[1].get_xlabel() == "indentation depth [µm]"
    assert [line.get_label() for line in drawn.axes[1].lines] == ["thickness [mm]: 1", "thickness [mm]: 2"]
    thin, thick = (line.get_ydata()[-1] for line in drawn.axes[1].lines)
    assert thin > 1.2 * thick


def test_a_sweep_of_more_values_than_depths_is_drawn_over_the_value_with_a_line_per_depth():
    drawn = sweep_figure(sweep(SCENE, read_range("thickness=1e-3..2e-3:6", SCENE, with_units=False), Mdr()))
    axes = drawn.axes[1]
    assert axes.get_xlabel() == "thickness [mm]"
    depths = [f"indentation depth [µm]: {depth:g}" for depth in (0, 37.5, 75, 112.5, 150)]
    assert [line.get_label() for line in axes.lines] == depths
    assert axes.get_xscale() == "linear"


def test_a_line_of_a_punch_is_named_by_its_load_and_not_by_its_own_radius():
    pressed = SCENE.replace(indenter=FlatPunch(radius=1e-3), loading=IndentationDepths([1e-5, 2e-5]))
    drawn = sweep_figure(sweep(pressed, read_range("thickness=1e-3..2e-3:3", pressed), Mdr()))
    labels = [line.get_label() for line in drawn.axes[0].lines]
    assert labels == ["indentation depth [µm]: 10", "indentation depth [µm]: 20"]


def test_a_range_by_equal_factors_is_drawn_on_a_logarithmic_axis():
    drawn = sweep_figure(sweep(SCENE, read_range("thickness=1e-3..1e-1:6:log", SCENE), Mdr()))
    assert {axes.get_xscale() for axes in drawn.axes} == {"log"}


@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["impact.toml"], "10 of 51 states; --write FILE.csv has all"),
        (["afm_pyramid.toml", "--over", "thickness=4um..8um:6"], "10 of 12 rows; --write FILE.csv has all"),
    ],
)
def test_at_most_ten_rows_are_printed_and_where_the_others_are(arguments, told, monkeypatch, capsys):
    monkeypatch.chdir("examples/tasks")
    assert run(["solve", *arguments]) == 0
    out = capsys.readouterr().out
    assert told in " ".join(out.split())
    assert len([line for line in out.splitlines() if not re.search("[a-zA-Z]{2}", line)]) == 10


def test_each_column_of_an_answer_is_explained():
    scene = SCENE.replace(loading=IndentationDepths([1e-5]), effects=[Friction(coefficient=0.1)])
    numbers = dict.fromkeys((*FrictionPath.ARRAYS,), np.ones(1))
    cost = StageLog().cost(unknowns=1)
    answer = FrictionPath(scene=scene, method="fem", settings={}, error_estimate={}, cost=cost, **numbers)
    note = solution_table(answer).note
    assert "c: stick radius" in note
    assert "E_diss: dissipated energy" in note


class ForceAlone:
    """A method of another package that gives no contact radius."""

    name = "force_alone"

    def solve(self, scene):
        found = Mdr().solve(scene)
        numbers = {name: getattr(found, name) for name in ForcePath.ARRAYS}
        return ForcePath(scene=scene, method=self.name, settings={}, error_estimate={}, cost=found.cost, **numbers)


def test_an_answer_without_a_contact_radius_is_printed_and_drawn(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("reports.commands.solve.build_guarded", lambda *_: ForceAlone())
    monkeypatch.setattr("reports.commands.solve.load", lambda *_: ForceAlone)
    files = [tmp_path / "scene.toml", tmp_path / "a.svg"]
    files[0].write_text(TOML, encoding="utf-8")
    assert run(["solve", str(files[0]), "--method", "force_alone", "--write", str(files[1])]) == 0
    assert "F [mN]" in capsys.readouterr().out
    assert files[1].is_file()


@pytest.mark.parametrize("command", [["solve", "scene.toml"], ["run", "truncated_cone"]])
def test_an_unknown_method_says_how_one_is_registered(command, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.toml").write_text(TOML, encoding="utf-8")
    assert run([*command, "--method", "mysolver"]) == 4
    told = " ".join(capsys.readouterr().err.split())
    assert "entry point of the group contact_verification.methods (examples/hertz_half_space)" in told


@pytest.mark.parametrize(("seconds", "is_shown"), [(0.0, False), (0.3, True)])
def test_a_long_computation_shows_on_a_terminal_that_it_goes_on(seconds, is_shown, monkeypatch):
    stream = io.StringIO()
    monkeypatch.setattr(terminal, "PATIENCE", 0.1)
    monkeypatch.setattr(terminal, "console", lambda **_: Terminal(file=stream, force_terminal=True))
    with terminal.progress_bar("solving"):
        time.sleep(seconds)
    assert ("solving" in stream.getvalue()) is is_shown


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["fit", "curve.csv"], "Try: contact-verify fit --help"),
        (["nothing"], "Try: contact-verify --help"),
        (["fit", "curve.csv", "scene.toml"], "give --units nm,nN in the order of the columns"),
        (["fit", "curve.csv", "scene.toml", "--units", "mm,N"], "column 'Force', unit 'mm': must be a force"),
        (["fit", "heads.csv", "scene.toml"], "rename the heads (Load, Disp)"),
        (["solve", "sliding.toml"], "use finite elements (--method fem)"),
    ],
)
def test_a_message_says_what_to_do_next(arguments, message, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    rows = "".join(f"{0.001 * k},{0.01 * k}\n" for k in range(20))
    for name, text in {
        "curve.csv": f"Force,Depth\n{rows}",
        "heads.csv": f"Load N,Disp mm\n{rows}",
        "scene.toml": TOML,
        "sliding.toml": SLIDING,
    }.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    assert run(arguments) == 4
    assert message in capsys.readouterr().err

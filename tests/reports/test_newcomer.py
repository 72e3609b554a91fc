"""What a newcomer meets first: sweeps drawn over depth, and messages that say what to do next."""

import numpy as np
import pytest

from cases.sweep import read_range, sweep
from contact import IndentationDepths, Layer, Scene, Sphere
from mdr import Mdr
from reports.command_line import run
from reports.pictures import sweep_figure

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
    assert drawn.axes[1].get_xlabel() == "thickness [mm]"
    assert len(drawn.axes[1].lines) == 5


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

"""The picture of one answer shows what the scene does between the prescribed states, or symbols only."""

import re
from pathlib import Path

import numpy as np
import pytest

from contact import DepthHistory, IndentationDepths, load_scene
from fem_reference import Fem
from mdr import Mdr
from reports.command_line import run
from reports.pictures import between, solution_figure

TASKS = Path("examples/tasks")
RELAXATION = load_scene(TASKS / "relaxation.toml")


def longest_line(svg):
    """Number of corners of the curve with most of them."""
    return max(path.count("L") for path in re.findall(r'<path d="([^"]*)" clip-path', svg))


@pytest.mark.first(1)
@pytest.mark.parametrize("task", ["relaxation", "creep", "afm_pyramid", "worn_tip"])
def test_a_written_picture_follows_the_answer_between_prescribed_states(task, tmp_path, capsys):
    file = tmp_path / "answer.svg"
    assert run(["solve", str(TASKS / f"{task}.toml"), "--write", str(file)]) == 0
    assert longest_line(file.read_text()) > 4
    assert "prescribed states" in file.read_text()


def test_the_line_of_a_relaxation_is_the_answer_at_instants_that_were_not_asked_for():
    axes = solution_figure(Mdr().solve(RELAXATION), Mdr().solve(between(RELAXATION))).axes[0]
    curve, symbols = (line.get_xydata().T for line in axes.lines[:2])
    asked = RELAXATION.replace(loading=DepthHistory(time=[0.0, 0.1, 3.0, 10.0], depth=[0.0, 5e-5, 5e-5, 5e-5]))
    force = 1e6 * Mdr().solve(asked).normal_force[2]
    assert force == pytest.approx(318, rel=1e-2, abs=0.0)
    assert np.interp(3.0, *curve) == pytest.approx(force, rel=1e-3, abs=0.0)
    assert symbols[0].tolist() == [0.0, 0.1, 10.0]
    assert axes.lines[1].get_linestyle() == "None"


def test_prescribed_states_alone_are_symbols_and_steps_of_a_method_a_line():
    two = load_scene(TASKS / "afm_pyramid.toml")
    assert solution_figure(Mdr().solve(two)).axes[0].lines[0].get_linestyle() == "None"
    assert between(two.replace(loading=IndentationDepths([1e-7]))) is None
    (steps,) = solution_figure(Fem(order=2, edge_cell=1e-2).solve(RELAXATION)).axes[0].lines
    assert steps.get_linestyle() == "-"
    assert len(steps.get_xdata()) > 3

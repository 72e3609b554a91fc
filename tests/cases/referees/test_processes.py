"""Solvers of others run apart: what is absent, crashes or talks nonsense is told by name."""

import sys

import numpy as np
import pytest

from cases.declare.guarded_method import build_guarded
from cases.declare.methods import REFEREES, build
from cases.referees import process
from cases.referees.grids import LARGEST_HEIGHT, box, heights
from contact import (
    Cone,
    ContactRadii,
    FlatPunch,
    Friction,
    IndentationDepths,
    Layer,
    Method,
    NotConvergedError,
    Paraboloid,
    Scene,
)

HALF_SPACE = Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.3)
LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.3)


def pressed(layer=HALF_SPACE, indenter=None, loading=None):
    return Scene(
        layer=layer,
        indenter=indenter or Paraboloid(radius_of_curvature=1e-2),
        loading=loading or IndentationDepths(values=np.array([1e-5])),
    )


@pytest.fixture
def worker(tmp_path, monkeypatch):
    monkeypatch.setattr(process, "WORKERS", tmp_path)
    monkeypatch.delenv(process.INTERPRETER, raising=False)

    def write(text):
        (tmp_path / "some.py").write_text(text, encoding="utf-8")

    return write


def test_arrays_come_back_to_the_last_digit(worker):
    worker(
        "import json, sys\nx = json.load(sys.stdin)['x']\nprint('talk')\n"
        "print(json.dumps({'twice': [2 * v for v in x]}))"
    )
    assert process.run_worker("some", {"x": [0.1, 1 / 3]})["twice"].tolist() == [0.2, 2 / 3]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("raise SystemExit('no licence')", "ended with code 1 and no answer: no licence"),
        ("import os; os.kill(os.getpid(), 11)", "ended with code -11"),
        ("print('not json')", "ended with code 0 and no answer: not json"),
        ("print('[1]')", "no answer"),
        ("", "no answer"),
    ],
)
def test_a_worker_that_fails_is_told_by_name(worker, text, words):
    worker(text)
    with pytest.raises(NotConvergedError, match=f"some .*{words}"):
        process.run_worker("some", {})


def test_an_absent_package_is_one_reason(monkeypatch):
    monkeypatch.setenv(process.INTERPRETER, sys.executable)
    process.version.cache_clear()
    assert "no-such-package is not installed: pip install" in process.lacks("no-such-package")
    assert process.lacks("numpy") == ""
    process.version.cache_clear()


@pytest.mark.parametrize("name", REFEREES)
def test_every_referee_is_a_method_and_refuses_what_it_does_not_model(name):
    method = build(name, {})
    assert isinstance(method, Method)
    assert build_guarded(name, {}).refined()
    support = method.supports(pressed(layer=LAYER).replace(effects=(Friction(coefficient=0.1),)))
    assert not support
    assert support.reason


def test_grids_reach_beyond_the_contact():
    assert box(pressed(), 1e-5) >= 2 * np.sqrt(1e-2 * 1e-5)
    assert box(pressed(layer=LAYER, indenter=FlatPunch(radius=2e-3)), 1e-5) == pytest.approx(0.012, rel=1e-12, abs=0.0)


def test_grids_take_no_radii():
    support = build("contact_mechanics", {}).supports(pressed(loading=ContactRadii(values=np.array([1e-3]))))
    assert support.reason == "takes IndentationDepths and NormalForces only"


def test_heights_on_the_grid_are_those_of_the_indenter_and_nothing_beyond_a_rim_touches():
    cone = np.array(heights(pressed(indenter=Cone(slope=0.1)), 4, 4.0))
    assert cone[0, 0] == pytest.approx(-0.1 * np.hypot(1.5, 1.5), rel=1e-14, abs=0.0)
    assert np.all(cone == cone[::-1, ::-1])
    punch = np.array(heights(pressed(indenter=FlatPunch(radius=1.0)), 4, 4.0))
    assert sorted(set(punch.ravel())) == [-LARGEST_HEIGHT * 4.0, 0.0]

"""The wheel alone: what is imported, and a user who has installed nothing but it and what it needs."""

import os
import resource
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tests.architecture.test_distributions import built  # noqa: F401  # the fixture

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
HEAVY = ("scipy", "matplotlib", "gmsh", "skfem", "meshio", "h5py", "pyfftw", "jinja2", "rich", "pint")
# Processor time [s] that `import mdr` may take: the requirement.
IMPORT_SECONDS = 0.2

SOLVE = """
from contact import ContactRadii, Layer, Paraboloid, Scene
from mdr import Mdr
layer = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.5)
scene = Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=0.01), loading=ContactRadii([1e-3]))
print(f"{Mdr().solve(scene).normal_force[0]:.6f}")
"""


def asked(*words, **options):
    done = subprocess.run(words, capture_output=True, text=True, check=False, **options)
    return done.returncode, done.stdout, done.stderr


def test_public_names_are_loaded_when_asked_for():
    code = "import mdr, sys; assert 'numpy' not in sys.modules; print(mdr.Mdr().name, *dir(mdr)); mdr.nothing"
    _, out, error = asked(sys.executable, "-c", code, cwd=ROOT)
    assert out.split() == ["mdr", "Mdr", "SeveralContacts", "Springs"]
    assert "module 'mdr' has no attribute 'nothing'" in error


@pytest.mark.slow
def test_import_takes_less_than_a_fifth_of_a_second_of_processor_time():
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert asked(sys.executable, "-c", "import mdr", cwd=ROOT)[0] == 0
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime < IMPORT_SECONDS


def test_what_only_some_users_need_is_an_extra():
    base = " ".join(PROJECT["dependencies"])
    extras = PROJECT["optional-dependencies"]
    assert {"fem", "report", "fit", "cluster", "referees"} <= set(extras)
    for package in ("gmsh", "meshio", "matplotlib", "scikit-fem", "jinja2", "afmformats", "dask"):
        assert package not in base


@pytest.fixture(scope="module")
def users_python(built, tmp_path_factory):  # noqa: F811
    """A fresh environment with the wheel and its dependencies, no extra."""
    place = tmp_path_factory.mktemp("environment")
    assert asked(sys.executable, "-m", "venv", str(place))[0] == 0
    python = place / "bin" / "python"
    wheel = next(built.glob("*.whl"))
    words = (str(python), "-m", "pip", "install", "--quiet", "--constraint", str(ROOT / "constraints.txt"), str(wheel))
    code, _, error = asked(*words)
    if code and ("No matching distribution" in error or "onnection" in error):
        pytest.skip("no package index in reach")
    assert code == 0, error[-2000:]
    return python


@pytest.mark.slow
def test_a_user_of_the_wheel_solves_runs_and_accepts(users_python, tmp_path):
    command = str(users_python.with_name("contact-verify"))
    quiet = {"cwd": tmp_path, "env": {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "CI")}}
    assert asked(str(users_python), "-c", SOLVE, **quiet) == (0, "0.250756\n", "")
    for name in HEAVY[1:5]:
        assert asked(str(users_python), "-c", f"import {name}", **quiet)[0] == 1
    _, example, _ = asked(command, "solve", "--example", **quiet)
    (tmp_path / "scene.toml").write_text(example, encoding="utf-8")
    assert asked(command, "solve", "scene.toml", "--write", "answer.csv", **quiet)[0] == 0
    code, _, error = asked(command, "solve", "scene.toml", "--method", "fem", **quiet)
    assert (code, "pip install 'contact-verification[fem]'" in " ".join(error.split())) == (4, True)
    (tmp_path / ".gitignore").write_text("out\n", encoding="utf-8")
    who = ("-c", "user.name=user", "-c", "user.email=user@example.org")
    for words in (("init", "--quiet"), ("add", "."), ("commit", "--quiet", "--message", "A scene")):
        assert asked("git", *who, *words, **quiet)[0] == 0
    run = asked(command, "run", "thin_layer_limits", "--method", "mdr", "--out", "out", "--quiet", **quiet)
    assert run[0] == 0, run
    assert "no pages: " in run[2]
    assert (tmp_path / "out" / "summary.md").is_file()
    accepted = asked(command, "accept", "thin_layer_limits", "--reason", "first", "--run", "out", "--write", **quiet)
    assert accepted[0] == 0, accepted
    gate = asked(command, "gate", "out", "--method", "mdr", **quiet)
    assert gate[0] == 0, gate

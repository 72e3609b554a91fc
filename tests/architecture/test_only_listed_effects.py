"""An effect that a scene does not list is not imported, not called, holds no state and changes no bit."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

SCENES = """
import json, sys
from contact import *
from cases.declare.methods import build
layer = Layer(thickness=1.0, youngs_modulus=3.0, poissons_ratio=0.5)
cone = TruncatedCone(flat_radius=0.5, slope=0.1)
solid = StandardSolid(long_term_shear_modulus=0.25, maxwell_shear_modulus=0.75, viscosity=0.5)
SCENES = {
    "elastic": Scene(layer=layer, indenter=cone, loading=ContactRadii([1.0])),
    "depths": Scene(layer=layer, indenter=cone, loading=IndentationDepths([0.05])),
    "adhesive": Scene(layer=layer, indenter=cone, loading=Detachment(initial_contact_radius=1.0),
                      effects=(Adhesion(work_of_adhesion=1e-4),)),
    "adhered": Scene(layer=layer, indenter=FlatPunch(radius=1.0), loading=IndentationDepths([0.05]),
                     effects=(Friction(coefficient=float("inf")),)),
    "sticky": Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=5.0), loading=ContactRadii([1.0]),
                    effects=(Adhesion(work_of_adhesion=1e-4),)),
    "impact": Scene(layer=layer, indenter=cone, loading=Impact(mass=0.1, velocity=0.05)),
    "viscoelastic": Scene(layer=layer, indenter=cone, loading=Impact(mass=0.1, velocity=0.05), effects=(solid,)),
}
method, scene = build(sys.argv[1], json.loads(sys.argv[3])), SCENES[sys.argv[2]]
if not method.supports(scene):
    print(json.dumps(None)); raise SystemExit
answer = method.solve(scene)
print(json.dumps({
    "modules": sorted(m for m in sys.modules if m.split(".")[0] in ("bem", "mdr", "fem_reference")),
    "foreign": sorted({m.split(".")[0] for m in sys.modules} & {"pyfftw", "skfem", "gmsh", "matplotlib", "h5py"}),
    "stages": sorted(stage.name for stage in answer.stages),
}))
"""


def solved(method, scene, settings="{}"):
    """Import set and stage set of one solution in a process of its own."""
    command = [sys.executable, "-W", "error::RuntimeWarning", "-c", SCENES, method, scene, settings]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


IN_TIME = ("mdr.history", "mdr.impact", "fem_reference.memory", "fem_reference.motions")
ADHESION = ("mdr.adhesive", "mdr.detachment", "fem_reference.adhesion")
FRICTION = ("mdr.friction", "fem_reference.friction")
EFFECTS = (*IN_TIME, *ADHESION, *FRICTION)
# Modules of other methods, which an answer of a method never loads, and packages that it may load.
OTHERS = {
    "mdr": ("fem_reference", "bem.grid.transforms", "bem.grid.discs", "bem.grid.operators"),
    "mdr_table": ("fem_reference",),
    "integral_equation": ("mdr", "fem_reference", "bem.grid.transforms"),
    "bem": ("mdr", "fem_reference"),
    "fem": ("mdr", "bem"),
}
PACKAGES = {"fem": {"skfem", "gmsh"}, "bem": {"pyfftw"}, "mdr_table": {"pyfftw", "h5py"}}
SETTINGS = {
    "fem": '{"order": 2, "edge_cell": 1e-2}',
    "bem": '{"points": 96}',
    "mdr_table": '{"cells": 64, "ratios": 60, "radii": 100}',
}
MDR_STAGES = ["flat_punch_data", "force", "mdr_profile"]
# Method, scene, what of the effects it loads, and its stages where they are those of an elastic scene.
LOADED = [
    ("mdr", "elastic", (), MDR_STAGES),
    ("mdr", "adhesive", ADHESION, None),
    ("mdr", "impact", IN_TIME, None),
    ("fem", "elastic", (), ["assemble", "factor", "mesh", "recover", "solve"]),
    ("fem", "viscoelastic", IN_TIME, None),
    ("fem", "sticky", ADHESION, None),
    ("fem", "adhered", FRICTION, None),
    ("bem", "elastic", (), ["contact", "field_errors", "fields"]),
    ("integral_equation", "elastic", (), ["error_estimate", "integral_equation", "one_circle"]),
]
LOADED_RARELY = [
    ("mdr", "depths", (), MDR_STAGES),
    ("mdr", "adhered", FRICTION, None),
    ("mdr_table", "elastic", (), MDR_STAGES),
]


def effects_among(found):
    return [name for name in found["modules"] if name.startswith(EFFECTS)]


@pytest.mark.parametrize(
    ("method", "scene", "loads", "stages"),
    [*LOADED, *(pytest.param(*row, marks=pytest.mark.slow) for row in LOADED_RARELY)],
)
def test_an_answer_loads_what_its_scene_lists_and_nothing_of_another_effect_or_method(method, scene, loads, stages):
    found = solved(method, scene, SETTINGS.get(method, "{}"))
    effects = effects_among(found)
    assert bool(effects) == bool(loads)
    assert [name for name in effects if not name.startswith(loads)] == []
    assert [name for name in found["modules"] if name.startswith(OTHERS[method])] == []
    assert set(found["foreign"]) <= PACKAGES.get(method, set())
    assert stages in (None, found["stages"])


@pytest.mark.slow
def test_boundary_elements_follow_a_branch_with_adhesion():
    found = solved("bem", "sticky", SETTINGS["bem"])
    assert any("adh" in stage or "branch" in stage or "history" in stage for stage in found["stages"])


def test_a_planted_import_is_seen():
    planted = SCENES.replace("answer = ", "import mdr.detachment\nanswer = ")
    command = [sys.executable, "-c", planted, "mdr", "elastic", "{}"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert "mdr.detachment" in effects_among(json.loads(done.stdout))

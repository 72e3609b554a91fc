"""An effect that a scene does not list is not imported, not called, holds no state and changes no bit."""

from __future__ import annotations

import json
import subprocess
import sys
from functools import cache
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

COARSE_TABLE = '{"cells": 64, "ratios": 60, "radii": 100}'
COARSE_FEM = '{"order": 2, "edge_cell": 1e-2}'


@cache
def solved(method, scene, settings="{}"):
    """Import set and stage set of one solution in a process of its own, started once for all tests that ask."""
    command = [sys.executable, "-W", "error::RuntimeWarning", "-c", SCENES, method, scene, settings]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


IN_TIME = ("mdr.history", "mdr.impact", "fem_reference.memory", "fem_reference.motions")
ADHESION = ("mdr.adhesive", "mdr.detachment", "fem_reference.adhesion", "fem_reference.adhesion")
FRICTION = ("mdr.friction", "fem_reference.friction")
EFFECT_ROOMS = (*IN_TIME, *ADHESION, *FRICTION)


def effects_among(found):
    return [name for name in found["modules"] if name.startswith(EFFECT_ROOMS)]


@pytest.fixture
def elastic():
    return solved("mdr", "elastic")


def test_an_elastic_scene_imports_no_effect_and_no_other_method(elastic):
    assert effects_among(elastic) == []
    assert elastic["foreign"] == []
    assert [m for m in elastic["modules"] if m.startswith("fem_reference")] == []
    assert {"bem.grid.transforms", "bem.grid.discs", "bem.grid.operators"} & set(elastic["modules"]) == set()


def test_an_elastic_scene_runs_exactly_the_elastic_stages(elastic):
    assert elastic["stages"] == ["flat_punch_data", "force", "mdr_profile"]


def test_prescribed_depths_need_the_same_stages(elastic):
    depths = solved("mdr", "depths")
    assert depths["stages"] == elastic["stages"]
    assert effects_among(depths) == []


def test_adhesion_loads_no_time_integration():
    found = effects_among(solved("mdr", "adhesive"))
    assert found
    assert [m for m in found if m.startswith(IN_TIME)] == []


def test_impact_loads_no_adhesion():
    found = effects_among(solved("mdr", "impact"))
    assert found
    assert [m for m in found if m.startswith(ADHESION)] == []


def test_finite_elements_load_no_effect_for_an_elastic_scene():
    found = solved("fem", "elastic", COARSE_FEM)
    assert effects_among(found) == []
    assert [m for m in found["modules"] if m.startswith(("mdr", "bem"))] == []
    assert set(found["foreign"]) <= {"skfem", "gmsh"}


def test_finite_elements_load_only_the_listed_effect():
    """One process each: an impact loads no adhesion, adhesion loads nothing in time."""
    in_time = effects_among(solved("fem", "viscoelastic", COARSE_FEM))
    assert in_time
    assert [m for m in in_time if m.startswith(ADHESION)] == []
    adhering = effects_among(solved("fem", "sticky", COARSE_FEM))
    assert adhering
    assert [m for m in adhering if m.startswith(IN_TIME)] == []


@pytest.mark.first(1)
@pytest.mark.parametrize(("method", "settings"), [("fem", COARSE_FEM), ("mdr", "{}")])
def test_full_stick_loads_no_other_effect(method, settings):
    found = effects_among(solved(method, "adhered", settings))
    assert found
    assert [m for m in found if not m.startswith(FRICTION)] == []


@pytest.mark.first(1)
@pytest.mark.parametrize(("scene", "loads"), [("elastic", False), ("sticky", True)])
def test_boundary_elements_follow_a_branch_only_with_adhesion(scene, loads):
    found = solved("bem", scene, '{"points": 96}')
    assert [m for m in found["modules"] if m.startswith(("mdr", "fem_reference"))] == []
    assert any("adh" in stage or "branch" in stage or "history" in stage for stage in found["stages"]) is loads


def test_the_direct_integral_equation_loads_no_other_method():
    found = solved("integral_equation", "elastic")
    assert [m for m in found["modules"] if m.startswith(("mdr", "fem_reference")) or "transforms" in m] == []
    assert found["stages"] == ["error_estimate", "integral_equation", "one_circle"]


@pytest.mark.first(1)
@pytest.mark.parametrize(
    ("method", "settings", "stages"),
    [
        ("fem", COARSE_FEM, ["assemble", "factor", "mesh", "recover", "solve"]),
        ("bem", '{"points": 96}', ["contact", "field_errors", "fields"]),
        ("mdr_table", COARSE_TABLE, ["flat_punch_data", "force", "mdr_profile"]),
    ],
)
def test_an_elastic_scene_runs_exactly_its_stages(method, settings, stages):
    found = solved(method, "elastic", settings)
    assert found["stages"] == stages
    assert effects_among(found) == []


def test_a_planted_import_is_seen():
    planted = SCENES.replace("answer = ", "import mdr.detachment\nanswer = ")
    command = [sys.executable, "-c", planted, "mdr", "elastic", "{}"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    assert "mdr.detachment" in effects_among(json.loads(done.stdout))

"""A new kind of layer is one class behind the flat-punch interface; the springs ask nothing else."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import mdr
from bem.layer_equation.any_layer.graded_solution import GradedSolution
from bem.layer_equation.half_space import HalfSpaceFlatPunch
from bem.layer_equation.protocol import FlatPunchSolution
from bem.layer_equation.thin_layers import LargeRatioSolution
from contact import Layer, Paraboloid
from mdr import equivalent_system
from mdr.springs.assembly import contact_fields

INDENTER = Paraboloid(radius_of_curvature=5.0)
LAYER = Layer(thickness=1.0, youngs_modulus=3.0, poissons_ratio=0.3)
HALF_SPACE = Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.3)


@dataclass(frozen=True)
class TwiceAsStiff(FlatPunchSolution):
    """A body that answers like a half-space of twice the modulus; only what the interface demands."""

    max_ratio: float = 10.0
    nodes: int = 20

    def normalized_contact_stiffness(self, ratio):
        return np.full(np.shape(ratio), 2.0)

    def normalized_spring_stiffness(self, ratio):
        return np.full(np.shape(ratio), 2.0)

    def smooth_pressure(self, rho, ratio):
        return np.full(np.broadcast_shapes(np.shape(rho), np.shape(ratio)), 0.5)

    def relative_error(self, ratio):
        return np.zeros(np.shape(ratio))

    def spring_error(self, ratio):
        return np.zeros(np.shape(ratio))

    def profile_error(self, ratio, start=0.0):
        return np.zeros(np.shape(ratio))

    def panel_ends(self, ratio):
        return np.empty(0)

    def profile_of(self, indenter, unit, load, springs):
        return load, 0.0


class Source:
    def solution(self, layer, max_ratio):
        return TwiceAsStiff()


def test_a_new_flat_punch_solution_makes_springs_and_fields():
    system = equivalent_system(LAYER, INDENTER, 2.0, Source())
    plain = equivalent_system(HALF_SPACE, INDENTER, 2.0, Source())
    a = np.array([0.3, 1.0, 2.0])
    np.testing.assert_allclose(system.mdr_profile(a), plain.mdr_profile(a), rtol=1e-13)
    np.testing.assert_allclose(system.elastic_force(a), 2.0 * plain.elastic_force(a), rtol=1e-13)
    assert np.all(system.relative_errors(a)["normal_force"] < 1e-11)
    fields = contact_fields(LAYER, INDENTER, system.flat_punch, excess=1.0, depth=0.2, edge=False)
    assert fields.density is None
    assert fields.table is None


def test_springs_and_effects_ask_for_no_class_of_flat_punch_solutions():
    """Neither by isinstance nor by type(...) nor by match: what a solution can do it says by its interface."""
    kinds = _subclasses(FlatPunchSolution)
    assert {GradedSolution, HalfSpaceFlatPunch, LargeRatioSolution} < set(kinds)
    names = {cls.__name__ for cls in kinds}
    for path in Path(mdr.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if _tells_types_apart(node):
                named = {n.id for n in ast.walk(node) if isinstance(n, ast.Name)}
                assert not named & names, f"{path}: {ast.unparse(node)}"


def _subclasses(cls):
    return [cls, *(one for sub in cls.__subclasses__() for one in _subclasses(sub))]


def _tells_types_apart(node):
    asked = isinstance(node, ast.Call) and getattr(node.func, "id", "") in {"isinstance", "issubclass"}
    return asked or isinstance(node, ast.Compare | ast.match_case)

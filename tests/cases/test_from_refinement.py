"""A method that states no error gets one from its own refinement, and its answer says so."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from cases.run.from_refinement import ESTIMATED, with_estimated_errors
from contact import ContactPath, IndentationDepths, Layer, NotConvergedError, Paraboloid, Scene, StageLog

SCENE = Scene(
    layer=Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.3),
    indenter=Paraboloid(radius_of_curvature=1e-2),
    loading=IndentationDepths(values=np.array([1e-5, 2e-5])),
)


@dataclass(frozen=True)
class Grid:
    """Hertz with an error of a known order."""

    cell: float = 0.1
    order: float = 1.0
    fails: bool = False
    stated: float = 0.0

    def solve(self, scene):
        if self.fails and self.cell < 0.1:
            raise NotConvergedError("too fine")
        depth = scene.loading.values
        force = 4 / 3 * 1e6 / 0.91 * 0.1 * depth**1.5 * (1 + self.cell**self.order)
        return ContactPath(
            scene=scene,
            method="grid",
            settings={},
            contact_radius=np.sqrt(1e-2 * depth),
            indentation_depth=depth,
            normal_force=force,
            contact_stiffness=force / depth,
            error_estimate={"normal_force": np.full(2, self.stated)} if self.stated else {},
            cost=StageLog().cost(unknowns=1),
        )

    def refined(self):
        return replace(self, cell=self.cell / 2)


@pytest.mark.parametrize("order", [0.5, 1.0, 1.5, 2.0, 3.0])
def test_the_error_covers_and_is_sharp(order):
    method = Grid(order=order)
    answer = with_estimated_errors(method, SCENE, method.solve(SCENE))
    true = 0.1**order / (1 + 0.1**order)
    assert true * (1 - 1e-12) <= answer.error_estimate["normal_force"][1] <= 3 * true
    assert answer.notes[-1].startswith(ESTIMATED)
    assert answer.error_estimate["indentation_depth"] == pytest.approx([0.0, 0.0], rel=0.0, abs=0.0)


def test_what_does_not_change_states_roundings():
    answer = with_estimated_errors(Grid(), SCENE, Grid().solve(SCENE))
    assert answer.error_estimate["contact_radius"][0] == pytest.approx(7.1e-15, rel=0.01, abs=0.0)


def test_a_method_that_states_errors_keeps_them():
    method = Grid(stated=0.5)
    answer = method.solve(SCENE)
    assert with_estimated_errors(method, SCENE, answer) is answer


def test_an_answer_stands_when_its_refinement_fails():
    method = Grid(fails=True)
    answer = with_estimated_errors(method, SCENE, method.solve(SCENE))
    assert answer.error_estimate == {}
    assert "its own refinement failed: too fine" in answer.notes[-1]


class Quotient(Grid):
    """States the error of its stiffness by difference quotients alone."""

    def solve(self, scene):
        return replace(super().solve(scene), error_estimate={"contact_stiffness": np.full(2, 1e-3)})


def test_the_error_of_a_difference_quotient_is_added_to_that_of_the_refinement():
    answer, silent = (with_estimated_errors(method, SCENE, method.solve(SCENE)) for method in (Quotient(), Grid()))
    assert answer.error_estimate["normal_force"] == pytest.approx(
        silent.error_estimate["normal_force"], rel=1e-12, abs=0
    )
    more = answer.error_estimate["contact_stiffness"] - silent.error_estimate["contact_stiffness"]
    assert more == pytest.approx([1e-3, 1e-3], rel=1e-12, abs=0.0)

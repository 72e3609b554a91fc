"""A requested accuracy: the first method in a fixed order whose answer states it, refined until it does."""

import dataclasses

import numpy as np
import pytest

from cases import accuracy as module
from cases import solve
from contact import (
    Adhesion,
    ContactRadii,
    Detachment,
    Friction,
    Impact,
    InvalidInput,
    Layer,
    NotConvergedError,
    Paraboloid,
    Scene,
    UnsupportedSceneError,
)
from mdr import Mdr

LAYER = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3)
SCENE = Scene(layer=LAYER, indenter=Paraboloid(radius_of_curvature=5.0), loading=ContactRadii([0.5]))
SCENES = (
    SCENE,
    SCENE.replace(loading=Detachment(control="force"), effects=(Adhesion(work_of_adhesion=0.01),)),
    SCENE.replace(loading=Impact(mass=1.0, velocity=0.01)),
)


@pytest.mark.parametrize("scene", SCENES, ids=["radii", "detachment", "impact"])
@pytest.mark.parametrize("accuracy", [0.3, 1e-2, 1e-6])
def test_what_is_asked_for_is_stated(scene, accuracy):
    found = solve(scene, accuracy=accuracy)
    stated = max(float(np.max(found.answer.error_estimate[name])) for name in found.answer.ACCURACY_OF)
    assert found.stated_error == stated <= accuracy


def test_more_than_any_method_states_is_refused_with_the_best(monkeypatch):
    monkeypatch.setattr(module, "ORDER", ("mdr", "integral_equation"))
    with pytest.raises(NotConvergedError, match="at best; ask for less"):
        solve(SCENE, accuracy=1e-18)


@dataclasses.dataclass(frozen=True)
class Coarse:
    """States a hundredth, and a hundred times less with every refinement."""

    name = "mdr"
    stated: float = 1e-2

    def supports(self, scene):
        return Mdr().supports(scene)

    def solve(self, scene):
        path = Mdr().solve(scene)
        errors = {name: np.full(1, self.stated) for name in path.ACCURACY_OF}
        return dataclasses.replace(path, error_estimate=errors)

    def refined(self):
        return Coarse(self.stated / 100)


@pytest.mark.parametrize(("accuracy", "stated", "method"), [(1e-2, 1e-2, "mdr"), (1e-5, 1e-6, "mdr")])
def test_a_method_that_states_too_much_is_refined_before_the_next_one(monkeypatch, accuracy, stated, method):
    monkeypatch.setattr(module, "build", lambda name, settings: Coarse())
    found = solve(SCENE, accuracy=accuracy)
    assert (found.method, found.stated_error) == (method, pytest.approx(stated, rel=1e-12, abs=0.0))


def test_after_the_last_refinement_the_next_method_is_asked(monkeypatch):
    monkeypatch.setattr(module, "build", lambda name, settings: Coarse() if name == "mdr" else build(name, settings))
    assert solve(SCENE, accuracy=1e-9).method == "integral_equation"


def test_a_scene_that_no_method_models_names_their_reasons(monkeypatch):
    monkeypatch.setattr(module, "ORDER", ("mdr",))
    with pytest.raises(UnsupportedSceneError, match="no method answers this scene: mdr: "):
        solve(SCENE.replace(effects=(Friction(coefficient=0.3),)), accuracy=1e-3)


@pytest.mark.parametrize("accuracy", [0.0, 1.0, -1e-3, float("nan")])
def test_an_accuracy_that_is_none_is_refused(accuracy):
    with pytest.raises(InvalidInput, match="between 0 and 1"):
        solve(SCENE, accuracy=accuracy)


build = module.build

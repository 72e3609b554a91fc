"""Scenes that prescribe radii are put by depth to a method that takes no radii."""

import numpy as np
import pytest

from cases.claims import Agree
from cases.declare import methods
from cases.foreign import SUFFIX, against, beside, with_foreign_methods
from cases.run.executors import serial
from cases.run.runner import RunOptions, run_cases
from cases.verdicts import Status
from contact import ContactPath, IndentationDepths, StageLog, Supported, Unsupported
from tests.cases.fake_case import RADII, fake_case

FORCE_IS_WRONG_BY = 1e-3


class ByDepth:
    """Hertz at a depth, with a force that is too large by a little."""

    name = "by_depth"
    shared_inputs = ()

    def supports(self, scene):
        return Supported() if isinstance(scene.loading, IndentationDepths) else Unsupported("depths only")

    def solve(self, scene):
        depth, modulus = scene.loading.values, scene.layer.contact_modulus
        radius = np.sqrt(depth * scene.indenter.radius_of_curvature)
        return ContactPath(
            scene=scene,
            method=self.name,
            settings={},
            contact_radius=radius,
            indentation_depth=depth,
            normal_force=4 / 3 * modulus * radius * depth * (1 + FORCE_IS_WRONG_BY),
            contact_stiffness=2 * modulus * radius,
            error_estimate={},
            cost=StageLog().cost(unknowns=1),
        )

    def refined(self):
        return self


class ByRadius(ByDepth):
    """Takes whatever is prescribed."""

    def supports(self, scene):
        return Supported()


@pytest.fixture(autouse=True)
def _by_depth(install):
    install({"by_depth": f"{__name__}:ByDepth"})


def test_twins_prescribe_the_depths_of_the_radii():
    wider = with_foreign_methods(fake_case(), {"by_depth": 0.0})
    twins = [scene for scene in wider.scenes if scene.name.endswith(SUFFIX)]
    assert len(twins) == len(fake_case().scenes)
    for scene in twins:
        assert scene.scene.loading.values == pytest.approx(np.square(RADII) / 0.01, rel=1e-9, abs=0.0)
        assert "MDR" in scene.parameters["restated"]
    asked = [claim for claim in wider.claims if set(claim.scenes) & {scene.name for scene in twins}]
    assert asked
    assert all(isinstance(claim, Agree) and "by_depth" in (claim.fast, claim.reference) for claim in asked)
    assert {claim.quantity for claim in asked} == {"normal_force"}


def test_a_method_that_takes_radii_gets_no_twins(install):
    install({"by_depth": f"{__name__}:ByRadius"})
    wider = with_foreign_methods(fake_case(), {"by_depth": 0.0})
    assert [scene.name for scene in wider.scenes] == [scene.name for scene in fake_case().scenes]


def test_against_another_method_twins_are_compared():
    (case,) = against([fake_case()], ["by_depth"], ["mdr"])
    assert any(scene.name.endswith(SUFFIX) for scene in case.scenes)


def test_a_wrong_force_fails_by_its_own_estimated_error(tmp_path):
    """The method states no error and does not change when refined: a thousandth too much is an error, not a doubt."""
    mdr = methods.MethodUse(label="fast", method="mdr")
    wider = with_foreign_methods(fake_case(fast=mdr), {"by_depth": 0.0})
    case = beside(wider, ["by_depth"], "fast")
    result = run_cases([case], RunOptions(out=tmp_path / "out", executor=serial, jobs=1, timing=False, time_limit=0.0))
    judged = [c for c in result.judged.verdicts if c.scene.endswith(SUFFIX) and "by_depth" in c.methods]
    assert judged
    assert {claim.status for claim in judged} == {Status.FAIL}
    assert judged[0].error == pytest.approx(FORCE_IS_WRONG_BY, rel=1e-3, abs=0.0)
    run = next(answer for answer in result.answers if answer.method == "by_depth" and answer.solved)
    assert any(note.startswith("errors estimated from its own refinement") for note in run.notes)

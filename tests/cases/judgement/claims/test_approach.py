"""A stiffness that approaches 2 E* a with the chosen order of its cell, as if the cell were h/a."""

import dataclasses

import pytest

from cases.declare.case import CaseScene
from cases.declare.task import Answers
from cases.judgement.claims.approach import Approach
from cases.judgement.claims.declared import Reason
from cases.results.records.claim import Origin
from cases.results.records.scene_run import Quantity, SceneRun
from cases.results.status import Status
from tests.cases.fake_case import case_scene, fake_case, use
from tests.cases.fake_method import FakeHertz

REASON = Reason(because="fabricated", derived_from="fabricated", origin=Origin.CLOSED_FORM, source="fabricated")


def parameter(scene):
    return 0.5 - scene.layer.poissons_ratio + 0.1


def claim(**changes):
    stated = {"name": "limit", "quantity": "normal_force", "methods": ("fast",), "tolerance": 0.2, "reason": REASON}
    limit = {"parameter": parameter, "limit": lambda scene: 1.0, "formal_order": 1.0, "largest": 0.5}
    return Approach(**{**stated, **limit, **changes})


def judged(values, stated=(), **changes):
    """Judge two scenes, nu = 0.3 (parameter 0.3) and 0.5 (parameter 0.1), with these values over the limit."""
    checked = claim(**changes)
    case = dataclasses.replace(fake_case(), claims=(checked,), figures=(), scenes=(case_scene(0.3), case_scene(0.5)))
    runs = {}
    for scene, value in zip(case.scenes, values, strict=True):
        task = case.task(scene, use("fast"))
        runs[task.identity] = run_with(scene, value, stated)
    (record,) = checked.judge(case, Answers(runs))
    return record


def run_with(scene: CaseScene, value: float, stated: tuple[float, ...] = ()) -> SceneRun:
    force = Quantity(name="normal_force", unit="N", scale=1.0, values=(value,), uncertainty=stated)
    return SceneRun(
        key="k",
        scene=scene.name,
        method="fast",
        settings={},
        status=Status.PASS,
        reason="",
        quantities=(force,),
        cost=None,
    )


@pytest.mark.parametrize("order", [1.0, 2.0])
def test_the_right_rate_passes(order):
    record = judged((1 + 0.3**order, 1 + 0.1**order), formal_order=order)
    assert record.status is Status.PASS
    assert record.observed == pytest.approx(order, rel=1e-12, abs=0.0)


def test_a_wrong_rate_fails():
    assert judged((1 + 0.3**2, 1 + 0.1**2)).status is Status.FAIL
    assert judged((1.3, 1.25)).status is Status.FAIL


def test_a_wrong_limit_fails():
    """A factor 2 is far from the limit, whatever the rate."""
    record = judged((2.6, 2.2))
    assert record.status is Status.FAIL
    assert "from the limit" in record.message


WRONG_RATE, WRONG_LIMIT = (1 + 0.3**2, 1 + 0.1**2), (2.6, 2.2)


@pytest.mark.parametrize(("values", "error"), [(WRONG_RATE, 0.05), (WRONG_LIMIT, 0.8 * 2.2)])
def test_what_is_within_its_own_error_does_not_fail(values, error):
    """Of a rate only the part beyond the errors of both distances is known."""
    record = judged(values, stated=(error,))
    assert record.status is Status.INCONCLUSIVE
    assert ": refine" in record.message
    assert judged(values, stated=(error / 1e3,)).status is Status.FAIL


def test_a_right_rate_passes_whatever_is_stated():
    assert judged((1.3, 1.1), stated=(0.05,)).status is Status.PASS


def case_of(checked):
    return dataclasses.replace(fake_case(), claims=(checked,), figures=(), scenes=(case_scene(0.3), case_scene(0.5)))


def test_a_limit_reached_to_the_last_bit_has_no_rate():
    assert judged((1.1, 1.0)).status is Status.INCONCLUSIVE


def test_the_fabricated_method_follows_the_protocol():
    assert FakeHertz().refined().cell == 0.0

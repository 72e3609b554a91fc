"""Claims on fabricated answers: limits, bounds, and laws of an answer by itself."""

import dataclasses

import numpy as np
import pytest

from cases.answers import Answer, Table, Values
from cases.claims import Approach, Zero
from cases.library._common import chebyshev_radii, incremental_stiffness
from cases.library.friction_flat_punch import STIFFER
from cases.verdicts import Status
from tests.cases.fake_case import WHY, case_scene, fake_case


def answer(scene, *values, name="normal_force", method="fast", error=(), **more):
    q = Values(unit="1", scale=2.0, values=values, error=error)
    return Answer(case="fake_hertz", scene=scene, method=method, quantities={name: q}, **more)


def parameter(scene):
    return 0.5 - scene.layer.poissons_ratio + 0.1


def limit(values, stated=(), **changes):
    """Judge two scenes, nu = 0.3 (parameter 0.3) and 0.5 (parameter 0.1), with these values over the limit."""
    words = {"name": "limit", "quantity": "normal_force", "methods": ("fast",), "tolerance": 0.2, "why": WHY}
    rate = {"parameter": parameter, "limit": lambda scene: 1.0, "formal_order": 1.0, "largest": 0.5}
    claim = Approach(**{**words, **rate, **changes})
    case = dataclasses.replace(fake_case(), claims=(claim,), scenes=(case_scene(0.3), case_scene(0.5)))
    answers = Table(answer(s.name, value, error=stated) for s, value in zip(case.scenes, values, strict=True))
    (verdict,) = claim.judge(case, answers)
    return verdict


WRONG_RATE, WRONG_LIMIT = (1 + 0.3**2, 1 + 0.1**2), (2.6, 2.2)


@pytest.mark.parametrize("order", [1.0, 2.0])
def test_the_right_rate_passes(order):
    verdict = limit((1 + 0.3**order, 1 + 0.1**order), formal_order=order)
    assert verdict.status is Status.PASS
    assert verdict.error == pytest.approx(order, rel=1e-12, abs=0.0)


def test_a_wrong_rate_and_a_wrong_limit_fail():
    assert limit(WRONG_RATE).status is Status.FAIL
    assert limit((1.3, 1.25)).status is Status.FAIL
    assert limit(WRONG_LIMIT).status is Status.FAIL
    assert "from the limit" in limit(WRONG_LIMIT).message


@pytest.mark.parametrize(("values", "error"), [(WRONG_RATE, 0.05), (WRONG_LIMIT, 0.8 * 2.2)])
def test_what_is_within_its_own_error_does_not_fail(values, error):
    """Of a rate only the part beyond the errors of both distances is known."""
    verdict = limit(values, stated=(error,))
    assert verdict.status is Status.INCONCLUSIVE
    assert ": refine" in verdict.message
    assert limit(values, stated=(error / 1e3,)).status is Status.FAIL


def test_a_right_rate_passes_whatever_is_stated():
    assert limit((1.3, 1.1), stated=(0.05,)).status is Status.PASS


def test_a_limit_reached_to_the_last_bit_has_no_rate():
    assert limit((1.1, 1.0)).status is Status.INCONCLUSIVE


def bound(values, bounds, **changes):
    claim = dataclasses.replace(STIFFER[0], tolerance=1e-9, **({"multiple": None} | changes))
    name = claim.quantity
    answers = [answer("s", *numbers, name=name) for numbers in (values, bounds)]
    return claim.judged(fake_case(), case_scene(0.3), answers)


@pytest.mark.parametrize(
    ("values", "status"),
    [((1.0, 5.0), Status.PASS), ((1.0, 2.0), Status.PASS), ((1.0, 2.0 - 4e-9), Status.FAIL), ((0.9, 5.0), Status.FAIL)],
)
def test_the_worst_step_decides_whether_a_bound_holds(values, status):
    assert bound(values, (1.0, 2.0)).status is status


@pytest.mark.parametrize(("multiple", "status"), [(1.1, Status.PASS), (1.05, Status.FAIL)])
def test_a_multiple_bounds_from_above(multiple, status):
    judged = bound((1.0, 2.2 - 1e-9), (1.0, 2.0), at_most=True, multiple=lambda _: multiple)
    assert judged.status is status


@pytest.mark.parametrize(("stiffness_error", "status"), [(0.0, Status.PASS), (3e-9, Status.FAIL)])
def test_one_more_step_presses_like_a_flat_punch(stiffness_error, status):
    """Sneddon's cone at E* = 1, slope 1: delta = pi a / 2, F = pi a^2 / 2, k_N = 2 a."""
    a = chebyshev_radii(0.75, 1.0, 16)
    values = {
        "contact_radius": a,
        "indentation_depth": np.pi * a / 2,
        "normal_force": np.pi * a**2 / 2,
        "contact_stiffness": 2 * a * (1 + stiffness_error * a),
    }
    cone = answer("s", 0.0)
    quantities = {name: Values(unit="1", scale=1.0, values=tuple(v.tolist())) for name, v in values.items()}
    claim = Zero(name="slope", quantity="contact_stiffness", tolerance=1e-9, why=WHY, derive=incremental_stiffness)
    judged = claim.judged(fake_case(), case_scene(0.3), [dataclasses.replace(cone, quantities=quantities)])
    assert judged.status is status


def test_an_answer_that_does_not_publish_its_residual_is_incomparable():
    claim = Zero(name="energy", quantity="energy_defect", tolerance=1e-9, why=WHY)
    case = dataclasses.replace(fake_case(), claims=(claim,))
    verdicts = list(claim.judge(case, Table(answer(scene.name, 1.0) for scene in case.scenes)))
    assert [verdict.status for verdict in verdicts] == [Status.INCOMPARABLE] * 2

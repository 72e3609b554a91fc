"""Ladders count digits honestly, name what breaks, and see what is planted."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from cases import stress
from cases.library.stability import CASE, LADDERS, contact_ratio, damped_punch, truncated
from cases.stress import Ladder, breakdown, invariant_residuals, no_silent_failure, repeated
from cases.verdicts import Status
from contact import InvalidInput, NotConvergedError, Supported
from mdr import Mdr
from tests.cases.climbing import climb

PLAN = Ladder(name="test", parameter="b/a", values=(0.5, 0.1, 0.01), scene=truncated)


@dataclasses.dataclass(frozen=True)
class Faulty:
    """The fast method with a fault from some scene on."""

    fault: object
    name = "faulty"

    def supports(self, scene):
        return Supported()

    def solve(self, scene):
        path = Mdr().solve(scene)
        return self.fault(path) if scene.indenter.flat_radius < 0.3 * path.contact_radius[-1] else path

    def refined(self):
        return self


def noisy(path):
    salt = float(path.contact_radius[-1]).hex()
    noise = 1e-6 * np.random.default_rng(int.from_bytes(salt.encode()) % 2**32).normal()
    return dataclasses.replace(path, normal_force=path.normal_force * (1 + noise))


def wrong(path):
    return dataclasses.replace(path, normal_force=path.normal_force * 1.01)


def broken(path):
    raise NotConvergedError("planted", {"residual": 1e-3})


def crashing(path):
    raise ZeroDivisionError("planted")


def test_the_fast_method_climbs_with_nearly_all_digits():
    ladder = climb(PLAN, Mdr())
    assert breakdown(ladder) is None
    assert (
        min(step.digits for step in ladder.steps) > 13.5
    )  # roundings of a dozen operations on well-conditioned numbers
    assert set(ladder.steps[0].residuals) >= {"twice the modulus", "fast method"}


def test_digits_that_repeats_do_not_share_are_not_counted():
    digits = [rung.digits for rung in climb(PLAN, Faulty(noisy)).steps]
    assert digits[0] > 13
    assert digits[1] < 7.5


def test_a_wrong_number_is_a_failure_even_if_all_repeats_agree():
    ladder = climb(PLAN, Faulty(wrong))
    assert [rung.status for rung in ladder.steps] == [Status.PASS, Status.FAIL, Status.FAIL]
    assert breakdown(ladder).value == 0.1


def test_a_wrong_number_in_motion_is_found_beside_the_fast_method():
    """No second opinion knows impacts or detachments."""

    class Heavier(Faulty):
        def solve(self, scene):
            path = Mdr().solve(scene)
            return dataclasses.replace(path, peak_force=path.peak_force * (1 + 1e-5))

    plan = Ladder(name="test", parameter="D", values=(0.5,), scene=damped_punch, quantity="peak_force")
    (rung,) = climb(plan, Heavier(None)).steps
    assert rung.status is Status.FAIL
    assert rung.residuals["fast method"] == pytest.approx(1e-5, rel=1e-2, abs=0.0)
    assert climb(plan, Mdr()).steps[0].status is Status.PASS


def test_a_named_refusal_and_a_crash_are_told_apart():
    refusal, crash = climb(PLAN, Faulty(broken)).steps[1], climb(PLAN, Faulty(crashing)).steps[1]
    assert (refusal.status, refusal.digits) == (Status.INVALID, None)
    assert refusal.reason == "NotConvergedError: planted (residual = 1.000e-03)"
    assert (crash.status, crash.reason) == (Status.FAIL, "crash: ZeroDivisionError: planted")


def test_a_method_takes_only_the_tests_whose_first_scene_it_supports_and_that_it_is_asked_to():
    class Elastic(Faulty):
        def supports(self, scene):
            return Supported() if not scene.effects else False

    plan, fem = dataclasses.replace(PLAN, values=(0.5,)), dataclasses.replace(PLAN, methods=("fem",))
    impact = dataclasses.replace(plan, parameter="D", scene=damped_punch)
    assert [climb(p, Elastic(lambda path: path)) is None for p in (plan, impact, fem)] == [False, True, True]


def test_the_suite_ci_makes_quick_tests_by_the_fast_method_and_nightly_all_by_all():
    quick, every = (CASE.in_suite(suite) for suite in ("ci", "nightly"))
    assert {test.name: test.methods for test in quick.claims} == dict.fromkeys(
        ("vanishing flat end", "damping ratio"), ("mdr",)
    )
    assert every.claims == LADDERS
    assert {task.use.label for task in every.tasks()} == {"mdr", "mdr_table", "integral_equation", "bem", "fem"}


def test_the_edge_cell_of_finite_elements_is_their_setting():
    (test,) = (test for test in LADDERS if test.name == "edge cell")
    cells = [task.use.settings["edge_cell"] for task in test.tasks(CASE)]
    assert cells == list(test.values)


def test_a_silent_failure_fails_its_claim():
    claim = no_silent_failure(climb(PLAN, Faulty(wrong)))
    assert (claim.status, claim.error) == (Status.FAIL, 2.0)
    assert "more than both state" in claim.message


def test_a_modulus_in_the_wrong_place_breaks_a_law():
    class Offset(Faulty):
        def solve(self, scene):
            path = Mdr().solve(scene)
            return dataclasses.replace(path, normal_force=path.normal_force + 1e-3)

    scene = contact_ratio(1.0, nu=0.3, support="unbonded")
    assert invariant_residuals(Offset(None), Offset(None).solve(scene))["twice the modulus"] > 1e-4


def test_a_repeat_on_a_scene_out_of_reach_refuses_by_name():
    with pytest.raises(InvalidInput):
        list(repeated(Mdr(), contact_ratio(1e6, nu=0.3, support="bonded"), "normal_force"))


@pytest.mark.slow
@pytest.mark.parametrize("plan", [plan for plan in LADDERS if "mdr" in plan.methods], ids=lambda plan: plan.name)
def test_no_rung_of_the_fast_method_fails_without_a_name(plan):
    climbed = climb(plan, Mdr())
    assert [rung for rung in climbed.steps if rung.status is Status.FAIL] == []


def test_a_warning_on_a_rung_is_a_crash(monkeypatch):
    monkeypatch.setattr(stress, "invariant_residuals", lambda method, answer: {"x": float(np.log(np.zeros(1))[0])})
    assert "crash: RuntimeWarning" in climb(PLAN, Mdr()).steps[0].reason

import pytest

from cases.baselines.spread import measured_spreads, perturbed
from cases.solve import solve
from tests.cases.fake_case import FAST, fake_case, spoiled


def task_of(case):
    return next(iter(case.tasks()))


def test_each_perturbed_scene_differs_in_one_last_bit():
    scene = task_of(fake_case()).problem
    twins = list(perturbed(scene))
    assert len(twins) == 2  # a half-space has no thickness
    for twin in twins:
        assert twin != scene
        assert twin.layer.youngs_modulus == pytest.approx(scene.layer.youngs_modulus, rel=1e-15)


def test_the_spread_of_a_closed_form_is_round_off():
    task = task_of(fake_case())
    spreads = measured_spreads(task, solve(task, ""))
    assert 0 <= spreads["normal_force"] < 1e-15
    assert spreads["contact_radius"] == 0.0


def test_the_spread_of_an_unstable_method_is_seen():
    """A method that feeds the last bits of its input into its answer at 1e-6."""
    task = task_of(fake_case(fast=spoiled(FAST, plant="last bits")))
    spreads = measured_spreads(task, solve(task, ""))
    assert spreads["normal_force"] > 1e-7

"""The spread between solutions that should be equal."""

import numpy as np
import pytest

from cases.answers import Table
from cases.declare import methods
from cases.gate import spread
from cases.gate.spread import measured_spreads, nudged_scene
from cases.run.solve_task import job_of, solve
from contact import (
    ContactRadii,
    DepthHistory,
    ForceHistory,
    InvalidInput,
    Layer,
    Paraboloid,
    Scene,
    Tabulated,
)
from tests.cases.fake_case import FAST, SLOW, fake_case, spoiled


@pytest.fixture
def in_this_process(monkeypatch):
    """The fabricated method is registered in this process only."""
    monkeypatch.setattr(spread, "process_pool", methods_executor)


def methods_executor(jobs):
    from cases.run.executors import serial

    assert "fake" in methods.BUILT_IN
    return serial(jobs)


def spreads_of(case):
    tasks = [case.task(scene, use) for scene in case.scenes for use in case.methods]
    return measured_spreads(case, Table(solve(job_of(task)) for task in tasks))


def test_a_loading_that_would_leave_the_scene_stays():
    table = Tabulated(radii=[0.0, 0.5e-3, 1e-3], heights=[0.0, 1e-6, 4e-6])
    layer = Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.3)
    scene = Scene(layer=layer, indenter=table, loading=ContactRadii([1e-3]))
    assert nudged_scene(scene, np.inf).loading == scene.loading
    assert nudged_scene(scene, np.inf).layer != scene.layer
    assert nudged_scene(scene, 0.0).loading != scene.loading


@pytest.mark.parametrize(("kind", "name"), [(DepthHistory, "depth"), (ForceHistory, "force")])
def test_a_history_is_nudged_where_it_is_not_zero(kind, name):
    scene = Scene(
        layer=Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.5),
        indenter=Paraboloid(radius_of_curvature=1e-2),
        loading=kind(time=np.array([0.0, 1.0, 2.0]), **{name: np.array([0.0, 1e-5, 1e-5])}),
    )
    nudged = getattr(nudged_scene(scene, np.inf).loading, name)
    assert nudged.tolist() == [0.0, *[np.nextafter(1e-5, np.inf)] * 2]


@pytest.mark.usefixtures("in_this_process")
def test_the_spread_of_an_unstable_method_is_seen_and_that_of_a_closed_form_is_round_off():
    """The first feeds the last bits of its input into its answer at 1e-6."""
    found = spreads_of(fake_case(fast=spoiled(FAST, plant="last bits")))
    assert len(found) == 2 * 2 * 4
    assert max(found["fast", s, "normal_force"] for s in ("half-space nu=0.3", "half-space nu=0.5")) > 1e-7
    assert 0 < max(spread for (method, _, _), spread in found.items() if method == "slow") < 1e-15


@pytest.mark.usefixtures("in_this_process")
def test_a_repetition_that_breaks_down_is_refused():
    case = fake_case()
    answers = Table(solve(job_of(task)) for task in case.tasks() if not task.variant)
    with pytest.raises(InvalidInput, match="should change nothing, but INVALID"):
        measured_spreads(fake_case(slow=spoiled(SLOW, plant="raise")), answers)

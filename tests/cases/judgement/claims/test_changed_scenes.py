"""An inequality of two answers: what is above passes, what is below by more than the tolerance fails."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from cases.judgement.claims.changed_scenes import NeverBelow
from cases.library.friction.friction_flat_punch import STIFFER
from cases.results.records.scene_run import Quantity, SceneRun
from cases.results.status import Status

ANY = SimpleNamespace(scene=None)


def run(*values):
    stiffness = Quantity(name="contact_stiffness", unit="N/m", scale=2.0, values=values)
    return SceneRun(key="k", scene="s", method="m", settings={}, status=Status.PASS, reason="", cost=None,
                    quantities=(stiffness,))  # fmt: skip


@pytest.mark.parametrize(
    ("values", "status"),
    [((1.0, 5.0), Status.PASS), ((1.0, 2.0), Status.PASS), ((1.0, 2.0 - 4e-9), Status.FAIL), ((0.9, 5.0), Status.FAIL)],
)
def test_the_worst_step_decides(values, status):
    claim = replace(STIFFER[0], multiple=None)
    assert isinstance(claim, NeverBelow)
    assert claim.judged(ANY, run(*values), run(1.0, 2.0), 1e-9).status is status


@pytest.mark.parametrize(("multiple", "status"), [(1.1, Status.PASS), (1.05, Status.FAIL)])
def test_a_multiple_bounds_from_above(multiple, status):
    claim = replace(STIFFER[0], at_most=True, multiple=lambda _: multiple)
    assert claim.judged(ANY, run(1.0, 2.2 - 1e-9), run(1.0, 2.0), 1e-9).status is status

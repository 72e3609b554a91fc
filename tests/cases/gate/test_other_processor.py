"""Another processor rounds differently: a case answered from inputs one unit in the last place away passes the gate."""

import dataclasses
import math

import pytest

from cases.declare.registry import load_cases
from cases.declare.selection import in_suite
from cases.declare.task import Answers
from cases.gate.gate import gate
from cases.gate.proposal import propose
from cases.gate.spread import nudged_scene
from cases.judgement.judge import case_result
from cases.judgement.rules.tolerance import relative_spread
from cases.run.solve_task import solve
from tests.cases.gate.example_baselines import clean_run, regressions

CASES = [
    "measured_profile",
    *(pytest.param(name, marks=pytest.mark.slow) for name in sorted(load_cases()) if name != "measured_profile"),
]


def answered(case, nudged=lambda scene: scene):
    """The judged case with its scenes nudged."""
    tasks = [case.task(scene, use) for scene in case.scenes for use in case.methods_of(scene)]
    rows = {t.identity: solve(dataclasses.replace(t, problem=nudged(t.problem)), "") for t in tasks}
    return case_result(case, Answers(rows), complete=False)


def spreads(*answers):
    """Half the range of some answers over their size, by method, scene and quantity."""
    return {
        (first.method, first.scene, q.name): max(
            relative_spread(step, q.scale) for step in zip(*(row.quantity(q.name).values for row in rows), strict=True)
        )
        for rows in zip(*(answer.runs for answer in answers), strict=True)
        for first in rows[:1]
        for q in first.quantities
    }


@pytest.mark.parametrize("name", CASES)
def test_a_case_answered_from_inputs_one_rounding_away_passes_the_gate(name):
    case = in_suite(load_cases()[name], "ci")
    plain, up, down = answered(case), *(answered(case, lambda s, t=t: nudged_scene(s, t)) for t in (math.inf, 0.0))
    accepted = propose(plain, suites=("ci",), accepted=(), spreads=spreads(plain, up, down), reason="x")
    other = answered(case, lambda scene: scene.replace(layer=nudged_scene(scene, math.inf).layer))
    judged = gate(clean_run(other), accepted.baselines)
    found = regressions(judged)
    assert len(found) > 10
    assert [(claim.scene, claim.methods, claim.message) for claim in found if claim.status.is_failure] == []

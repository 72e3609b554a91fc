"""Another processor rounds differently: a case answered from inputs one unit in the last place away passes the gate."""

import dataclasses
import math

import pytest

from cases.answers import Table
from cases.declare.registry import load_cases
from cases.gate.accept import propose
from cases.gate.gate import gate
from cases.gate.spread import nudged_scene
from cases.rules import relative_spread
from cases.run.runner import judge
from cases.run.solve_task import job_of, solve
from cases.runs import Run
from tests.cases.example_run import example_stamp
from tests.cases.gate.example_baselines import regressions

CASES = [
    "measured_profile",
    *(
        pytest.param(name, marks=pytest.mark.slow)
        for name, case in sorted(load_cases().items())
        if case.scenes and name != "measured_profile"
    ),
]


def answered(case, nudged=lambda scene: scene):
    """The judged case with its scenes nudged; a number with nine digits is the same question."""
    tasks = [case.task(scene, use) for scene in case.scenes for use in case.methods_of(scene)]
    answers = Table(solve(job_of(dataclasses.replace(t, problem=nudged(t.problem)))) for t in tasks)
    return Run(judged=dataclasses.replace(judge([case], answers, example_stamp()), suite="ci"), answers=answers)


def spreads(*runs):
    """Half the range of some answers over their size, by method, scene and quantity."""
    return {
        (first.method, first.scene, name): max(
            relative_spread(step, q.scale)
            for step in zip(*(answer.quantities[name].values for answer in answers), strict=True)
        )
        for answers in zip(*(run.answers for run in runs), strict=True)
        for first in answers[:1]
        for name, q in first.quantities.items()
    }


@pytest.mark.parametrize("name", CASES)
def test_a_case_answered_from_inputs_one_rounding_away_passes_the_gate(name):
    case = load_cases()[name].in_suite("ci")
    plain, up, down = answered(case), *(answered(case, lambda s, t=t: nudged_scene(s, t)) for t in (math.inf, 0.0))
    accepted = propose(plain, name, suites=("ci",), before=None, spreads=spreads(plain, up, down), reason="x")
    other = answered(case, lambda scene: scene.replace(layer=nudged_scene(scene, math.inf).layer))
    found = regressions(gate(other, [accepted.baseline]))
    assert len(found) > 10
    assert [(v.scene, v.methods, v.message) for v in found if v.status.is_failure] == []

"""Hard parameters walked by finite elements, some steps; `run --only stability --method fem` walks all."""

from __future__ import annotations

import dataclasses

import pytest

from cases.library.stability import CASE, LADDERS
from cases.stress import breakdown
from tests.cases.climbing import climb

RUNGS = {
    "nearly incompressible": (1e-1, 1e-12, 1e-17),
    "contact radius, bonded, nu = 0.5": (1e-3, 1.0, 100.0),
    "contact radius, unbonded": (1e-3, 100.0),
    "vanishing flat end": (1e-8,),
    "nearly a flat punch": (1e-1, 1e-5, 1e-8),
    "damping ratio": (1.0, 1e3),
    "relaxation time": (1e-6, 1e6),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", RUNGS)
def test_rungs_are_climbed_within_their_stated_errors(name):
    plan = next(plan for plan in LADDERS if plan.name == name)
    (fem,) = (use for use in CASE.methods if use.label == "fem")
    ladder = climb(dataclasses.replace(plan, values=RUNGS[name]), fem.build())
    assert breakdown(ladder) is None, ladder.steps
    assert (
        min(step.digits for step in ladder.steps) > 4.0
    )  # one ulp may turn one triangle: 5.3 at a/h = 1e-3, 12 and more elsewhere

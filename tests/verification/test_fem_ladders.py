"""Hard parameters walked by finite elements, some steps; `run --only stability --method fem` walks all."""

from __future__ import annotations

import dataclasses

import pytest

from cases.declare.methods import build
from cases.measurements.ladders.ladder_study import CLIMBERS
from cases.measurements.ladders.ladder_table import LADDERS
from cases.measurements.ladders.ladders import climb

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
    ladder = climb(dataclasses.replace(plan, values=RUNGS[name]), build("fem", CLIMBERS["fem"]))
    assert ladder.breakdown is None, ladder.rungs
    assert ladder.fewest_digits > 4.0  # one ulp may turn one triangle: 5.3 at a/h = 1e-3, 12 and more elsewhere

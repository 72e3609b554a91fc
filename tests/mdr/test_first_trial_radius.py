"""The first trial radius on stacks: one equivalent system is enough for every depth and force."""

from __future__ import annotations

import numpy as np
import pytest

from contact import Cone, ContactRadii, IndentationDepths, NormalForces, Paraboloid, Scene, TruncatedCone
from mdr import Mdr
from mdr.springs import reach
from tests.stacked_scenes import random_stack

RNG = np.random.default_rng(5)
STACKS = [(random_stack(RNG), float(np.exp(RNG.uniform(np.log(0.1), np.log(3.0))))) for _ in range(6)]


@pytest.mark.parametrize("kind", ["paraboloid", "cone", "truncated cone"])
@pytest.mark.parametrize(("layer", "radius"), STACKS)
def test_a_depth_or_force_on_a_stack_takes_one_system(monkeypatch, layer, radius, kind):
    indenter = {
        "paraboloid": Paraboloid(radius_of_curvature=10.0),
        "cone": Cone(slope=0.1),
        "truncated cone": TruncatedCone(flat_radius=radius / 2, slope=0.1),
    }[kind]
    known = Mdr().solve(Scene(layer=layer, indenter=indenter, loading=ContactRadii([radius])))
    made, make = [], reach.equivalent_system
    monkeypatch.setattr(reach, "equivalent_system", lambda *a, **k: made.append(a[2]) or make(*a, **k))
    for loading in (IndentationDepths(known.indentation_depth), NormalForces(known.normal_force)):
        found = Mdr().solve(Scene(layer=layer, indenter=indenter, loading=loading))
        np.testing.assert_allclose(found.contact_radius, radius, rtol=1e-10)
    assert len(made) == 2
    assert max(made) < 1.06 * radius

"""Finite elements on stacks and graded layers: pull-off beside MDR's, and stiff films whose contact may have a gap."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

from contact import (
    Adhesion,
    Detachment,
    ExponentialDepth,
    FlatPunch,
    GradedLayer,
    Paraboloid,
    Scene,
)
from fem_reference import Fem
from mdr import Mdr
from tests.verification.lift_off import FORCE_AGREEMENT, judge, random_scene
from tests.verification.test_stacks import stack

PARABOLOID = Paraboloid(radius_of_curvature=1.0)
QUICK = Fem(growth=0.7, edge_cell=1e-6)


STIFF_ON_SOFT = stack((0.5, 10.0, 0.3), (0.5, 1.0, 0.3))
SLIDING = stack((0.3, 1.0, 0.5), (0.7, 10.0, 0.4), interfaces=("unbonded",), support="unbonded")
EXPONENTIAL = GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=4.0), poissons_ratio=0.3)


@pytest.mark.slow
@pytest.mark.parametrize("layer", [STIFF_ON_SOFT, SLIDING, EXPONENTIAL])
@pytest.mark.parametrize("indenter", [PARABOLOID, FlatPunch(radius=0.4)])
def test_pull_off_agrees_with_mdr_within_stated_errors(layer, indenter):
    problem = Scene(
        layer=layer,
        indenter=indenter,
        loading=Detachment(control="force"),
        effects=(Adhesion(work_of_adhesion=0.01),),
    )
    ours, other = QUICK.solve(problem), Mdr().solve(problem)
    for name in ("pull_off_force", "pull_off_depth", "pull_off_contact_radius"):
        error = abs(getattr(ours, name) / getattr(other, name) - 1)
        assert error <= ours.error_estimate[name] + 1e-12, name
    assert abs(ours.pull_off_force / other.pull_off_force - 1) < 1e-4


@pytest.mark.slow
def test_mdr_answers_nowhere_where_the_contact_has_a_gap():
    rng = np.random.default_rng(180)
    verdicts = [judge(random_scene(rng)) for _ in range(40)]
    counts = Counter(verdict.kind for verdict in verdicts)
    assert counts["gap, answered"] == 0
    assert min(counts["gap, refused"], counts["disc, answered"]) >= 5
    assert max(verdict.difference for verdict in verdicts) < FORCE_AGREEMENT

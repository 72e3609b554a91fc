"""The law dF = k_N d(delta) on Sneddon's cone, and a spring stiffness that breaks it."""

import numpy as np
import pytest

from cases.judgement.claims.declared import Reason
from cases.judgement.claims.own_laws import IncrementalStiffness, chebyshev_radii
from cases.results.records.claim import Origin
from cases.results.records.scene_run import Quantity, SceneRun
from cases.results.status import Status

CLAIM = IncrementalStiffness(
    name="slope",
    quantity="contact_stiffness",
    tolerance=1e-9,
    reason=Reason(because="a law", derived_from="roundings", origin=Origin.CLOSED_FORM, source="Eq. (10)"),
)


def cone(stiffness_error):
    """Sneddon's cone at E* = 1, slope 1: delta = pi a / 2, F = pi a^2 / 2, k_N = 2 a."""
    a = chebyshev_radii(0.75, 1.0, 16)
    values = {
        "contact_radius": a,
        "indentation_depth": np.pi * a / 2,
        "normal_force": np.pi * a**2 / 2,
        "contact_stiffness": 2 * a * (1 + stiffness_error * a),
    }
    quantities = tuple(Quantity(name=n, unit="1", scale=1.0, values=tuple(v.tolist())) for n, v in values.items())
    return SceneRun(key="k", scene="s", method="m", settings={}, status=Status.PASS, reason="", cost=None,
                    quantities=quantities)  # fmt: skip


@pytest.mark.parametrize(("stiffness_error", "status"), [(0.0, Status.PASS), (3e-9, Status.FAIL)])
def test_the_law_on_the_half_space(stiffness_error, status):
    assert CLAIM.judged(None, cone(stiffness_error), 1e-9).status is status

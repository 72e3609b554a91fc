"""Impacts by finite elements: the whole force history against springs, and the trend with the bulk modulus."""

from __future__ import annotations

import numpy as np
import pytest

from bem.layer_equation.flat_punch_source import IntegralEquation
from benchmarks.fem_impacts import largest_difference, with_poissons_ratio
from fem_reference import Fem
from mdr.impact.solver import solve_impact
from tests.mdr.viscoelastic_scenes import figure_12

# Restitution from a separate Fredholm solution and explicit integration over springs, five digits.
RESTITUTION = {np.inf: 0.45457, 3e-3: 0.52344, 2e-3: 0.55924, 1e-3: 0.64341}


@pytest.mark.parametrize(
    "thickness", [np.inf, 2e-3, pytest.param(3e-3, marks=pytest.mark.slow), pytest.param(1e-3, marks=pytest.mark.slow)]
)
def test_force_history_of_figure_12_within_3e_4_of_the_peak(thickness):
    scene = figure_12(thickness)
    history, exact = Fem().solve(scene), solve_impact(scene, IntegralEquation(), {"accuracy": 1e-11})
    stated = history.error_estimate
    assert history.coefficient_of_restitution == pytest.approx(RESTITUTION[thickness], abs=1e-4)
    assert largest_difference("normal_force", history, exact) < 3e-4
    for name in ("normal_force", "indentation_depth", "velocity"):
        assert largest_difference(name, history, exact) <= stated[name][0], name
    for name in ("peak_force", "peak_depth", "peak_contact_radius", "contact_time", "coefficient_of_restitution"):
        assert abs(getattr(history, name) / getattr(exact, name) - 1) <= stated[name][0], name


@pytest.mark.slow
def test_finite_bulk_modulus_tends_to_the_incompressible_layer():
    scene = figure_12(1e-3)
    layers = (with_poissons_ratio(scene, nu) for nu in (0.3, 0.4, 0.49, 0.4999))
    gaps = [Fem().solve(on_layer).coefficient_of_restitution - 0.64341 for on_layer in layers]
    assert np.all(np.diff(gaps) < 0)
    assert gaps[-1] < 0.02 * gaps[-2]  # the gap closes in proportion to 1 - 2 nu, here by a hundred
    assert gaps[-1] == pytest.approx(0, abs=2e-4)

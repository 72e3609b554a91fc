"""Impacts by finite elements: the whole force history against springs, and the trend with the bulk modulus."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from bem.flat_punch import IntegralEquation
from contact import ImpactHistory
from fem_reference import Fem
from mdr.impact.solver import solve_impact
from tests.mdr.viscoelastic_scenes import figure_12

# Restitution from a separate Fredholm solution and explicit integration over springs, five digits.
RESTITUTION = {np.inf: 0.45457, 2e-3: 0.55924}


def largest_difference(name: str, history: ImpactHistory, exact: ImpactHistory, until: float = 1.0) -> float:
    """Of a channel at the samples of ``history``, by the largest value of the exact one.

    Args:
        name: channel.
        history: what is judged.
        exact: smooth, so that splines between its samples add nothing.
        until: part of the contact time that is compared.
    """
    time, first = np.unique(exact.time, return_index=True)
    common = history.time <= until * exact.time[-1]
    truth = CubicSpline(time, getattr(exact, name)[first])(history.time[common])
    return float(np.abs(getattr(history, name)[common] - truth).max() / np.abs(truth).max())


@pytest.mark.parametrize("thickness", [2e-3, pytest.param(np.inf, marks=pytest.mark.slow)])
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

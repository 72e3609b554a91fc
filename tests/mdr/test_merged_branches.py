"""Impacts on measured tables of many relaxation times: few branches in their place, within the stated errors."""

import numpy as np
import pytest

from contact import Impact, Layer, Paraboloid, PronySeries, Scene
from mdr import Mdr
from mdr.impact import merged_branches

NUMBERS = ("coefficient_of_restitution", "contact_time", "peak_force", "peak_depth", "peak_contact_radius")


def impact(times, moduli):
    law = PronySeries(long_term_shear_modulus=5e5, shear_moduli=moduli, relaxation_times=times)
    layer = Layer.incompressible(thickness=2e-3, shear_modulus=law.relaxation.instantaneous_modulus)
    ball, fall = Paraboloid(radius_of_curvature=5e-3), Impact(mass=4e-3, velocity=0.2)
    return Scene(layer=layer, indenter=ball, loading=fall, effects=(law,))


@pytest.mark.parametrize("slope", [0.0, 0.3], ids=["even", "glassy"])
def test_thirty_relaxation_times_over_ten_decades_are_answered_within_stated_errors(slope, monkeypatch):
    times = np.logspace(-8, 2, 30)
    scene = impact(times, 2e4 * times**-slope)
    merged = Mdr().solve(scene)
    monkeypatch.setattr(merged_branches, "_MANY", times.size)
    exact = Mdr().solve(scene)
    for name in NUMBERS:
        error = abs(getattr(merged, name) / getattr(exact, name) - 1.0)
        assert error <= np.max(merged.error_estimate[name]) + np.max(exact.error_estimate[name]), name
        assert np.max(merged.error_estimate[name]) < 1e-5, name
    force = np.interp(merged.time, exact.time, exact.normal_force)
    # Straight lines between samples of the reference err by 1e-3 of the peak.
    np.testing.assert_allclose(merged.normal_force, force, rtol=0.0, atol=1e-2 * exact.peak_force)
    # All four solutions together; measured 0.2 to 0.3.
    assert merged.cost.cpu_seconds < 0.5 * exact.cost.cpu_seconds
    assert merged.scene == scene
    assert [note for note in merged.notes if "relaxation times below" in note]


def test_two_branches_have_the_first_four_moments_of_many():
    nodes, weights = np.logspace(-6, 0, 20), np.linspace(1.0, 2.0, 20)
    few, shares = merged_branches._two_nodes(nodes, weights)
    for power in range(4):
        assert few**power @ shares == pytest.approx(nodes**power @ weights, rel=1e-12, abs=0.0)


def test_short_tables_are_solved_as_they_are():
    assert not Mdr().solve(impact(np.logspace(-5, 0, 6), np.full(6, 2e4))).notes

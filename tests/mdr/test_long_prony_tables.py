"""Impacts on measured tables of many relaxation times, from ten decades below the contact time to far beyond it."""

import numpy as np
import pytest

from contact import Impact, Layer, Paraboloid, PronySeries, Scene
from mdr import Mdr

NUMBERS = ("coefficient_of_restitution", "contact_time", "peak_force", "peak_depth", "peak_contact_radius")


def impact(times, moduli):
    law = PronySeries(long_term_shear_modulus=5e5, shear_moduli=moduli, relaxation_times=times)
    layer = Layer.incompressible(thickness=2e-3, shear_modulus=law.relaxation.instantaneous_modulus)
    ball, fall = Paraboloid(radius_of_curvature=5e-3), Impact(mass=4e-3, velocity=0.2)
    return Scene(layer=layer, indenter=ball, loading=fall, effects=(law,))


@pytest.mark.parametrize("slope", [0.0, 0.3], ids=["even", "glassy"])
def test_thirty_relaxation_times_over_ten_decades_are_answered_within_stated_errors(slope):
    times = np.logspace(-8, 2, 30)
    scene = impact(times, 2e4 * times**-slope)
    answer, finer = Mdr().solve(scene), Mdr(accuracy=1e-12).solve(scene)
    for name in NUMBERS:
        error = abs(getattr(answer, name) / getattr(finer, name) - 1.0)
        assert error <= np.max(answer.error_estimate[name]) + np.max(finer.error_estimate[name]), name
        assert np.max(answer.error_estimate[name]) < 1e-5, name
    assert answer.energy_residual < 1e-7
    assert not answer.notes


def test_a_branch_that_relaxes_at_once_is_a_dashpot():
    """A branch of G tau = eta, tau 1e-7 of the contact time, answers like a dashpot eta to the order of tau."""
    from contact import KelvinVoigt

    fast = impact([1e-9], [5e9])
    model = KelvinVoigt(shear_modulus=5e5, viscosity=5.0)
    layer = Layer.incompressible(thickness=2e-3, shear_modulus=5e5)
    one, other = Mdr().solve(fast), Mdr().solve(fast.replace(layer=layer, effects=(model,)))
    for name in NUMBERS:
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=2e-6, abs=0.0), name

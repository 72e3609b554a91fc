"""Branches of equilibria that are known in closed form: folds, solutions, and where a withdrawal loses contact."""

import numpy as np
import pytest

from bem.branch import DEPTH, FORCE, Branch


def jkr(start, beyond):
    """A sphere on the half-space with R = E* = 1 and 2 pi dgamma = 1: depth and force, Eq. (41)."""
    a = start + beyond
    return np.stack([a**2 - np.sqrt(a), 4 * a**3 / 3 - 2 * a * np.sqrt(a)])


def test_folds_of_the_jkr_sphere_are_the_closed_form():
    branch = Branch.sampled(jkr, (), 2.0)
    radius = branch.radius(np.array([*branch.folds(DEPTH), *branch.folds(FORCE)]))
    np.testing.assert_allclose(radius, [0.25 ** (2 / 3), 0.75 ** (2 / 3)], rtol=1e-13)
    assert branch.strength == pytest.approx(0.75, rel=1e-14, abs=0.0)


def test_values_are_met_again_where_they_are_prescribed():
    branch, radius = Branch.sampled(jkr, (), 2.0), np.array([0.5, 1.0, 1.9])
    y = branch.smallest(DEPTH, branch.values(branch.position(radius))[DEPTH])
    np.testing.assert_allclose(branch.radius(y), radius, rtol=1e-14)
    assert np.isnan(branch.smallest(DEPTH, np.array([-1.0])))[0]


def test_a_fold_where_the_slope_jumps_over_zero_at_a_kink_is_found():
    def sample(start, beyond):
        depth = (start + beyond) * (2.0 if start == 0.0 else 1.0) - (3.0 * beyond if start else 0.0)
        return np.stack([depth, depth])

    branch = Branch.sampled(sample, (0.37,), 1.0)
    np.testing.assert_allclose(branch.radius(np.array(branch.folds(DEPTH))), [0.37], rtol=1e-15)
    assert branch.loss(DEPTH, branch.end) == branch.end

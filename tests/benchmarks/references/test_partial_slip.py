"""Partial slip on the half-space: limits of weak coupling and of full stick, other points, a planted fault."""

import math

import pytest
from scipy.special import ellipk

from benchmarks.references import partial_slip
from benchmarks.references.partial_slip import HalfSpaceContact


@pytest.mark.parametrize("share", [0.2, 0.6, 0.95])
def test_weak_coupling_is_the_closed_form_of_spence(share):
    """What the closed form leaves out goes with beta squared."""
    nu = 0.4999
    beta = (1.0 - 2.0 * nu) / (2.0 - 2.0 * nu)
    closed = beta * math.log((1.0 + share) / (1.0 - share)) / (2.0 * share * ellipk(1.0 - share**2))
    found = partial_slip.partial_slip(nu, share)
    assert found.coefficient == pytest.approx(closed, rel=5.0 * beta**2, abs=0.0)
    assert found.depth == pytest.approx(1.0, rel=0.0, abs=5.0 * beta**2)


def test_a_stick_up_to_the_edge_is_full_stick():
    """Spence: 1.02458024 times the depth of Hertz, 1.01621310 times his force; Mossakovskii's stiffness; no heat."""
    nu = 0.3
    found = partial_slip.partial_slip(nu, 0.9999)
    assert found.depth == pytest.approx(1.02458024, rel=5e-5, abs=0.0)
    assert found.force == pytest.approx(1.01621310, rel=5e-6, abs=0.0)
    stiffness = (1.0 - nu) * math.log(3.0 - 4.0 * nu) / (1.0 - 2.0 * nu)
    assert found.stiffness == pytest.approx(stiffness, rel=5e-5, abs=0.0)
    assert 0.0 < found.heat < 1e-6


@pytest.mark.parametrize(("nu", "share"), [(0.0, 0.3), (0.3, 0.7), (0.45, 0.9)])
def test_other_points_repeat_twelve_digits(nu, share):
    one, other = (partial_slip.partial_slip(nu, share, step) for step in (0.25, 0.31))
    for name in ("coefficient", "depth", "force", "stiffness", "heat"):
        assert getattr(other, name) == pytest.approx(getattr(one, name), rel=1e-11, abs=0.0), name


def test_more_friction_sticks_further_and_carries_more():
    found = [partial_slip.partial_slip(0.2, share) for share in (0.1, 0.4, 0.7, 0.9)]
    for name in ("coefficient", "depth", "force", "stiffness"):
        values = [getattr(one, name) for one in found]
        assert values == sorted(values), name


def test_pressure_that_is_not_moved_by_shear_is_seen(monkeypatch):
    """The coupling of one direction alone: the force no longer is that of full stick."""
    right = HalfSpaceContact.transform

    def wrong(contact, stuck, slid, parity):
        found = right(contact, stuck, slid, parity)
        return found if parity > 0 else tuple(0.0 * part for part in found)

    monkeypatch.setattr(HalfSpaceContact, "transform", wrong)
    with pytest.raises(AssertionError):
        test_a_stick_up_to_the_edge_is_full_stick()

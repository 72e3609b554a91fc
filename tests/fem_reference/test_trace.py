from __future__ import annotations

import numpy as np
import pytest

from contact import NotConvergedError
from fem_reference.surface import TraceSpace

RADII = np.concatenate([np.linspace(0, 0.4, 5), np.linspace(0.4, 1, 5)[1:]])  # two cells of degree four


@pytest.mark.parametrize("stride", [1, 2, 4])
def test_moments_of_hats_integrate_polynomials_exactly(stride):
    trace = TraceSpace(RADII, 4)
    moments = trace.hat_moments(stride)
    assert moments.shape == (9, 8 // stride + 1)
    # sum of all hats is one, their combination with their own radii is r: int r^3 . {1, r} 2 pi r dr = 2 pi {1/5, 1/6}
    hats = moments.T @ RADII**3
    assert hats.sum() == pytest.approx(2 * np.pi / 5, rel=1e-14, abs=0.0)
    assert hats @ RADII[::stride] == pytest.approx(2 * np.pi / 6, rel=1e-14, abs=0.0)
    # the hat at the axis, 1 - r/c, is a cone: int 2 pi r dr = pi c^2 / 3
    c = RADII[stride]
    assert moments.sum(axis=0)[0] == pytest.approx(np.pi * c**2 / 3, rel=1e-14, abs=0.0)


def test_no_radii_have_no_values():
    assert TraceSpace(RADII, 4).evaluate(RADII, np.empty(0)).shape == (0,)


def test_a_value_alone_is_that_in_a_list():
    """Matrix products summed lists of other lengths in other orders."""
    trace, values, radii = TraceSpace(RADII, 4), np.cos(7.0 * RADII), np.linspace(0.0, 1.0, 500)
    alone = [trace.evaluate(values, radii[[n]])[0] for n in range(radii.size)]
    np.testing.assert_array_equal(alone, trace.evaluate(values, radii))


def test_coinciding_nodes_are_refused_by_name():
    """SuperLU's "Factor is exactly singular" had left the solver as a crash."""
    space = TraceSpace(np.array([0.0, 0.5, 1.0, 1.0, 1.0]), 2)
    with pytest.raises(NotConvergedError, match="two nodes of the contact coincide"):
        space.recover(np.ones(5))

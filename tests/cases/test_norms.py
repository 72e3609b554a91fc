import math

import numpy as np
import pytest

from cases.norms import relative_difference, ring_load_difference, ring_quadrature
from contact import InvalidInput

RINGS = ring_quadrature([0.0, 0.5, 1.0], nodes=12)
RADIUS = RINGS.radius.ravel()


def test_the_area_weight_carries_two_pi_r():
    """A dropped 2 pi r would give 0.5 and 1 - 0.5; the closed form is pi r^2."""
    np.testing.assert_allclose(RINGS.loads(np.ones(RADIUS.size)), [math.pi / 4, math.pi * 3 / 4], rtol=1e-12)


def test_flat_punch_pressure_carries_two_pi():
    """int dA / sqrt(1-r^2) = 2 pi: the inverse square root at the edge is integrated to full accuracy."""
    assert RINGS.loads(1 / np.sqrt(1 - RADIUS**2)).sum() == pytest.approx(2 * math.pi, rel=1e-10, abs=0.0)


def test_weighted_norm_of_one_is_the_root_of_the_area():
    assert RINGS.norm(np.ones(RADIUS.size)) == pytest.approx(math.sqrt(math.pi), rel=1e-12, abs=0.0)


def test_relative_difference_of_a_scaled_field_is_the_scale():
    p = np.sqrt(1 - RADIUS**2)
    assert relative_difference(1.01 * p, p, RINGS) == pytest.approx(0.01, rel=1e-12, abs=0.0)
    assert ring_load_difference(1.01 * p, p, RINGS) == pytest.approx(
        0.01 * RINGS.loads(p).max() / RINGS.loads(p).sum(), rel=1e-12, abs=0.0
    )


def test_load_moved_between_rings_is_seen():
    p = np.ones(RADIUS.size)
    moved = np.where(RADIUS < 0.5, 1.3, 0.9)
    assert RINGS.loads(moved).sum() == pytest.approx(RINGS.loads(p).sum(), rel=1e-12, abs=0.0)
    assert ring_load_difference(moved, p, RINGS) == pytest.approx(0.3 / 4, rel=1e-12, abs=0.0)


def test_nan_wrong_shapes_and_empty_references_are_refused():
    with pytest.raises(InvalidInput, match="finite"):
        RINGS.norm(np.full(RADIUS.size, math.nan))
    with pytest.raises(InvalidInput, match="samples"):
        RINGS.loads(np.ones(3))
    with pytest.raises(InvalidInput, match="zero"):
        relative_difference(np.ones(RADIUS.size), np.zeros(RADIUS.size), RINGS)


@pytest.mark.parametrize("edges", [[0.0], [1.0, 0.5], [-1.0, 1.0], [0.0, math.nan]])
def test_edges_must_increase(edges):
    with pytest.raises(InvalidInput, match="increase"):
        ring_quadrature(edges)

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, PchipInterpolator

from bem.polynomials.cubics import PiecewiseCubic

RNG = np.random.default_rng(22)
KNOTS = np.cumsum(RNG.uniform(0.1, 1.0, 40))
POINTS = np.linspace(KNOTS[0], KNOTS[-1], 1001)


def test_a_spline_is_scipys():
    y = RNG.normal(size=KNOTS.size)
    own, other = PiecewiseCubic.spline(KNOTS, y), CubicSpline(KNOTS, y)
    np.testing.assert_allclose(own(POINTS), other(POINTS), rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(own(POINTS.reshape(7, -1)).ravel(), own(POINTS), rtol=0.0, atol=0.0)


@pytest.mark.parametrize("count", [2, 3, 4, 40])
def test_a_monotone_cubic_is_scipys(count):
    for y in (RNG.normal(size=count), np.cumsum(RNG.uniform(0.0, 1.0, count)), np.round(RNG.normal(size=count))):
        own, other = PiecewiseCubic.monotone(KNOTS[:count], y), PchipInterpolator(KNOTS[:count], y)
        points = np.linspace(KNOTS[0], KNOTS[count - 1], 301)
        np.testing.assert_allclose(own(points), other(points), rtol=0.0, atol=1e-13)

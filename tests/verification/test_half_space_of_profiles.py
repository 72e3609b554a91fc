"""Depth and pressure of measured profiles on the half-space against adaptive quadrature.

g(x) = x int_0^(pi/2) f'(x sin t) dt,
p(r) = (E*/pi) int_r^a g'(t)/sqrt(t^2 - r^2) dt.
"""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

from contact import ContactRadii, Layer, Scene, Tabulated
from mdr import Mdr

HALF_SPACE = Layer.half_space(youngs_modulus=1.0, poissons_ratio=0.0)


def solved(indenter, radius):
    return Mdr().solve(Scene(layer=HALF_SPACE, indenter=indenter, loading=ContactRadii([radius])))


CLOSE = {
    "two close": [0.0, 1.0, 1.001, 2.0, 3.0],
    "two closest": [0.0, 0.5, 0.50001, 2.9, 3.0],
    "even": np.linspace(0.0, 3.0, 13),
    "logarithmic": [0.0, *np.geomspace(1e-4, 3.0, 12)],
}


@pytest.mark.first(1)
@pytest.mark.parametrize("radii", CLOSE)
@pytest.mark.parametrize("radius", [1.7])
def test_a_measured_table_with_uneven_radii(radii, radius):
    r = np.asarray(CLOSE[radii], dtype=float)
    table = Tabulated(radii=r, heights=r**2 / 2)
    answer = solved(table, radius)
    second = lambda x: table._curve(x, 2)  # noqa: E731

    def over_angle(function, x):
        ends = np.arcsin(np.append(r[r < x], x) / x)
        u, weights = np.polynomial.legendre.leggauss(40)
        t = ends[:-1, None] + np.diff(ends)[:, None] * (1.0 + u) / 2.0
        return float(np.sum(np.diff(ends)[:, None] / 2.0 * weights * function(x * np.sin(t))))

    def slope(x):
        """g' = int (f' + r f'') dt."""
        return over_angle(lambda q: table.slope_at(q) + q * second(q), x)

    def pressure(at):
        """With t^2 = r^2 + s^2, between roots that begin at the table's radii."""
        ends = np.sqrt(np.array([at, *r[(r > at) & (r < radius)], radius]) ** 2 - at**2)
        total = 0.0
        for low, high in pairwise(ends.tolist()):

            def part(v, low=low, high=high):
                t = np.hypot(at, low + (high - low) * v * v)
                return slope(t) / t * 2.0 * v * (high - low)

            total += quad(part, 0.0, 1.0, epsabs=1e-14, epsrel=1e-12, limit=400)[0]
        return total / np.pi

    depth = radius * over_angle(table.slope_at, radius)
    assert abs(answer.indentation_depth[0] - depth) <= answer.uncertainty("indentation_depth")[0]
    places = radius * np.array([0.01, 0.2, 0.6, 0.97])
    exact = np.array([pressure(at) for at in places])
    # Adaptive quadrature leaves 1e-12 of the pressure.
    assert np.abs(answer.pressure(places, 0) - exact).max() <= 1e-12 * exact.max()
